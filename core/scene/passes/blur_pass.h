#pragma once

#include <array>

namespace trimtab::scene {

/// Document C's blur: an afterimage that builds up over frames ("BlurAccumulator applies the afterimage
/// effect"), not a softening of one picture. Its authors used OpenSceneGraph, whose own motion blur keeps a
/// share of the accumulated picture that falls exponentially with time; so does this, without the
/// accumulation buffer, which contexts no longer have: two float targets take turns.
///
/// Each picture stands for the time since the one before, so a trail has one length at any frame rate. Memory
/// is taken at the first blurred frame. The context is current for all of its life.
class BlurPass {
 public:
  BlurPass();
  ~BlurPass();
  BlurPass(const BlurPass&) = delete;
  BlurPass& operator=(const BlurPass&) = delete;

  /// Replaces the picture of framebuffer `fbo`, whose colour is `texture`, by its mix with what came before.
  /// `strength` is the share of the accumulated picture that is left after 1/60 s; `time` in seconds. The
  /// first picture after a rest, after a step back or of more than a second, or of another size is left as it
  /// is; one of the same time takes the last one's place.
  void apply(unsigned fbo, unsigned texture, int width, int height, double strength, double time);
  /// Share of the accumulated picture that is left in the one `step` seconds later; 0: that one is a first
  /// picture.
  static double keptAfter(double strength, double step);
  /// Nothing accumulates: the next picture is a first one.
  void rest() { fresh_ = true; }

 private:
  void resize(int width, int height);

  unsigned program_ = 0, emptyArray_ = 0;
  int keepUniform_ = -1;
  std::array<unsigned, 2> texture_{}, frame_{};
  unsigned shown_ = 0;  ///< 8 bits a colour
  int width_ = 0, height_ = 0;
  std::size_t newest_ = 0;  ///< the target that holds the accumulated picture
  double time_ = 0, keep_ = 0;
  bool fresh_ = true;
};

}  // namespace trimtab::scene
