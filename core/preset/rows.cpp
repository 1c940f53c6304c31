#include <algorithm>

#include "fuzzy_rows.h"
#include "hold_rows.h"
#include "host_rows.h"
#include "motion_rows.h"
#include "object_rows.h"
#include "policy_rows.h"
#include "static_lod_rows.h"
#include "symbology_rows.h"
#include "terrain_rows.h"
#include "trimtab/preset/rules.h"
#include "view_rows.h"
#include "weather_rows.h"

namespace trimtab {

namespace {

// Groups of keys stay together, in the order people should read them.
constexpr std::array kTable =
    table::joined(table::kFuzzyRows, table::kViewRows, table::kTerrainRows, table::kObjectRows,
                  table::kStaticLodRows, table::kMotionRows, table::kWeatherRows, table::kSymbologyRows,
                  table::kPolicyRows, table::kHoldRows, table::kHostRows);

static_assert(table::everyFieldHasOneRow(kTable), "a field of parameters.h has no row, or two");
static_assert(table::keysAreOrderly(kTable), "a key is there twice, or is not beside the keys of its group");

constexpr auto kRows = [] {
  std::array<ParameterRow, kTable.size()> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = kTable[i].row;
  return rows;
}();

consteval Range hardRange(std::string_view key) {
  for (const ParameterRow& r : kRows)
    if (r.key == key) return r.hard;
  throw "no such key";
}

using table::kDefaults;
static_assert(checkCurve(kDefaults.altitude.curve, hardRange("fuzzy.altitude.curve_ft")).flaw ==
              CurveFlaw::none);
static_assert(checkCurve(kDefaults.pitch.curve, hardRange("fuzzy.pitch.curve_deg")).flaw == CurveFlaw::none);
static_assert(checkBands(kDefaults.scheme.bands, hardRange("fuzzy.bands_px")).flaw == BandFlaw::none);
static_assert(checkCurve(kDefaults.weather.severityDensity, hardRange("weather.severity_density")).flaw ==
              CurveFlaw::none);
static_assert(hysteresisLeavesBands(kDefaults) && hysteresisLeavesFrustum(kDefaults));
static_assert(maximumCoversCurve(kDefaults) && someFieldOfViewIsLeft(kDefaults));

/// Indices of rows by rising key.
constexpr auto kByKey = [] {
  std::array<unsigned short, kRows.size()> order{};
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<unsigned short>(i);
  std::sort(order.begin(), order.end(), [](auto a, auto b) { return kRows[a].key < kRows[b].key; });
  return order;
}();

}  // namespace

std::span<const ParameterRow> parameterRows() {
  return kRows;
}

const ParameterRow* findRow(std::string_view key) {
  const auto at = std::lower_bound(kByKey.begin(), kByKey.end(), key,
                                   [](unsigned short i, std::string_view k) { return kRows[i].key < k; });
  return at != kByKey.end() && kRows[*at].key == key ? &kRows[*at] : nullptr;
}

}  // namespace trimtab
