// SPDX-License-Identifier: GPL-3.0-or-later
#include "band_edit.h"

#include <algorithm>

#include "views/model/rounded.h"

namespace trimtab::views {

double highOf(const BandList& bands, std::size_t index) {
  return index + 1 < bands.size ? bands.band[index + 1].low : BandList::kTop;
}

Range freeEdgeRange(const BandList& bands, std::size_t index) {
  const double below = index > 0 ? bands.band[index - 1].low : 0;
  return {withoutDust(below + kEdgeGap), withoutDust(highOf(bands, index) - kEdgeGap)};
}

BandList withEdge(const BandList& bands, std::size_t index, double low) {
  const Range free = freeEdgeRange(bands, index);
  BandList moved = bands;
  if (free.low <= free.high) moved.band[index].low = std::clamp(low, free.low, free.high);
  return moved;
}

std::optional<InsertedBand> withBand(const BandList& bands, double low) {
  if (bands.size >= BandList::kCapacity) return std::nullopt;
  std::size_t index = 0;
  while (index < bands.size && bands.band[index].low <= low) ++index;
  const double below = index > 0 ? bands.band[index - 1].low : 0;
  const double above = index < bands.size ? bands.band[index].low : BandList::kTop;
  const double least = withoutDust(below + kEdgeGap), most = withoutDust(above - kEdgeGap);
  if (least > most) return std::nullopt;
  InsertedBand inserted{bands, index};
  BandList& b = inserted.bands;
  for (std::size_t i = b.size; i > index; --i) b.band[i] = b.band[i - 1];
  ++b.size;
  b.band[index] = index > 0 ? b.band[index - 1] : index + 1 < b.size ? b.band[index + 1] : Band{0, 320, 240};
  b.band[index].low = std::clamp(low, least, most);
  return inserted;
}

std::optional<BandList> withoutBand(const BandList& bands, std::size_t index) {
  if (bands.size <= 1 || index >= bands.size) return std::nullopt;
  BandList removed = bands;
  for (std::size_t i = index; i + 1 < removed.size; ++i) removed.band[i] = removed.band[i + 1];
  removed.band[--removed.size] = {};
  return removed;
}

}  // namespace trimtab::views
