#include "trimtab/host/placement_list.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "delimited_text.h"
#include "log_columns.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

constexpr std::array<std::string_view, 1> kModelNames{"model"}, kHeightNames{"height"},
    kHeadingNames{"heading"}, kScaleNames{"scale"};
constexpr std::array<std::string_view, 2> kPlacedLatitudeNames{"latitude", "lat"};
constexpr std::array<std::string_view, 4> kPlacedLongitudeNames{"longitude", "lon", "long", "lng"};
constexpr std::array kAngles{Unit::degrees, Unit::none, Unit::radians};
constexpr std::array kLengths{Unit::metres, Unit::feet};
constexpr std::array kPlain{Unit::none};
constexpr double kMetresPerFoot = 0.3048;

/// The columns of a table of placements.
struct PlacementColumns {
  std::optional<LogColumn> model, latitude, longitude, height, heading, scale;
};

/// Reads rows of one table, each to a placement or to what is wrong with it.
class PlacementRows {
 public:
  PlacementRows(DelimitedText& table, const PlacementColumns& columns) : table_(table), columns_(columns) {}

  /// Returns what is wrong with the row that the table is at, or none if `list` has it now.
  std::optional<Finding> read(PlacementList& list) {
    wrong_.reset();
    if (!table_.rowFits())
      return Finding{
          Severity::warning, table_.place(), "",
          std::to_string(table_.header().size()) + " cells, as the header has; the row is left out",
          std::to_string(table_.cells().size())};
    const std::string_view name = columns_.model->cell(table_.cells());
    if (name.empty()) fail(*columns_.model, "the file of a model", name);
    ListedPlacement row;
    row.latitude = Degrees{number(columns_.latitude, -90, 90, {})};
    row.longitude = Degrees{number(columns_.longitude, -360, 360, {})};
    const double heading = PlacementLimits::kHeadingDeg, height = PlacementLimits::kHeightM;
    row.heading = Degrees{number(columns_.heading, -heading, heading, 0)};
    row.scale = number(columns_.scale, PlacementLimits::kLeastScale, PlacementLimits::kMostScale, 1);
    if (columns_.height && !columns_.height->cell(table_.cells()).empty())
      row.height = Metres{number(columns_.height, -height, height, {})};
    if (wrong_) return wrong_;
    const auto [known, isNew] =
        numbers_.try_emplace(std::string(name), static_cast<std::uint32_t>(list.models.size()));
    if (isNew) list.models.emplace_back(name);
    row.model = known->second;
    row.line = static_cast<std::uint32_t>(table_.line());
    list.placements.push_back(row);
    return {};
  }

 private:
  void fail(const LogColumn& column, const std::string& expected, std::string_view cell) {
    if (!wrong_)
      wrong_ = Finding{Severity::warning, table_.place(), column.name, expected + "; the row is left out",
                       cellText(cell)};
  }
  /// Returns a cell in degrees, metres or as it is. `unsaid` is what an empty cell means, if it may be empty.
  double number(const std::optional<LogColumn>& column, double least, double most,
                std::optional<double> unsaid) {
    if (!column) return unsaid.value_or(0);
    const std::string_view cell = column->cell(table_.cells());
    if (cell.empty() && unsaid) return *unsaid;
    double value = table_.number(cell).value_or(NAN);
    if (column->unit == Unit::radians) value *= 180 / std::numbers::pi;
    if (column->unit == Unit::feet) value *= kMetresPerFoot;
    // A comparison with NaN is false.
    if (!(value >= least && value <= most)) {
      const char* const unit = column->unit == Unit::metres || column->unit == Unit::feet ? " m"
                               : &column == &columns_.scale                               ? ""
                                                                                          : " degrees";
      fail(*column, numberText(least) + " to " + numberText(most) + unit, cell);
    }
    return value;
  }

  DelimitedText& table_;
  const PlacementColumns& columns_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::optional<Finding> wrong_;
};

}  // namespace

std::string PlacementList::placeOf(std::size_t placement, const std::string& otherwise) const {
  const auto after = std::partition_point(
      tables.begin(), tables.end(), [&](const PlacementTable& table) { return table.first <= placement; });
  return (after == tables.begin() ? otherwise : (after - 1)->where) + ':' +
         std::to_string(placements[placement].line);
}

Result<PlacementList> readPlacementList(std::string_view text, const std::string& where) {
  Findings opened;
  DelimitedText table(text, where);
  if (!table.open(opened)) return opened;
  FindingList findings;
  findings.add(opened);
  const LogColumns header(table.header());
  bool twice = false;
  PlacementColumns columns;
  columns.model = header.find(kModelNames, kPlain, twice);
  columns.latitude = header.find(kPlacedLatitudeNames, kAngles, twice);
  columns.longitude = header.find(kPlacedLongitudeNames, kAngles, twice);
  columns.height = header.find(kHeightNames, kLengths, twice);
  columns.heading = header.find(kHeadingNames, kAngles, twice);
  columns.scale = header.find(kScaleNames, kPlain, twice);
  if (twice || !columns.model || !columns.latitude || !columns.longitude)
    return Finding{Severity::error, table.headerPlace(), "",
                   "a header with one column each for model, latitude_deg and longitude_deg, and at most one "
                   "for height_m, heading_deg and scale",
                   table.beginning()};
  if (!columns.height && header.find(kHeightNames, kPlain, twice))
    return Finding{Severity::error, table.headerPlace(), "height", "height_m or height_ft",
                   "a height that does not say its unit"};
  PlacementList list;
  PlacementRows rows(table, columns);
  while (table.nextRow())
    if (auto wrong = rows.read(list)) findings.add(std::move(*wrong));
  if (list.placements.empty())
    findings.add({Severity::error, where, "", "at least one row that says where an object stands", "none"});
  Findings all = findings.all(where);
  if (hasError(all)) return all;
  return Result<PlacementList>(std::move(list), std::move(all));
}

}  // namespace trimtab
