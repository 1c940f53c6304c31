// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <cstddef>
#include <optional>
#include <string_view>

#include "trimtab/frame/frame.h"
#include "trimtab/preset/table.h"

namespace trimtab::views {

/// What the editors need to know about a membership curve.
struct CurveSpec {
  std::string_view key;
  std::string_view readingKey;
  QString quantity;  ///< such as "Altitude"
  QString unit;      ///< such as "ft"
  int decimals = 0;  ///< of x
  Range view;        ///< the range of x that the plot always shows
  /// Returns the membership that decide() computes for x.
  double (*evaluate)(const TuningParameters&, double x) = nullptr;
  double (*liveX)(const FrameDecision&) = nullptr;
  double (*liveY)(const FrameDecision&) = nullptr;
  /// Reports whether the chosen reading uses the points at all.
  bool (*usesPoints)(const TuningParameters&) = nullptr;
};
CurveSpec altitudeSpec();
CurveSpec pitchSpec();

/// Returns the smallest distance between neighbours' x: one unit of the last decimal shown.
double pointGap(const CurveSpec& spec);

/// Returns where x of a point may lie: strictly between its neighbours, within the row's hard range.
Range freeRange(const CurvePoints& curve, std::size_t index, const CurveSpec& spec);
/// Returns the curve with one point moved as near to `to` as its neighbours and 0..1 allow.
CurvePoints withMoved(const CurvePoints& curve, std::size_t index, CurvePoint to, const CurveSpec& spec);
struct Inserted {
  CurvePoints curve;
  std::size_t index = 0;
};
/// Returns the curve with one point more; nothing if the curve is full or there is no room between the
/// neighbours.
std::optional<Inserted> withInserted(const CurvePoints& curve, CurvePoint point, const CurveSpec& spec);
/// Returns the curve without one point; nothing if only two are left.
std::optional<CurvePoints> withRemoved(const CurvePoints& curve, std::size_t index);

}  // namespace trimtab::views
