#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "results.h"
#include "trimtab/scene/renderer.h"

/// Measures what the work that frames skip would have cost.
namespace trimtab::harness {

/// Draws one frame and returns when its image is finished; the call itself is timed.
using DrawFrame = std::function<FrameResult(const FrameRequest&)>;

/// Work that a frame may skip, and how to make the frame do it nevertheless.
struct Skip {
  std::string_view name;  ///< as in SkipSaving
  /// Reports whether the frame skipped the work; `before` is the result of the frame before, `after` of this.
  bool (*left)(const FrameRequest& request, const FrameResult& before, const FrameResult& after);
  /// Returns the same frame with the work done. Its image is identical to the bit.
  FrameRequest (*done)(const FrameRequest& request);
  /// Returns the same frame with the work skipped: usually the request itself.
  FrameRequest (*leftOut)(const FrameRequest& request);
  bool needsFrameBefore = false;  ///< skipped only because of what the frame before did
};
/// Returns all skips. A mechanism that adds a skip adds a row to this table and nowhere else.
const std::vector<Skip>& skips();

/// Reports for each skip how many of `frames`, drawn in order, skipped the work, and what that saved. The
/// saving is measured on at most `kMostMeasured` frames, `repeats` times each, alternating between the frame
/// with and without the skip. `goOn` is called between frames; once it returns false, savings not measured
/// yet stay NaN. With `pairs`, `frames` holds pairs: the frame before, then the frame to measure.
std::vector<SkipSaving> measureSkips(const DrawFrame& draw, std::span<const FrameRequest> frames,
                                     std::size_t repeats, const std::function<bool()>& goOn = {},
                                     bool pairs = false);
inline constexpr std::size_t kMostMeasured = 6;

}  // namespace trimtab::harness
