// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve_edit.h"

#include <QObject>
#include <algorithm>
#include <cmath>

#include "trimtab/fuzzy/membership.h"
#include "views/model/keys.h"
#include "views/model/rounded.h"

namespace trimtab::views {

CurveSpec altitudeSpec() {
  return {.key = key::kAltitudeCurve,
          .readingKey = key::kAltitudeReading,
          .quantity = QObject::tr("Altitude"),
          .unit = QStringLiteral("ft"),
          .decimals = 0,
          .view = {3000, 9000},
          .evaluate = [](const TuningParameters& p, double x) { return altitudeMembership(p.altitude, x); },
          .liveX = [](const FrameDecision& d) { return d.altitudeFt; },
          .liveY = [](const FrameDecision& d) { return d.altitudeMembership; },
          .usesPoints = [](const TuningParameters&) { return true; }};
}

CurveSpec pitchSpec() {
  return {.key = key::kPitchCurve,
          .readingKey = key::kPitchReading,
          .quantity = QObject::tr("Pitch"),
          .unit = QStringLiteral("°"),
          .decimals = 1,
          .view = {-45, 45},
          .evaluate = [](const TuningParameters& p, double x) { return pitchMembership(p.pitch, x); },
          .liveX = [](const FrameDecision& d) { return d.pitchDeg; },
          .liveY = [](const FrameDecision& d) { return d.pitchMembership; },
          .usesPoints = [](const TuningParameters& p) { return p.pitch.reading == PitchReading::linear; }};
}

double pointGap(const CurveSpec& spec) {
  return std::pow(10.0, -spec.decimals);
}

Range freeRange(const CurvePoints& curve, std::size_t index, const CurveSpec& spec) {
  Range free = findRow(spec.key)->hard;
  if (index > 0) free.low = std::max(free.low, withoutDust(curve.point[index - 1].x + pointGap(spec)));
  if (index + 1 < curve.size)
    free.high = std::min(free.high, withoutDust(curve.point[index + 1].x - pointGap(spec)));
  return free;
}

Range typedRange(const CurvePoints& curve, std::size_t index, const CurveSpec& spec) {
  Range typed = findRow(spec.key)->hard;
  if (index > 0) typed.low = curve.point[index - 1].x;
  if (index + 1 < curve.size) typed.high = curve.point[index + 1].x;
  return typed;
}

CurvePoints withMoved(const CurvePoints& curve, std::size_t index, CurvePoint to, const CurveSpec& spec) {
  const Range free = freeRange(curve, index, spec);
  CurvePoints moved = curve;
  // Neighbours closer than the gap (typed elsewhere) leave no room: such a point moves up and down only.
  if (free.low <= free.high) moved.point[index].x = std::clamp(to.x, free.low, free.high);
  moved.point[index].y = std::clamp(to.y, 0.0, 1.0);
  return moved;
}

std::optional<Inserted> withInserted(const CurvePoints& curve, CurvePoint point, const CurveSpec& spec) {
  if (curve.size >= CurvePoints::kCapacity) return std::nullopt;
  const std::size_t index = static_cast<std::size_t>(
      std::ranges::upper_bound(curve.span(), point.x, {}, &CurvePoint::x) - curve.span().begin());
  Inserted inserted{curve, index};
  CurvePoints& c = inserted.curve;
  std::move_backward(c.point.begin() + static_cast<std::ptrdiff_t>(index),
                     c.point.begin() + static_cast<std::ptrdiff_t>(c.size),
                     c.point.begin() + static_cast<std::ptrdiff_t>(c.size + 1));
  c.point[index] = point;
  ++c.size;
  const Range free = freeRange(c, index, spec);
  if (!(free.low <= free.high)) return std::nullopt;
  c = withMoved(c, index, point, spec);
  return inserted;
}

CurvePoints withAllMoved(const CurvePoints& curve, std::span<const std::size_t> indexes, CurvePoint by,
                         const CurveSpec& spec) {
  const auto isMoved = [&](std::size_t i) { return std::ranges::find(indexes, i) != indexes.end(); };
  for (const std::size_t i : indexes) {
    // A neighbour that moves too keeps its distance.
    Range free = freeRange(curve, i, spec);
    const Range hard = findRow(spec.key)->hard;
    if (i > 0 && isMoved(i - 1)) free.low = hard.low;
    if (i + 1 < curve.size && isMoved(i + 1)) free.high = hard.high;
    const CurvePoint& from = curve.point[i];
    by.x = std::clamp(by.x, std::min(free.low - from.x, 0.0), std::max(free.high - from.x, 0.0));
    by.y = std::clamp(by.y, std::min(-from.y, 0.0), std::max(1 - from.y, 0.0));
  }
  CurvePoints moved = curve;
  for (const std::size_t i : indexes) {
    moved.point[i].x = withoutDust(moved.point[i].x + by.x);
    moved.point[i].y = std::clamp(withoutDust(moved.point[i].y + by.y), 0.0, 1.0);
  }
  return moved;
}

std::optional<CurvePoints> withAllRemoved(const CurvePoints& curve, std::span<const std::size_t> indexes) {
  std::optional<CurvePoints> left = curve;
  for (std::size_t i = indexes.size(); i-- > 0 && left;) left = withRemoved(*left, indexes[i]);
  return left;
}

std::optional<CurvePoints> withRemoved(const CurvePoints& curve, std::size_t index) {
  if (curve.size <= 2 || index >= curve.size) return std::nullopt;
  CurvePoints removed = curve;
  std::move(removed.point.begin() + static_cast<std::ptrdiff_t>(index + 1),
            removed.point.begin() + static_cast<std::ptrdiff_t>(removed.size),
            removed.point.begin() + static_cast<std::ptrdiff_t>(index));
  removed.point[--removed.size] = {};
  return removed;
}

}  // namespace trimtab::views
