// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/preset/table.h"
#include "views/model/list_model.h"

namespace trimtab::views {

/// Describes a membership curve to its editors: points of x, in `unit`, and membership, 0 to 1, that are
/// joined by straight lines.
struct CurveSpec {
  std::string_view key;         ///< of the parameter that holds the points
  std::string_view readingKey;  ///< of the parameter that chooses how the published curve is read
  QString quantity;             ///< such as "Altitude"
  QString unit;                 ///< such as "ft"
  int decimals = 0;             ///< decimals of x that the editors show
  Range view;                   ///< the range of x, in `unit`, that the plot always shows
  /// Returns the membership that trimtab::decide() computes for x, in `unit`.
  double (*evaluate)(const TuningParameters&, double x) = nullptr;
  /// Return what the last decision used: x in `unit`, and its membership.
  double (*liveX)(const FrameDecision&) = nullptr;
  double (*liveY)(const FrameDecision&) = nullptr;
  /// Reports whether the reading that the parameters choose uses the points; the printed equations do not use
  /// all of them.
  bool (*usesPoints)(const TuningParameters&) = nullptr;
};
/// Return the curves of documents A and B: membership by altitude in feet, and by pitch in degrees.
CurveSpec altitudeSpec();
CurveSpec pitchSpec();

/// Returns the smallest distance in x that the editors leave between two neighbouring points: one unit of the
/// last decimal shown.
double pointGap(const CurveSpec& spec);

/// Returns the table of the points: x and membership. An x may be typed from one neighbour to the other, both
/// included, because two points at one x are a step; a third one there is refused.
ListTable pointsTable(const CurveSpec& spec);
/// Returns the curve with several points, in rising order, moved by the same amount: by `by`, or as far as
/// every one of them may go. Points keep a gap (pointGap) from their neighbours and stay inside the hard
/// range of the parameter.
CurvePoints withMoved(const CurvePoints& curve, const std::vector<std::size_t>& indexes, CurvePoint by,
                      const CurveSpec& spec);
struct Inserted {
  CurvePoints curve;
  std::size_t index = 0;  ///< of the new point
};
/// Returns the curve with `point` added, moved into the free range between its neighbours. Returns nullopt if
/// the curve holds as many points as it can, or if there is no room between the neighbours.
std::optional<Inserted> withInserted(const CurvePoints& curve, CurvePoint point, const CurveSpec& spec);
/// Returns the curve without several points, in rising order. Returns nullopt if fewer than two would be
/// left.
std::optional<CurvePoints> withRemoved(const CurvePoints& curve, const std::vector<std::size_t>& indexes);

}  // namespace trimtab::views
