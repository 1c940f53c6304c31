// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve_edit.h"

#include <QObject>
#include <algorithm>
#include <cmath>

#include "edit_points.h"
#include "trimtab/fuzzy/membership.h"
#include "views/model/keys.h"
#include "views/model/rounded.h"

namespace trimtab::views {
namespace {

PointRow rowOfPoints(const CurvePoints& curve, const CurveSpec& spec) {
  PointRow row{{}, findRow(spec.key)->hard, [gap = pointGap(spec)](std::size_t) { return gap; }};
  for (const CurvePoint& point : curve.span()) row.x.push_back(point.x);
  return row;
}

}  // namespace

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

Range typedRange(const CurvePoints& curve, std::size_t index, const CurveSpec& spec) {
  Range typed = findRow(spec.key)->hard;
  if (index > 0) typed.low = curve.point[index - 1].x;
  if (index + 1 < curve.size) typed.high = curve.point[index + 1].x;
  return typed;
}

CurvePoints withMoved(const CurvePoints& curve, const std::vector<std::size_t>& indexes, CurvePoint by,
                      const CurveSpec& spec) {
  std::vector<double> memberships;
  for (const std::size_t i : indexes) memberships.push_back(curve.point[i].y);
  by = {rowOfPoints(curve, spec).step(indexes, by.x), membershipStep(memberships, by.y)};
  CurvePoints moved = curve;
  for (const std::size_t i : indexes) {
    moved.point[i].x = withoutDust(moved.point[i].x + by.x);
    moved.point[i].y = std::clamp(withoutDust(moved.point[i].y + by.y), 0.0, 1.0);
  }
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
  const Range free = rowOfPoints(c, spec).freeRange(index);
  if (!(free.low <= free.high)) return std::nullopt;
  c.point[index] = {std::clamp(point.x, free.low, free.high), std::clamp(point.y, 0.0, 1.0)};
  return inserted;
}

std::optional<CurvePoints> withRemoved(const CurvePoints& curve, const std::vector<std::size_t>& indexes) {
  if (curve.size < indexes.size() + 2) return std::nullopt;
  CurvePoints left;
  for (std::size_t i = 0; i < curve.size; ++i)
    if (std::ranges::find(indexes, i) == indexes.end()) left.point[left.size++] = curve.point[i];
  return left;
}

}  // namespace trimtab::views
