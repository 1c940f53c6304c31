// SPDX-License-Identifier: GPL-3.0-or-later
#include "band_edit.h"

#include <algorithm>

#include "edit_points.h"
#include "views/model/rounded.h"

namespace trimtab::views {
namespace {

PointRow edgesOf(const BandList& bands) {
  PointRow row{{}, {kEdgeGap, BandList::kTop - kEdgeGap}, [](std::size_t) { return kEdgeGap; }};
  for (const Band& band : bands.span()) row.x.push_back(band.low);
  return row;
}

}  // namespace

double highOf(const BandList& bands, std::size_t index) {
  return index + 1 < bands.size ? bands.band[index + 1].low : BandList::kTop;
}

Range freeEdgeRange(const BandList& bands, std::size_t index) {
  return edgesOf(bands).freeRange(index);
}

BandList withEdgesMoved(const BandList& bands, const std::vector<std::size_t>& indexes, double by) {
  by = edgesOf(bands).step(indexes, by);
  BandList moved = bands;
  for (const std::size_t i : indexes) moved.band[i].low = withoutDust(moved.band[i].low + by);
  return moved;
}

std::optional<InsertedBand> withBand(const BandList& bands, double low) {
  if (bands.size >= BandList::kCapacity) return std::nullopt;
  InsertedBand inserted{bands, 0};
  std::size_t& index = inserted.index;
  BandList& b = inserted.bands;
  while (index < b.size && b.band[index].low <= low) ++index;
  for (std::size_t i = b.size; i > index; --i) b.band[i] = b.band[i - 1];
  ++b.size;
  b.band[index] = index > 0 ? b.band[index - 1] : index + 1 < b.size ? b.band[index + 1] : Band{0, 320, 240};
  const Range free = freeEdgeRange(b, index);
  if (free.low > free.high) return std::nullopt;
  b.band[index].low = std::clamp(low, free.low, free.high);
  return inserted;
}

std::optional<BandList> withoutBands(const BandList& bands, const std::vector<std::size_t>& indexes) {
  if (bands.size <= indexes.size()) return std::nullopt;
  BandList left;
  for (std::size_t i = 0; i < bands.size; ++i)
    if (std::ranges::find(indexes, i) == indexes.end()) left.band[left.size++] = bands.band[i];
  return left;
}

}  // namespace trimtab::views
