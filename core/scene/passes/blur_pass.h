#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace trimtab::scene {

class FrameBuffer;

/// Document C's blur: an afterimage that builds up over frames ("BlurAccumulator applies the afterimage
/// effect"), which does not soften a single image. Like OpenSceneGraph's own motion blur, which its authors
/// used, it keeps a share of the accumulated image that falls exponentially with time. Contexts no longer
/// have an accumulation buffer, so two images of floats take turns. On a GPU they are targets of a shader.
/// With a software rasteriser this processor mixes them itself: the shader's pass took seven times as long,
/// most of it to fetch texels.
///
/// Each image stands for the time since the one before, so a trail has one length at any frame rate. It
/// takes memory at the first blurred frame. The context must be current for all of its life.
class BlurPass {
 public:
  explicit BlurPass(bool softwareRasteriser);
  ~BlurPass();
  BlurPass(const BlurPass&) = delete;
  BlurPass& operator=(const BlurPass&) = delete;

  /// Replaces an image by its mix with those before, and leaves its framebuffer bound.
  /// `strength` is the share of the accumulated image that is left after 1/60 s; `time` is in seconds. The
  /// first image after a rest, after a step back or of more than a second, or of another size stays as it
  /// is; one of the same time replaces the last one.
  void apply(const FrameBuffer& image, double strength, double time);
  /// Returns the share of the accumulated image that is left `step` seconds later; 0 if that one is a first
  /// image.
  static double keptAfter(double strength, double step);
  /// Makes the next image a first one.
  void rest() { fresh_ = true; }

 private:
  void resize(int width, int height);
  void makeTargets();
  void mixOnGpu(const FrameBuffer& image);
  void mixOnCpu(const FrameBuffer& image);

  bool software_;
  std::array<std::vector<float>, 2> sum_;  ///< of a software rasteriser, 0..255
  std::vector<std::uint8_t> pixels_;
  unsigned program_ = 0, emptyArray_ = 0;
  int keepUniform_ = -1;
  std::array<unsigned, 2> texture_{}, frame_{};
  unsigned shown_ = 0;  ///< 8 bits a colour
  int width_ = 0, height_ = 0;
  std::size_t newest_ = 0;  ///< which of the two holds the accumulated image
  double time_ = 0, keep_ = 0;
  bool fresh_ = true;
};

}  // namespace trimtab::scene
