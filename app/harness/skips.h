#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "results.h"
#include "trimtab/scene/renderer.h"

/// What the work that frames leave out would have cost.
namespace trimtab::harness {

/// Draws one frame and returns when its picture is finished: its time is taken around the call.
using DrawFrame = std::function<FrameResult(const FrameRequest&)>;

/// Work that may be left out, and how a measurement does it nevertheless.
struct Skip {
  std::string_view name;  ///< as in SkipSaving
  /// Whether the frame left it out; `before` and `after` are the results of the frame before and of this one.
  bool (*left)(const FrameRequest& request, const FrameResult& before, const FrameResult& after);
  /// The same frame with the work done. The picture is the same, to the bit.
  FrameRequest (*done)(const FrameRequest& request);
  /// The same frame with it left out: the request itself, but where the work is part of something larger.
  FrameRequest (*leftOut)(const FrameRequest& request);
  bool needsFrameBefore = false;  ///< left out only because of what the frame before did
};
/// All that there are; a mechanism that adds a skip adds a line there and nowhere else.
const std::vector<Skip>& skips();

/// For each skip: how many of `frames`, drawn in order, left the work out, and what that saved, measured on
/// at most `kMostMeasured` of them, `repeats` times each, the frame without the skip and the frame with it
/// taking turns. `goOn` is asked between frames; once it says no, what is not measured yet stays NaN.
/// `pairs`: each two frames are one to measure and, first, the one before it.
std::vector<SkipSaving> measureSkips(const DrawFrame& draw, std::span<const FrameRequest> frames,
                                     std::size_t repeats, const std::function<bool()>& goOn = {},
                                     bool pairs = false);
inline constexpr std::size_t kMostMeasured = 6;

}  // namespace trimtab::harness
