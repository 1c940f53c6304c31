// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace_buffer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace trimtab::views {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

template <class Number>
void appendNumber(std::string& out, Number value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

/// fmin and fmax pass over NaN.
void widen(float& low, float& high, float value) {
  low = std::fmin(low, value);
  high = std::fmax(high, value);
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
                                                                "head_rate_degps",
                                                                "lod_scale",
                                                                "select_ms",
                                                                "page_ms",
                                                                "occlusion_ms",
                                                                "blur_ms",
                                                                "weather_ms",
                                                                "symbology_ms",
                                                                "vertices",
                                                                "select_top_ms",
                                                                "page_top_ms",
                                                                "occlusion_top_ms",
                                                                "cull_top_ms"};
  return kNames[static_cast<std::size_t>(trace)];
}

TraceBuffer::TraceBuffer(std::size_t capacity)
    : capacity_(std::max(capacity / kBlock, std::size_t{2}) * kBlock) {
  times_.resize(capacity_);
  packets_.resize(capacity_);
  for (auto& v : values_) v.resize(capacity_, kNone);
  for (auto* blocks : {&blockLow_, &blockHigh_})
    for (auto& v : *blocks) v.resize(capacity_ / kBlock, kNone);
}

void TraceBuffer::clear() {
  count_ = 0;
  timeShift_ = 0;
}

std::uint64_t TraceBuffer::begin() const {
  if (count_ <= capacity_) return 0;
  // The block being overwritten is no longer whole.
  const std::uint64_t oldest = count_ - capacity_;
  return (oldest + kBlock - 1) / kBlock * kBlock;
}

void TraceBuffer::append(const LiveFrame& frame) {
  double now = frame.time + timeShift_;
  if (count_ > 0 && now < time(count_ - 1)) {
    timeShift_ += time(count_ - 1) - now;
    now = time(count_ - 1);
  }
  const std::size_t at = count_ % capacity_, block = at / kBlock;
  times_[at] = now;
  packets_[at] = frame.input.state.packet;
  const FrameDecision& d = frame.decision;
  const FrameCost& cost = frame.cost;
  const std::optional<OcclusionResolution>& depthMap = frame.drawn().depthMap;
  const auto measuredOr0 = [](double ms) { return std::isfinite(ms) ? ms : 0.0; };
  const double selectTop = measuredOr0(cost.decide) + measuredOr0(cost.select);
  const double pageTop = selectTop + measuredOr0(cost.page);
  const double occlusionTop = pageTop + measuredOr0(cost.occlusion);
  const double measured[kTraces]{d.altitudeMembership,
                                 d.pitchMembership,
                                 d.totalMembership,
                                 static_cast<double>(frame.drawn().visible.triangles),
                                 cost.total,
                                 frame.fps,
                                 cost.cull,
                                 cost.draw,
                                 cost.gpu,
                                 depthMap ? depthMap->widthPx : 0.0,
                                 d.motion.rateDegPerS,
                                 d.lodScale,
                                 cost.select,
                                 cost.page,
                                 cost.occlusion,
                                 cost.blur,
                                 cost.weather,
                                 cost.symbology,
                                 static_cast<double>(frame.drawn().visible.vertices),
                                 selectTop,
                                 pageTop,
                                 occlusionTop,
                                 occlusionTop + measuredOr0(cost.cull)};
  for (std::size_t i = 0; i < kTraces; ++i) {
    const float value = static_cast<float>(measured[i]);
    values_[i][at] = value;
    if (at % kBlock == 0) blockLow_[i][block] = blockHigh_[i][block] = kNone;
    widen(blockLow_[i][block], blockHigh_[i][block], value);
  }
  ++count_;
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

void TraceBuffer::columns(Trace trace, std::uint64_t from, std::uint64_t to, std::size_t wanted,
                          std::vector<Column>& out) const {
  out.clear();
  from = std::max(from, begin());
  to = std::min(to, end());
  if (from >= to || wanted == 0) return;
  const std::size_t i = index(trace);
  const std::uint64_t each = std::max<std::uint64_t>(1, (to - from + wanted - 1) / wanted);
  const bool byBlock = each >= 2 * kBlock;
  // Whole multiples from frame 0 on, so that a column keeps its frames while the picture scrolls.
  const std::uint64_t width = byBlock ? each / kBlock * kBlock : each;
  for (std::uint64_t f = from / width * width; f < to; f += width) {
    const std::uint64_t first = std::max(f, from), last = std::min(f + width, to);
    Column column{time(first + (last - first) / 2), kNone, kNone};
    std::uint64_t g = first;
    while (g < last) {
      if (byBlock && g % kBlock == 0 && g + kBlock <= last) {
        const std::size_t block = g % capacity_ / kBlock;
        column.low = std::fmin(column.low, blockLow_[i][block]);
        column.high = std::fmax(column.high, blockHigh_[i][block]);
        g += kBlock;
      } else {
        widen(column.low, column.high, values_[i][g % capacity_]);
        ++g;
      }
    }
    out.push_back(column);
  }
}

std::string TraceBuffer::csv(double from, double to) const {
  std::string out = "time_s,packet";
  for (std::size_t i = 0; i < kCsvTraces; ++i) out.append(",").append(traceName(static_cast<Trace>(i)));
  out += '\n';
  for (std::uint64_t f = atOrAfter(from); f < end() && time(f) <= to; ++f) {
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
