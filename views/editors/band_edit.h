// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "trimtab/preset/table.h"
#include "views/model/list_model.h"

namespace trimtab::views {

/// The smallest distance between band edges, and from the scale's ends: the last digit that editors show.
inline constexpr double kEdgeGap = 0.01;

/// Returns the bands with the lower edges of several, in rising order, moved together by `by`, or by as much
/// as all of them may go.
BandList withEdgesMoved(const BandList& bands, const std::vector<std::size_t>& indexes, double by);
struct InsertedBand {
  BandList bands;
  std::size_t index = 0;
};
/// Returns the bands with a new one from `low` up, which has the size of the band that it splits; nothing if
/// the list is full or there is no room.
std::optional<InsertedBand> withBand(const BandList& bands, double low);
/// Returns the bands without several, in rising order; nothing if none would be left.
std::optional<BandList> withoutBands(const BandList& bands, const std::vector<std::size_t>& indexes);
/// Returns the upper edge of a band; the scale's top for the last.
double highOf(const BandList& bands, std::size_t index);

/// Returns the table of the bands: lower edge, upper edge (that of the next band, read only) and size. An
/// edge is refused beyond its neighbours, a size that is not whole or not in the hard range.
ListTable bandsTable();
enum BandColumn { kBandFrom, kBandTo, kBandWidth, kBandHeight };

}  // namespace trimtab::views
