// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace_buffer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "trimtab/measure/statistics.h"
#include "trimtab/units/geodesy.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::views {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

template <class Number>
void appendNumber(std::string& out, Number value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

/// Widens a range by a value; fmin and fmax pass over NaN.
void widen(float& low, float& high, float value) {
  low = std::fmin(low, value);
  high = std::fmax(high, value);
}

/// What a running count has grown by; it starts over with another terrain.
double grownBy(std::uint64_t now, std::uint64_t& before) {
  const std::uint64_t by = now >= before ? now - before : now;
  before = now;
  return static_cast<double>(by);
}

double finiteOrNan(double value) {
  return std::isfinite(value) ? value : kNone;
}
/// Without a budget or a known cost nothing is predicted.
double predictedOrNan(const HoldDecision& hold, const StageTimes& times) {
  return hold.limitMs > 0 ? times.total() : kNone;
}

}  // namespace

std::string_view traceName(Trace trace) {
  static constexpr std::array<std::string_view, kTraces> kNames{"altitude_membership",
                                                                "pitch_membership",
                                                                "total_membership",
                                                                "triangles",
                                                                "frame_ms",
                                                                "fps",
                                                                "cull_ms",
                                                                "draw_ms",
                                                                "gpu_ms",
                                                                "depth_map_width_px",
                                                                "line_of_sight_degps",
                                                                "lod_scale",
                                                                "select_ms",
                                                                "page_ms",
                                                                "occlusion_ms",
                                                                "blur_ms",
                                                                "weather_ms",
                                                                "symbology_ms",
                                                                "vertices",
                                                                "altitude_ft",
                                                                "pitch_deg",
                                                                "dynamic_scheme",
                                                                "band",
                                                                "tiles_drawn",
                                                                "tiles_outside",
                                                                "tiles_hidden",
                                                                "tiles_built",
                                                                "pages_read",
                                                                "page_read_mb",
                                                                "pages_waiting",
                                                                "above_ground_ft",
                                                                "roll_deg",
                                                                "speed_kt",
                                                                "climb_ftpmin",
                                                                "sight_rate_degps",
                                                                "visibility_m",
                                                                "load",
                                                                "allowed_error_px",
                                                                "render_scale",
                                                                "particle_density",
                                                                "blur_strength",
                                                                "far_km",
                                                                "predicted_ms",
                                                                "as_asked_ms",
                                                                "flip",
                                                                "select_top_ms",
                                                                "page_top_ms",
                                                                "occlusion_top_ms",
                                                                "cull_top_ms"};
  return kNames[static_cast<std::size_t>(trace)];
}

TraceBuffer::TraceBuffer(std::size_t capacity)
    : capacity_(std::max(capacity / kBlock, std::size_t{2}) * kBlock) {
  allocate();
}

void TraceBuffer::allocate() {
  times_.assign(capacity_, 0);
  stateTimes_.assign(capacity_, 0);
  packets_.assign(capacity_, 0);
  for (auto& v : values_) v.assign(capacity_, kNone);
  for (auto* blocks : {&blockLow_, &blockHigh_})
    for (auto& v : *blocks) v.assign(capacity_ / kBlock, kNone);
}

void TraceBuffer::clear() {
  count_ = first_ = 0;
  timeShift_ = 0;
}

void TraceBuffer::setCapacity(std::size_t frames) {
  TraceBuffer resized(frames);
  if (resized.capacity_ == capacity_) return;
  // Frames keep their numbers, and whole blocks are kept.
  const std::uint64_t room = count_ > resized.capacity_ ? count_ - resized.capacity_ : 0;
  resized.first_ = std::max(begin(), (room + kBlock - 1) / kBlock * kBlock);
  for (std::uint64_t f = resized.first_; f < count_; ++f) {
    Stored stored{time(f), stateTime(f), packet(f), {}};
    for (std::size_t i = 0; i < kTraces; ++i) stored.values[i] = values_[i][f % capacity_];
    resized.store(f, stored);
  }
  resized.count_ = count_;
  resized.timeShift_ = timeShift_;
  resized.tilesBuilt_ = tilesBuilt_;
  resized.pagesRead_ = pagesRead_;
  resized.bytesRead_ = bytesRead_;
  *this = std::move(resized);
}

std::uint64_t TraceBuffer::begin() const {
  if (count_ <= capacity_) return first_;
  // The block being overwritten is no longer whole.
  const std::uint64_t oldest = count_ - capacity_;
  return std::max(first_, (oldest + kBlock - 1) / kBlock * kBlock);
}

void TraceBuffer::append(const LiveFrame& frame) {
  double now = frame.time + timeShift_;
  if (count_ > 0 && now < time(count_ - 1)) {
    timeShift_ += time(count_ - 1) - now;
    now = time(count_ - 1);
  }
  const FrameDecision& d = frame.decision;
  const FrameCost& cost = frame.cost;
  const FrameResult& drawn = frame.drawn();
  const SignalValues& signal = frame.input.signalValues;
  const auto measuredOr0 = [](double ms) { return std::isfinite(ms) ? ms : 0.0; };
  const auto lever = [&frame](double FrameLevers::*value) {
    return frame.levers ? frame.levers->drawn.*value : std::numeric_limits<double>::quiet_NaN();
  };
  const double selectTop = measuredOr0(cost.decide) + measuredOr0(cost.select);
  const double pageTop = selectTop + measuredOr0(cost.page);
  const double occlusionTop = pageTop + measuredOr0(cost.occlusion);
  const double measured[kTraces]{d.altitudeMembership,
                                 d.pitchMembership,
                                 d.totalMembership,
                                 static_cast<double>(drawn.visible.triangles),
                                 cost.total,
                                 frame.fps,
                                 cost.cull,
                                 cost.draw,
                                 cost.gpu,
                                 drawn.depthMap ? drawn.depthMap->widthPx : 0.0,
                                 d.motion.rateDegPerS,
                                 lever(&FrameLevers::lodScale),
                                 cost.select,
                                 cost.page,
                                 cost.occlusion,
                                 cost.blur,
                                 cost.weather,
                                 cost.symbology,
                                 static_cast<double>(drawn.visible.vertices),
                                 d.altitudeFt,
                                 d.pitchDeg,
                                 d.scheme == Scheme::dynamic ? 1.0 : 0.0,
                                 static_cast<double>(d.band),
                                 static_cast<double>(drawn.visible.tiles.size()),
                                 static_cast<double>(drawn.visible.outsideFrustum),
                                 static_cast<double>(drawn.visible.occluded),
                                 grownBy(drawn.counters.tilesBuilt, tilesBuilt_),
                                 grownBy(drawn.paging.pagesRead, pagesRead_),
                                 grownBy(drawn.paging.bytesRead, bytesRead_) * 1e-6,
                                 static_cast<double>(drawn.paging.waiting),
                                 signal[Signal::above_ground],
                                 wrapped180(frame.input.state.attitude.roll).value(),
                                 signal[Signal::speed],
                                 signal[Signal::climb],
                                 signal[Signal::sight_rate],
                                 signal[Signal::visibility],
                                 signal[Signal::load],
                                 lever(&FrameLevers::errorPx),
                                 lever(&FrameLevers::renderScale),
                                 d.weather.density * lever(&FrameLevers::particleShare),
                                 lever(&FrameLevers::blurStrength),
                                 finiteOrNan(lever(&FrameLevers::farM) * 1e-3),
                                 predictedOrNan(frame.hold, frame.hold.heldMs),
                                 predictedOrNan(frame.hold, frame.hold.askedMs),
                                 frame.flip,
                                 selectTop,
                                 pageTop,
                                 occlusionTop,
                                 occlusionTop + measuredOr0(cost.cull)};
  Stored stored{now, frame.input.state.time, frame.input.state.packet, {}};
  for (std::size_t i = 0; i < kTraces; ++i) stored.values[i] = static_cast<float>(measured[i]);
  store(count_, stored);
  ++count_;
}

void TraceBuffer::store(std::uint64_t frame, const Stored& stored) {
  const std::size_t at = frame % capacity_, block = at / kBlock;
  times_[at] = stored.time;
  stateTimes_[at] = stored.stateTime;
  packets_[at] = stored.packet;
  for (std::size_t i = 0; i < kTraces; ++i) {
    values_[i][at] = stored.values[i];
    if (at % kBlock == 0) blockLow_[i][block] = blockHigh_[i][block] = kNone;
    widen(blockLow_[i][block], blockHigh_[i][block], stored.values[i]);
  }
}

std::uint64_t TraceBuffer::atOrAfter(double wanted) const {
  std::uint64_t low = begin(), high = end();
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (time(middle) < wanted)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

std::uint64_t TraceBuffer::nearest(double wanted) const {
  const std::uint64_t after = atOrAfter(wanted);
  if (after == begin()) return after;
  if (after == end()) return end() - 1;
  return wanted - time(after - 1) < time(after) - wanted ? after - 1 : after;
}

std::optional<std::uint64_t> TraceBuffer::at(double wanted, std::uint64_t end) const {
  end = std::min(end, count_);
  if (begin() >= end) return std::nullopt;
  const std::uint64_t frame = std::min(nearest(wanted), end - 1);
  if (!(std::abs(time(frame) - wanted) <= kReachS)) return std::nullopt;
  return frame;
}

bool TraceBuffer::isNewImage(std::uint64_t frame) const {
  if (frame == begin()) return true;
  const auto differs = [&](Trace trace) { return value(trace, frame) != value(trace, frame - 1); };
  return differs(Trace::frame_ms) || differs(Trace::draw_ms) || differs(Trace::triangles);
}

TraceBuffer::Statistics TraceBuffer::statistics(Trace trace, std::uint64_t from, std::uint64_t to) const {
  std::vector<double> samples;
  for (std::uint64_t f = std::max(from, begin()); f < std::min(to, count_); ++f)
    if (const float v = value(trace, f); std::isfinite(v)) samples.push_back(v);
  return {quantileOf(samples, 0), quantileOf(samples, 0.5), quantileOf(samples, 0.95),
          quantileOf(samples, 1)};
}

void TraceBuffer::columns(Trace trace, std::uint64_t from, std::uint64_t to, std::size_t wanted,
                          std::vector<Column>& out) const {
  out.clear();
  from = std::max(from, begin());
  to = std::min(to, end());
  if (from >= to || wanted == 0) return;
  const std::uint64_t each = std::max<std::uint64_t>(1, (to - from + wanted - 1) / wanted);
  const bool byBlock = each >= 2 * kBlock;
  // Whole multiples from frame 0 on, so that a column keeps its frames while the plot scrolls.
  const std::uint64_t width = byBlock ? each / kBlock * kBlock : each;
  for (std::uint64_t f = from / width * width; f < to; f += width) {
    const std::uint64_t last = std::min(f + width, to);
    // A gap between frames is never inside a column, where nobody would see it.
    for (std::uint64_t first = std::max(f, from); first < last;) {
      const std::uint64_t end = byBlock ? last : gapAfter(first, last);
      out.push_back(column(trace, first, end));
      first = end;
    }
  }
}

std::uint64_t TraceBuffer::gapAfter(std::uint64_t first, std::uint64_t last) const {
  std::uint64_t f = first + 1;
  while (f < last && time(f) - time(f - 1) <= kGapS) ++f;
  return f;
}

TraceBuffer::Column TraceBuffer::column(Trace trace, std::uint64_t first, std::uint64_t last) const {
  const std::size_t i = index(trace);
  Column column{time(first + (last - first) / 2), kNone, kNone};
  for (std::uint64_t f = first; f < last;) {
    if (f % kBlock == 0 && f + kBlock <= last) {
      const std::size_t block = f % capacity_ / kBlock;
      column.low = std::fmin(column.low, blockLow_[i][block]);
      column.high = std::fmax(column.high, blockHigh_[i][block]);
      f += kBlock;
    } else {
      widen(column.low, column.high, values_[i][f % capacity_]);
      ++f;
    }
  }
  return column;
}

std::string TraceBuffer::csv(std::uint64_t from, double to, std::uint64_t end) const {
  std::string out = "time_s,packet";
  for (std::size_t i = 0; i < kCsvTraces; ++i) out.append(",").append(traceName(static_cast<Trace>(i)));
  out += '\n';
  for (std::uint64_t f = std::max(from, begin()); f < std::min(end, count_) && time(f) <= to; ++f) {
    appendNumber(out, time(f));
    out += ',';
    appendNumber(out, packet(f));
    for (std::size_t i = 0; i < kCsvTraces; ++i) {
      out += ',';
      if (const float v = values_[i][f % capacity_]; std::isfinite(v)) appendNumber(out, v);
    }
    out += '\n';
  }
  return out;
}

}  // namespace trimtab::views
