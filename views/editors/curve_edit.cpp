// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve_edit.h"

#include <QObject>
#include <algorithm>
#include <cmath>

#include "edit_points.h"
#include "trimtab/fuzzy/membership.h"
#include "views/model/keys.h"
#include "views/model/rounded.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

PointRow rowOfPoints(const CurvePoints& curve, const CurveSpec& spec) {
  PointRow row{{}, findRow(spec.key)->hard, [gap = pointGap(spec)](std::size_t) { return gap; }};
  for (const CurvePoint& point : curve.span()) row.x.push_back(point.x);
  return row;
}

const CurvePoint& pointOf(const ParameterValue& list, std::size_t row) {
  return std::get<CurvePoints>(list).point[row];
}

QString putX(const CurveSpec& spec, ParameterValue& list, std::size_t row, double typed) {
  auto& curve = std::get<CurvePoints>(list);
  Range free = findRow(spec.key)->hard;
  if (row > 0) free.low = curve.point[row - 1].x;
  if (row + 1 < curve.size) free.high = curve.point[row + 1].x;
  if (typed < free.low || typed > free.high)
    return QObject::tr("%1 %2 is not between the neighbours: %3 to %4 %2.")
        .arg(numberText(typed, 3), spec.unit, numberText(free.low, 3), numberText(free.high, 3));
  curve.point[row].x = typed;
  if (std::ranges::count(curve.span(), typed, &CurvePoint::x) > 2)
    return QObject::tr("Two points at %1 %2 are a step; a third there means nothing.")
        .arg(numberText(typed, 3), spec.unit);
  return {};
}

QString putMembership(ParameterValue& list, std::size_t row, double typed) {
  if (typed < 0 || typed > 1) return QObject::tr("A membership is 0 to 1, not %1.").arg(numberText(typed, 6));
  std::get<CurvePoints>(list).point[row].y = typed;
  return {};
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

ListTable pointsTable(const CurveSpec& spec) {
  return {.key = spec.key,
          .columns = {{QObject::tr("%1 (%2)").arg(spec.quantity, spec.unit), spec.unit, spec.decimals + 3,
                       [](const ParameterValue& list, std::size_t row) { return pointOf(list, row).x; },
                       [spec](ParameterValue& list, std::size_t row, double typed) {
                         return putX(spec, list, row, typed);
                       }},
                      {QObject::tr("Membership"),
                       {},
                       6,
                       [](const ParameterValue& list, std::size_t row) { return pointOf(list, row).y; },
                       putMembership}},
          .readingKey = spec.readingKey,
          .isUsed = spec.usesPoints};
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
