#include "parse_report.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace trimtab::experiment {
namespace {

using Json = nlohmann::ordered_json;

/// NaN is written as null, and infinity as a text.
double numberOf(const Json& json) {
  if (json.is_number()) return json.get<double>();
  if (json == "inf") return std::numeric_limits<double>::infinity();
  if (json == "-inf") return -std::numeric_limits<double>::infinity();
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> numbersOf(const Json& json) {
  std::vector<double> numbers;
  for (const Json& number : json) numbers.push_back(numberOf(number));
  return numbers;
}

Table tableOf(const Json& rows) {
  Table table;
  for (const Json& row : rows) {
    if (table.rows.empty())
      for (const auto& [column, cell] : row.items()) table.columns.push_back(column);
    table.rows.emplace_back();
    for (const std::string& column : table.columns) {
      const Json& cell = row.at(column);
      table.rows.back().push_back(cell.is_number()   ? Cell(cell.get<double>())
                                  : cell.is_string() ? Cell(cell.get<std::string>())
                                                     : Cell());
    }
  }
  return table;
}

Series seriesOf(const Json& json) {
  Series series;
  series.name = json.at("name");
  series.draw = json.at("draw") == "points"   ? Series::Draw::points
                : json.at("draw") == "joined" ? Series::Draw::joined
                                              : Series::Draw::line;
  series.x = numbersOf(json.at("x"));
  series.y = numbersOf(json.at("y"));
  series.xLow = numbersOf(json.at("x_low"));
  series.xHigh = numbersOf(json.at("x_high"));
  series.yLow = numbersOf(json.at("y_low"));
  series.yHigh = numbersOf(json.at("y_high"));
  return series;
}

Plot plotOf(const Json& json) {
  Plot plot;
  plot.file = json.at("file");
  plot.title = json.at("title");
  plot.xLabel = json.at("x_label");
  plot.yLabel = json.at("y_label");
  plot.categories = json.at("categories").get<std::vector<std::string>>();
  plot.rows = json.at("rows");
  plot.logX = json.at("log_x");
  plot.logY = json.at("log_y");
  for (const Json& series : json.at("series")) plot.series.push_back(seriesOf(series));
  return plot;
}

}  // namespace

Result<Report> parseReport(std::string_view json, const std::string& where) {
  try {
    const Json document = Json::parse(json);
    Report report;
    report.name = document.at("experiment");
    report.source = document.at("source");
    report.published = tableOf(document.at("published"));
    report.measured = tableOf(document.at("measured"));
    report.machine = document.at("machine");
    report.notes = document.at("notes").get<std::vector<std::string>>();
    for (const Json& plot : document.at("plots")) report.plots.push_back(plotOf(plot));
    return report;
  } catch (const Json::exception& error) {
    return Finding{Severity::error, where, "", "the report of an experiment", error.what()};
  }
}

}  // namespace trimtab::experiment
