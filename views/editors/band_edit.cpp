// SPDX-License-Identifier: GPL-3.0-or-later
#include "band_edit.h"

#include <QObject>
#include <algorithm>
#include <cmath>

#include "edit_points.h"
#include "views/model/keys.h"
#include "views/model/rounded.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

PointRow edgesOf(const BandList& bands) {
  PointRow row{{}, {kEdgeGap, BandList::kTop - kEdgeGap}, [](std::size_t) { return kEdgeGap; }};
  for (const Band& band : bands.span()) row.x.push_back(band.low);
  return row;
}

const BandList& bandsOf(const ParameterValue& list) {
  return std::get<BandList>(list);
}

QString putEdge(ParameterValue& list, std::size_t row, double typed) {
  auto& bands = std::get<BandList>(list);
  const Range free = edgesOf(bands).freeRange(row);
  if (typed < free.low || typed > free.high)
    return QObject::tr("%1 is not between the neighbours: %2 to %3.")
        .arg(numberText(typed, 6), numberText(free.low, 6), numberText(free.high, 6));
  bands.band[row].low = typed;
  return {};
}

ListColumn sizeColumn(const QString& title, int Band::*size) {
  const auto put = [size](ParameterValue& list, std::size_t row, double typed) {
    const Range hard = findRow(key::kBands)->hard;
    if (!(typed >= hard.low && typed <= hard.high) || typed != std::floor(typed))
      return QObject::tr("A size is a whole number from %1 to %2 px, not %3.")
          .arg(numberText(hard.low, 0), numberText(hard.high, 0), numberText(typed, 6));
    std::get<BandList>(list).band[row].*size = static_cast<int>(typed);
    return QString();
  };
  return {title, QStringLiteral("px"), 0,
          [size](const ParameterValue& list, std::size_t row) { return bandsOf(list).band[row].*size; }, put};
}

}  // namespace

ListTable bandsTable() {
  return {
      .key = key::kBands,
      .columns = {{QObject::tr("From"),
                   {},
                   6,
                   [](const ParameterValue& list, std::size_t row) { return bandsOf(list).band[row].low; },
                   putEdge},
                  {QObject::tr("Below"),
                   {},
                   6,
                   [](const ParameterValue& list, std::size_t row) { return highOf(bandsOf(list), row); },
                   {}},
                  sizeColumn(QObject::tr("Width (px)"), &Band::widthPx),
                  sizeColumn(QObject::tr("Height (px)"), &Band::heightPx)}};
}

double highOf(const BandList& bands, std::size_t index) {
  return index + 1 < bands.size ? bands.band[index + 1].low : BandList::kTop;
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
  const Range free = edgesOf(b).freeRange(index);
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
