// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "live.h"

namespace trimtab::views {

/// The values that the plots record for every frame.
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
  line_of_sight_degps,  ///< its rate as head motion decides by it; of the head where `motion.reference` says
  lod_scale,
  select_ms,
  page_ms,
  occlusion_ms,
  blur_ms,
  weather_ms,
  symbology_ms,
  vertices,
  altitude_ft,  ///< as the decision used it
  pitch_deg,
  dynamic_scheme,  ///< 1 for scheme *dynamic*, 0 for *frustum*
  band,
  tiles_drawn,
  tiles_outside,
  tiles_hidden,
  tiles_built,   ///< and uploaded, since the frame before
  pages_read,    ///< since the frame before
  page_read_mb,  ///< of these
  pages_waiting,
  above_ground_ft,  ///< this and the following are signals of a policy, unknown without one
  roll_deg,
  speed_kt,
  climb_ftpmin,
  sight_rate_degps,
  visibility_m,
  load,
  allowed_error_px,  ///< this and the following are levers as they were drawn
  render_scale,
  particle_density,
  blur_strength,
  far_km,
  predicted_ms,  ///< this and the following are of the arbiter, unknown without one
  as_asked_ms,
  flip,  ///< of the last image whose error was measured live
  // Upper edges in the stack of stages, which the CSV does not have.
  select_top_ms,
  page_top_ms,
  occlusion_top_ms,
  cull_top_ms,
  count_
};
inline constexpr std::size_t kTraces = static_cast<std::size_t>(Trace::count_);
inline constexpr std::size_t kCsvTraces = static_cast<std::size_t>(Trace::select_top_ms);
std::string_view traceName(Trace trace);  ///< the name of its column in the CSV

/// The stages that sum to a frame, from the bottom of the stack up; the lowest one includes the decision.
struct StackedStage {
  Trace stage, top;
};
inline constexpr std::array<StackedStage, 5> kStack{{{Trace::select_ms, Trace::select_top_ms},
                                                     {Trace::page_ms, Trace::page_top_ms},
                                                     {Trace::occlusion_ms, Trace::occlusion_top_ms},
                                                     {Trace::cull_ms, Trace::cull_top_ms},
                                                     {Trace::draw_ms, Trace::frame_ms}}};

/// Keeps the newest frames in flat rings that allocate only when they are made. It also keeps the extremes of
/// each block of frames, so that drawing a long stretch costs as much as the columns on the screen. Frames
/// have absolute numbers from 0 on; the oldest are overwritten.
class TraceBuffer {
 public:
  static constexpr std::size_t kBlock = 64;
  /// Enough for five minutes at 400 frames per second, or half an hour at 66; 27 MB.
  static constexpr std::size_t kCapacity = 120'000 / kBlock * kBlock;

  explicit TraceBuffer(std::size_t capacity = kCapacity);

  /// Adds a frame. If the clock goes back, as when a flight starts over, its time goes on from the last
  /// frame, so that times never fall.
  void append(const LiveFrame& frame);
  void clear();
  /// Keeps at most this many frames from now on, the newest of those that are there among them.
  void setCapacity(std::size_t frames);
  std::size_t capacity() const { return capacity_; }

  std::uint64_t begin() const;                  ///< the oldest frame that is kept
  std::uint64_t end() const { return count_; }  ///< one past the newest
  bool empty() const { return count_ == 0; }
  double time(std::uint64_t frame) const { return times_[frame % capacity_]; }
  std::uint64_t packet(std::uint64_t frame) const { return packets_[frame % capacity_]; }
  /// Returns the time of the frame's state on the clock of its host or flight, seconds.
  double stateTime(std::uint64_t frame) const { return stateTimes_[frame % capacity_]; }
  float value(Trace trace, std::uint64_t frame) const { return values_[index(trace)][frame % capacity_]; }
  /// Returns the first frame at or after `time`; end() if there is none.
  std::uint64_t atOrAfter(double time) const;
  /// Returns the frame nearest in time. The buffer must not be empty.
  std::uint64_t nearest(double time) const;
  /// Returns the frame nearest in time of those before `end`; nothing if none is within kReachS.
  std::optional<std::uint64_t> at(double time, std::uint64_t end) const;
  static constexpr double kReachS = 0.5;
  /// Frames that are farther apart than this, seconds, have a gap between them.
  static constexpr double kGapS = 1;

  struct Column {
    double time = 0;
    float low = 0, high = 0;  ///< both NaN if nothing was measured
  };
  /// Returns the extremes over the frames from `from` up to `to`, in about `columns` pieces of equally many
  /// frames.
  void columns(Trace trace, std::uint64_t from, std::uint64_t to, std::size_t columns,
               std::vector<Column>& out) const;

  /// Order statistics by nearest rank over the frames from `from` up to `to`; all NaN if nothing was
  /// measured, p95 also for too few frames. Costs a partial sort of them.
  struct Statistics {
    double least, median, p95, largest;
  };
  Statistics statistics(Trace trace, std::uint64_t from, std::uint64_t to) const;
  /// Returns whether the image of this frame differs from that of the frame before. A decision between two
  /// images makes a frame that repeats the cost of the last one.
  bool isNewImage(std::uint64_t frame) const;

  /// Returns the frames with from <= time <= to as CSV in the C locale, with the fewest digits that read
  /// back. A value that was not measured is empty.
  std::string csv(double from, double to) const { return csv(atOrAfter(from), to, end()); }
  /// Does the same for the frames from number `from` on that are not later than `to` and come before `end`.
  std::string csv(std::uint64_t from, double to, std::uint64_t end) const;

 private:
  void allocate();
  Column column(Trace trace, std::uint64_t first, std::uint64_t last) const;
  /// Returns the first frame after `first` that comes more than kGapS after the one before; `last` if none
  /// does.
  std::uint64_t gapAfter(std::uint64_t first, std::uint64_t last) const;
  struct Stored {
    double time = 0, stateTime = 0;
    std::uint64_t packet = 0;
    std::array<float, kTraces> values{};
  };
  void store(std::uint64_t frame, const Stored& stored);
  static std::size_t index(Trace trace) { return static_cast<std::size_t>(trace); }

  std::size_t capacity_;
  std::uint64_t count_ = 0, first_ = 0;  ///< frames before `first_` were given up
  double timeShift_ = 0;
  std::uint64_t tilesBuilt_ = 0, pagesRead_ = 0, bytesRead_ = 0;  ///< at the frame before
  std::vector<double> times_, stateTimes_;
  std::vector<std::uint64_t> packets_;
  std::array<std::vector<float>, kTraces> values_;
  std::array<std::vector<float>, kTraces> blockLow_, blockHigh_;  ///< of complete blocks and the current one
};

}  // namespace trimtab::views
