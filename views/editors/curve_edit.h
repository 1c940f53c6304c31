// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <cstddef>
#include <optional>
#include <string_view>

#include "trimtab/frame/frame.h"
#include "trimtab/preset/table.h"

namespace trimtab::views {

/// A membership curve as its editors see it.
struct CurveSpec {
  std::string_view key;
  std::string_view readingKey;
  QString quantity;  ///< "Altitude"
  QString unit;      ///< "ft"
  int decimals = 0;  ///< of x
  Range view;        ///< x that is always in sight
  /// What decide() computes for x.
  double (*evaluate)(const TuningParameters&, double x) = nullptr;
  double (*liveX)(const FrameDecision&) = nullptr;
  double (*liveY)(const FrameDecision&) = nullptr;
  /// Whether the chosen reading looks at the points at all.
  bool (*usesPoints)(const TuningParameters&) = nullptr;
};
CurveSpec altitudeSpec();
CurveSpec pitchSpec();

/// Smallest distance between neighbours' x: one unit of the last decimal shown.
double pointGap(const CurveSpec& spec);

/// Where x of a point may lie: strictly between its neighbours, within the row's hard range.
Range freeRange(const CurvePoints& curve, std::size_t index, const CurveSpec& spec);
/// The curve with one point moved as near to `to` as its neighbours and 0..1 allow.
CurvePoints withMoved(const CurvePoints& curve, std::size_t index, CurvePoint to, const CurveSpec& spec);
struct Inserted {
  CurvePoints curve;
  std::size_t index = 0;
};
/// None: the curve is full, or there is no room between the neighbours.
std::optional<Inserted> withInserted(const CurvePoints& curve, CurvePoint point, const CurveSpec& spec);
/// None: two points must stay.
std::optional<CurvePoints> withRemoved(const CurvePoints& curve, std::size_t index);

}  // namespace trimtab::views
