// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "live.h"

namespace trimtab::views {

/// What the plots record of every frame.
enum class Trace : std::uint8_t {
  altitude_membership,
  pitch_membership,
  total_membership,
  triangles,
  frame_ms,
  fps,
  cull_ms,
  draw_ms,
  gpu_ms,
  depth_map_width_px,
  head_rate_degps,
  lod_scale,
  select_ms,
  page_ms,
  occlusion_ms,
  blur_ms,
  weather_ms,
  symbology_ms,
  // Upper edges in the stack of stages; not in the CSV.
  select_top_ms,
  page_top_ms,
  occlusion_top_ms,
  cull_top_ms,
  count_
};
inline constexpr std::size_t kTraces = static_cast<std::size_t>(Trace::count_);
inline constexpr std::size_t kCsvTraces = static_cast<std::size_t>(Trace::select_top_ms);
std::string_view traceName(Trace trace);  ///< as the CSV spells it

/// The stages that sum to a frame, from the foot of the stack up; the lowest edge also holds the decision.
struct StackedStage {
  Trace stage, top;
};
inline constexpr std::array<StackedStage, 5> kStack{{{Trace::select_ms, Trace::select_top_ms},
                                                     {Trace::page_ms, Trace::page_top_ms},
                                                     {Trace::occlusion_ms, Trace::occlusion_top_ms},
                                                     {Trace::cull_ms, Trace::cull_top_ms},
                                                     {Trace::draw_ms, Trace::frame_ms}}};

/// The last frames in flat rings that never allocate after construction, with the extremes of each block
/// kept, so that a long stretch is drawn at the cost of the columns on the screen. Frames have absolute
/// numbers from 0 on; the oldest are overwritten.
class TraceBuffer {
 public:
  static constexpr std::size_t kBlock = 64;
  /// Ten minutes at 400 frames a second, an hour at 66; 25 MB.
  static constexpr std::size_t kCapacity = 240'000 / kBlock * kBlock;

  explicit TraceBuffer(std::size_t capacity = kCapacity);

  /// A clock that goes back (a flight that starts over) is taken on from the last frame: time in here never
  /// falls.
  void append(const LiveFrame& frame);
  void clear();

  std::uint64_t begin() const;                  ///< oldest frame that is still held
  std::uint64_t end() const { return count_; }  ///< one past the newest
  bool empty() const { return count_ == 0; }
  double time(std::uint64_t frame) const { return times_[frame % capacity_]; }
  std::uint64_t packet(std::uint64_t frame) const { return packets_[frame % capacity_]; }
  float value(Trace trace, std::uint64_t frame) const { return values_[index(trace)][frame % capacity_]; }
  /// First frame at or after `time`; end() where there is none.
  std::uint64_t atOrAfter(double time) const;
  /// The frame nearest in time; the buffer must not be empty.
  std::uint64_t nearest(double time) const;

  struct Column {
    double time = 0;
    float low = 0, high = 0;  ///< both NaN where nothing was measured
  };
  /// Extremes over the frames from `from` up to `to`, in about `columns` pieces of equal count.
  void columns(Trace trace, std::uint64_t from, std::uint64_t to, std::size_t columns,
               std::vector<Column>& out) const;

  /// Frames with from <= time <= to as CSV in the C locale, shortest digits that read back; not measured is
  /// empty.
  std::string csv(double from, double to) const;

 private:
  static std::size_t index(Trace trace) { return static_cast<std::size_t>(trace); }

  std::size_t capacity_;
  std::uint64_t count_ = 0;
  double timeShift_ = 0;
  std::vector<double> times_;
  std::vector<std::uint64_t> packets_;
  std::array<std::vector<float>, kTraces> values_;
  std::array<std::vector<float>, kTraces> blockLow_, blockHigh_;  ///< of complete and running blocks
};

}  // namespace trimtab::views
