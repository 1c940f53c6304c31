// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "trimtab/preset/table.h"

namespace trimtab::views {

/// Smallest distance between band edges, and from the scale's ends: what the editors show and type.
inline constexpr double kEdgeGap = 0.01;

/// Where the lower edge of a band may lie: between its neighbours' edges, within the scale.
Range freeEdgeRange(const BandList& bands, std::size_t index);
BandList withEdge(const BandList& bands, std::size_t index, double low);
struct InsertedBand {
  BandList bands;
  std::size_t index = 0;
};
/// A band from `low` up, with the size of the band that it splits. None: the list is full or there is no
/// room.
std::optional<InsertedBand> withBand(const BandList& bands, double low);
/// None: one band must stay.
std::optional<BandList> withoutBand(const BandList& bands, std::size_t index);
/// The upper edge of a band; the scale's top for the last.
double highOf(const BandList& bands, std::size_t index);

}  // namespace trimtab::views
