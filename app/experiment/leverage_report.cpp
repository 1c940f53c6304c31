#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "leverage.h"
#include "page.h"
#include "trimtab/measure/machine_watch.h"
#include "trimtab/measure/paired_ratio.h"
#include "trimtab/preset/preset.h"

namespace trimtab::experiment {
namespace {

using Json = nlohmann::ordered_json;

/// A number of a row, for writing and for reading.
struct Column {
  const char* name;
  double& (*of)(LeverageRow&);
};
constexpr std::array kColumns{
    Column{"from", [](LeverageRow& r) -> double& { return r.from.value; }},
    Column{"to", [](LeverageRow& r) -> double& { return r.to.value; }},
    Column{"ms_from", [](LeverageRow& r) -> double& { return r.from.ms; }},
    Column{"ms_to", [](LeverageRow& r) -> double& { return r.to.ms; }},
    Column{"won_ms", [](LeverageRow& r) -> double& { return r.wonMs.median; }},
    Column{"won_ms_low", [](LeverageRow& r) -> double& { return r.wonMs.low; }},
    Column{"won_ms_high", [](LeverageRow& r) -> double& { return r.wonMs.high; }},
    Column{"won_percent", [](LeverageRow& r) -> double& { return r.wonPercent.median; }},
    Column{"won_percent_low", [](LeverageRow& r) -> double& { return r.wonPercent.low; }},
    Column{"won_percent_high", [](LeverageRow& r) -> double& { return r.wonPercent.high; }},
    Column{"flip_median_from", [](LeverageRow& r) -> double& { return r.from.flipMedian; }},
    Column{"flip_median_to", [](LeverageRow& r) -> double& { return r.to.flipMedian; }},
    Column{"flip_p95_from", [](LeverageRow& r) -> double& { return r.from.flipP95; }},
    Column{"flip_p95_to", [](LeverageRow& r) -> double& { return r.to.flipP95; }},
    Column{"flip_lost", [](LeverageRow& r) -> double& { return r.flipLost.median; }},
    Column{"flip_lost_low", [](LeverageRow& r) -> double& { return r.flipLost.low; }},
    Column{"flip_lost_high", [](LeverageRow& r) -> double& { return r.flipLost.high; }},
    Column{"geometric_px_from", [](LeverageRow& r) -> double& { return r.from.geometricPx; }},
    Column{"geometric_px_to", [](LeverageRow& r) -> double& { return r.to.geometricPx; }},
    Column{"geometric_px_lost", [](LeverageRow& r) -> double& { return r.geometricPxLost.median; }},
    Column{"geometric_px_lost_low", [](LeverageRow& r) -> double& { return r.geometricPxLost.low; }},
    Column{"geometric_px_lost_high", [](LeverageRow& r) -> double& { return r.geometricPxLost.high; }},
    Column{"flip_lost_per_ms", [](LeverageRow& r) -> double& { return r.flipLostPerMs; }},
};

std::vector<double> numbersOf(LeverageRow row) {
  std::vector<double> numbers;
  for (const Column& column : kColumns) numbers.push_back(column.of(row));
  return numbers;
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// Returns what the interval of the time won says.
const char* verdictOf(const LeverageRow& row) {
  switch (differenceOf(PairedDifference{row.wonMs.median, row.wonMs.low, row.wonMs.high})) {
    case MeasuredDifference::more:
      return "wins time";
    case MeasuredDifference::less:
      return "loses time";
    case MeasuredDifference::none:
      return "no difference";
    case MeasuredDifference::unknown:
      break;
  }
  return "too few frames";
}

/// "Render scale" and "1 to 0.5", with the condition.
std::string nameOf(const LeverageRow& row) {
  const LeverRow& lever = rowOf(row.lever);
  std::string name(lever.label);
  name += formatted("\n%g to %g", row.from.value, row.to.value);
  if (!lever.unit.empty()) name += ' ' + std::string(lever.unit);
  if (!row.condition.empty()) name += "\n" + row.condition;
  return name;
}

Plot rowsOf(const Leverage& leverage, const char* file, const char* name, Estimate LeverageRow::*of) {
  Plot plot{file, "", name, "", {}, {{"median of the frames", {}, {}}, {"95 % interval", {}, {}}}};
  plot.rows = true;
  Series &bars = plot.series[0], &intervals = plot.series[1];
  intervals.draw = Series::Draw::points;
  for (const LeverageRow& row : leverage.rows) {
    const Estimate& value = row.*of;
    plot.categories.push_back(nameOf(row));
    bars.y.push_back(value.median);
    intervals.y.push_back(value.median);
    intervals.xLow.push_back(value.low);
    intervals.xHigh.push_back(value.high);
  }
  return plot;
}

}  // namespace

std::string toJson(const Leverage& leverage) {
  Json rows = Json::array();
  for (const LeverageRow& row : leverage.rows) {
    const LeverRow& lever = rowOf(row.lever);
    Json object = {{"lever", lever.key},
                   {"unit", lever.unit},
                   {"condition", row.condition},
                   {"verdict", verdictOf(row)}};
    const std::vector<double> numbers = numbersOf(row);
    for (std::size_t i = 0; i < kColumns.size(); ++i)
      object[kColumns[i].name] = std::isfinite(numbers[i]) ? Json(numbers[i]) : Json();
    rows.push_back(std::move(object));
  }
  const Json json = {
      {"leverage", rows},
      {"machine", leverage.machine},
      {"flight", leverage.flight},
      {"terrain", leverage.terrain},
      {"preset", leverage.preset},
      {"frames", leverage.frames},
      {"width_px", leverage.widthPx},
      {"height_px", leverage.heightPx},
      {"repeats", leverage.repeats},
      {"others_share", std::isfinite(leverage.othersShare) ? Json(leverage.othersShare) : Json()}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<Leverage> parseLeverage(std::string_view text, const std::string& where) {
  try {
    const Json json = Json::parse(text);
    Leverage leverage;
    for (const Json& object : json.at("leverage")) {
      LeverageRow row;
      const std::string key = object.at("lever");
      const auto lever = leverNamed(key);
      if (!lever) return Finding{Severity::error, where, "lever", "the key of a lever", key};
      row.lever = *lever;
      row.condition = object.at("condition");
      for (const Column& column : kColumns) {
        const Json& value = object.at(column.name);
        column.of(row) = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
      }
      leverage.rows.push_back(std::move(row));
    }
    leverage.machine = json.at("machine");
    leverage.flight = json.at("flight");
    leverage.terrain = json.at("terrain");
    leverage.preset = json.at("preset");
    leverage.frames = json.at("frames");
    leverage.widthPx = json.at("width_px");
    leverage.heightPx = json.at("height_px");
    leverage.repeats = json.at("repeats");
    // Older results do not say it.
    if (const auto others = json.find("others_share"); others != json.end() && !others->is_null())
      leverage.othersShare = *others;
    return leverage;
  } catch (const Json::exception& e) {
    return Finding{Severity::error, where, {}, "the JSON of trimtab-cli leverage", e.what()};
  }
}

Report toReport(const Leverage& leverage) {
  Report report;
  report.name = "leverage";
  report.source = leverage.flight + " over " + leverage.terrain + ", preset " + leverage.preset;
  report.machine = leverage.machine;
  report.measured.columns = {"lever", "unit", "condition", "verdict"};
  for (const Column& column : kColumns) report.measured.columns.push_back(column.name);
  for (const LeverageRow& row : leverage.rows) {
    const LeverRow& lever = rowOf(row.lever);
    std::vector<Cell> cells{std::string(lever.key), std::string(lever.unit), row.condition,
                            std::string(verdictOf(row))};
    for (const double number : numbersOf(row)) cells.emplace_back(number);
    report.measured.rows.push_back(std::move(cells));
  }
  report.notes = {
      formatted(
          "Each lever goes from the end of its usual range that costs more time (from) to the other "
          "(to), all others at rest, without a policy: %zu frames of the flight at %dx%d, each drawn %d "
          "times at both ends in turns, after the image before it.",
          leverage.frames, leverage.widthPx, leverage.heightPx, leverage.repeats),
      "Won and lost are medians of the frames' differences; _low and _high are the ends of their 95 % "
      "intervals; the verdict is what the interval of the milliseconds won says. FLIP and the geometric "
      "error (largest of a frame, pixels) are against the reference image.",
      "flip_lost_per_ms is given only where the interval says that time is won.",
      "A row with a condition has nothing to do in this flight as it is: it is measured with what its "
      "condition names."};
  if (std::string busy = busyText(leverage.othersShare); !busy.empty())
    report.notes.push_back(std::move(busy));
  const auto bars = [&](const char* file, const char* title, const char* label, Estimate LeverageRow::*of) {
    Series series{label, {}, {}};
    Plot plot{file, title, "", label, {}, {}};
    for (const LeverageRow& row : leverage.rows) {
      plot.categories.emplace_back(rowOf(row.lever).label);
      series.y.push_back((row.*of).median);
      series.yLow.push_back((row.*of).low);
      series.yHigh.push_back((row.*of).high);
    }
    plot.series.push_back(std::move(series));
    report.plots.push_back(std::move(plot));
  };
  bars("leverage-ms", "Time that each lever can win", "won (ms a frame)", &LeverageRow::wonMs);
  bars("leverage-flip", "Image that each lever can lose", "lost (FLIP)", &LeverageRow::flipLost);
  bars("leverage-pixels", "Geometry that each lever can lose", "lost (px)", &LeverageRow::geometricPxLost);
  return report;
}

std::string pageOf(const Leverage& leverage) {
  Report report = toReport(leverage);
  report.plots = {rowsOf(leverage, "leverage-ms", "time won (ms a frame)", &LeverageRow::wonMs),
                  rowsOf(leverage, "leverage-flip", "image lost (FLIP, 0 to 1)", &LeverageRow::flipLost),
                  rowsOf(leverage, "leverage-pixels", "geometry lost (px)", &LeverageRow::geometricPxLost)};
  return pageWith(toJson(report));
}

Result<Done> writeLeverage(const std::filesystem::path& folder, const Leverage& leverage) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Finding{Severity::error, folder.string(), {}, "a folder to write to", error.message()};
  Findings findings;
  for (const auto& [name, text] : {std::pair{"leverage.json", toJson(leverage)},
                                   {"leverage.csv", toCsv(toReport(leverage).measured)},
                                   {"leverage.html", pageOf(leverage)}}) {
    const auto done = writeAtomically(folder / name, text);
    findings.insert(findings.end(), done.findings().begin(), done.findings().end());
  }
  if (hasError(findings)) return findings;
  return {Done{}, findings};
}

}  // namespace trimtab::experiment
