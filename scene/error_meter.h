#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "trimtab/measure/frame_error.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/database.h"

namespace trimtab::scene {

/// The picture that a request is held against: no culling (view frustum, which is proven equal), finest
/// levels, no blur, no early far plane; the same eye, air, precipitation, symbols and time.
FrameRequest referenceOf(const FrameRequest& request);

/// Both pictures of a measurement, RGBA, row 0 at the bottom.
struct ErrorPictures {
  int widthPx = 0, heightPx = 0;
  std::vector<std::uint8_t> reference, ours;
  std::vector<float> flip;  ///< one a pixel, 0..1: the difference map
};

/// Measures what a frame's picture loses. Draws with a renderer of its own into framebuffers of its own, so
/// that whoever shows pictures in the same context is not disturbed. All calls need the context current that
/// `initialize` was called with.
class ErrorMeter {
 public:
  ErrorMeter();
  ~ErrorMeter();
  ErrorMeter(const ErrorMeter&) = delete;
  ErrorMeter& operator=(const ErrorMeter&) = delete;

  GlReport initialize();
  void release();
  void setTerrain(std::shared_ptr<const terrain::Database> database);

  /// `before` is the frame before `request`, from which temporal pop is told; null: not measured. Draws 3 to
  /// 6 pictures. `pictures`, where not null, gets what was compared.
  FrameError measure(const FrameRequest& request, const FrameRequest* before, ErrorPictures* pictures);
  /// What the renderer that draws `request` does wrong on purpose (renderer.h); the reference stays clean.
  void plant(const Defects& defects);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
