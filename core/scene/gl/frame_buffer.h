#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/frame/frame.h"

namespace trimtab::scene {

/// RGBA8 with 32-bit float depth, which reversed depth needs and windows do not have.
class FrameBuffer {
 public:
  FrameBuffer() = default;
  ~FrameBuffer();
  FrameBuffer(const FrameBuffer&) = delete;
  FrameBuffer& operator=(const FrameBuffer&) = delete;

  /// Makes it that size if it is not.
  void resize(int width, int height);
  void release();
  unsigned id() const { return id_; }
  unsigned colourTexture() const { return colour_; }
  /// Metres from the eye of a view that fills it, row 0 at the bottom; infinity where nothing was drawn.
  std::vector<float> readDistances(const ViewShape& view) const;
  /// RGBA of the lower left corner, row 0 at the bottom.
  std::vector<std::uint8_t> readPixels(int width, int height) const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  unsigned id_ = 0, colour_ = 0, depth_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace trimtab::scene
