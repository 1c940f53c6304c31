#include "report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "page.h"
#include "trimtab/preset/preset.h"

namespace trimtab::experiment {
namespace {

using Json = nlohmann::ordered_json;

std::string numberText(double value) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  const double size = std::abs(value);
  if (value == std::round(value) && size < 1e15)
    std::snprintf(text, sizeof text, "%.0f", value);
  else
    std::snprintf(text, sizeof text, size >= 1000 ? "%.0f" : size >= 10 ? "%.2f" : "%.4g", value);
  return text;
}

std::string cellText(const Cell& cell) {
  if (const double* number = std::get_if<double>(&cell)) return numberText(*number);
  if (const std::string* text = std::get_if<std::string>(&cell)) return *text;
  return {};
}

Json cellJson(const Cell& cell) {
  if (const double* number = std::get_if<double>(&cell))
    return std::isfinite(*number) ? Json(*number) : Json();
  if (const std::string* text = std::get_if<std::string>(&cell)) return *text;
  return {};
}

Json rowsJson(const Table& table) {
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    Json object = Json::object();
    for (std::size_t i = 0; i < table.columns.size(); ++i) object[table.columns[i]] = cellJson(row[i]);
    rows.push_back(std::move(object));
  }
  return rows;
}

Json numbersJson(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double v : values)
    list.push_back(std::isfinite(v) ? Json(v) : std::isnan(v) ? Json() : Json(v > 0 ? "inf" : "-inf"));
  return list;
}

Json seriesJson(const Series& series) {
  constexpr std::array kDraw{"line", "points", "joined"};
  return {{"name", series.name},
          {"draw", kDraw[static_cast<std::size_t>(series.draw)]},
          {"x", numbersJson(series.x)},
          {"y", numbersJson(series.y)},
          {"x_low", numbersJson(series.xLow)},
          {"x_high", numbersJson(series.xHigh)},
          {"y_low", numbersJson(series.yLow)},
          {"y_high", numbersJson(series.yHigh)}};
}

Json plotJson(const Plot& plot) {
  Json series = Json::array();
  for (const Series& s : plot.series) series.push_back(seriesJson(s));
  return {{"file", plot.file},
          {"title", plot.title},
          {"x_label", plot.xLabel},
          {"y_label", plot.yLabel},
          {"categories", plot.categories},
          {"rows", plot.rows},
          {"log_x", plot.logX},
          {"log_y", plot.logY},
          {"series", series}};
}

void appendTable(std::string& text, const Table& table) {
  std::vector<std::size_t> width;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    width.push_back(table.columns[c].size());
    for (const auto& row : table.rows) width[c] = std::max(width[c], cellText(row[c]).size());
  }
  const auto line = [&](const auto& cellOf) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const std::string cell = cellOf(c);
      text += std::string(width[c] - cell.size() + (c > 0 ? 2 : 0), ' ') + cell;
    }
    text += '\n';
  };
  line([&](std::size_t c) { return table.columns[c]; });
  for (const auto& row : table.rows) line([&](std::size_t c) { return cellText(row[c]); });
}

}  // namespace

void Table::add(const std::vector<std::pair<const char*, Cell>>& row) {
  const bool first = rows.empty();
  rows.emplace_back();
  for (const auto& [name, cell] : row) {
    if (first) columns.emplace_back(name);
    rows.back().push_back(cell);
  }
}

double Table::number(std::size_t row, std::string_view column) const {
  const auto at = std::find(columns.begin(), columns.end(), column);
  const double* value = at == columns.end()
                            ? nullptr
                            : std::get_if<double>(&rows[row][static_cast<std::size_t>(at - columns.begin())]);
  return value ? *value : std::numeric_limits<double>::quiet_NaN();
}

std::string Table::text(std::size_t row, std::string_view column) const {
  const auto at = std::find(columns.begin(), columns.end(), column);
  return at == columns.end() ? std::string()
                             : cellText(rows[row][static_cast<std::size_t>(at - columns.begin())]);
}

std::string toJson(const Report& report) {
  Json plots = Json::array();
  for (const Plot& plot : report.plots) plots.push_back(plotJson(plot));
  const Json json = {{"experiment", report.name},
                     {"source", report.source},
                     {"published", rowsJson(report.published)},
                     {"measured", rowsJson(report.measured)},
                     {"machine", report.machine},
                     {"notes", report.notes},
                     {"plots", plots}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string toText(const Report& report) {
  std::string text = report.name + " (" + report.source + ")\n" + report.machine + '\n';
  if (!report.published.rows.empty()) {
    text += "\npublished\n";
    appendTable(text, report.published);
  }
  text += "\nmeasured\n";
  appendTable(text, report.measured);
  if (!report.notes.empty()) text += '\n';
  for (const std::string& note : report.notes) text += "* " + note + '\n';
  return text;
}

std::string toCsv(const Table& table) {
  std::string text;
  const auto append = [&text](const std::string& cell, bool first) {
    if (!first) text += ',';
    if (cell.find_first_of(",\"\n") == std::string::npos) {
      text += cell;
      return;
    }
    text += '"';
    for (const char c : cell) text += c == '"' ? std::string("\"\"") : std::string(1, c);
    text += '"';
  };
  for (std::size_t c = 0; c < table.columns.size(); ++c) append(table.columns[c], c == 0);
  text += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) append(cellText(row[c]), c == 0);
    text += '\n';
  }
  return text;
}

Result<Done> writeReport(const std::filesystem::path& folder, const Report& report) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Finding{Severity::error, folder.string(), {}, "a folder to write to", error.message()};
  Findings findings;
  const auto write = [&](const std::string& name, const std::string& text) {
    const auto done = writeAtomically(folder / name, text);
    findings.insert(findings.end(), done.findings().begin(), done.findings().end());
    return done.ok();
  };
  const std::string json = toJson(report);
  bool good = write(report.name + ".json", json);
  good = write(report.name + ".html", pageWith(json)) && good;
  if (!report.published.rows.empty())
    good = write(report.name + "-published.csv", toCsv(report.published)) && good;
  good = write(report.name + "-measured.csv", toCsv(report.measured)) && good;
  if (!good) return findings;
  return {Done{}, findings};
}

}  // namespace trimtab::experiment
