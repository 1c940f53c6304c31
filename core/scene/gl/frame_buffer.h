#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/frame/frame.h"

namespace trimtab::scene {

/// A colour texture with 32-bit float depth, which reversed depth needs and windows do not have.
class FrameBuffer {
 public:
  enum class Colour { rgba8, number };  ///< number: an unsigned integer of 32 bits
  explicit FrameBuffer(Colour format = Colour::rgba8) : format_(format) {}
  ~FrameBuffer();
  FrameBuffer(const FrameBuffer&) = delete;
  FrameBuffer& operator=(const FrameBuffer&) = delete;

  /// Makes it that size if it has another.
  void resize(int width, int height);
  void release();
  unsigned id() const { return id_; }
  unsigned colourTexture() const { return colour_; }
  /// Returns metres from the eye of a view that fills it, row 0 at the bottom; infinity where nothing was
  /// drawn. `pixels` is the same view at the size that is returned: each of its pixels has the depth of the
  /// pixel here that covers its middle.
  std::vector<float> readDistances(const ViewShape& view, const ViewShape& pixels) const;
  /// Returns RGBA of the lower left corner, row 0 at the bottom. Needs Colour::rgba8.
  std::vector<std::uint8_t> readPixels(int width, int height) const;
  /// Read and write the RGBA of all pixels, row 0 at the bottom. Need Colour::rgba8.
  void readPixels(std::uint8_t* rgba) const;
  void writePixels(const std::uint8_t* rgba) const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  Colour format_;
  unsigned id_ = 0, colour_ = 0, depth_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace trimtab::scene
