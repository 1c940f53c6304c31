#include "report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

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

Json plotJson(const Plot& plot) {
  Json series = Json::array();
  const auto numbers = [](const std::vector<double>& values) {
    Json list = Json::array();
    for (const double v : values) list.push_back(std::isfinite(v) ? Json(v) : Json());
    return list;
  };
  for (const Series& s : plot.series)
    series.push_back({{"name", s.name}, {"x", numbers(s.x)}, {"y", numbers(s.y)}});
  return {{"file", plot.file},      {"title", plot.title},           {"x_label", plot.xLabel},
          {"y_label", plot.yLabel}, {"categories", plot.categories}, {"series", series}};
}

Table parseRows(const Json& rows) {
  Table table;
  for (const Json& row : rows) {
    if (table.columns.empty())
      for (const auto& [key, value] : row.items()) table.columns.push_back(key);
    std::vector<Cell> cells;
    for (const std::string& column : table.columns) {
      const Json value = row.value(column, Json());
      if (value.is_number())
        cells.emplace_back(value.get<double>());
      else if (value.is_string())
        cells.emplace_back(value.get<std::string>());
      else
        cells.emplace_back();
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

std::vector<double> parseNumbers(const Json& list) {
  std::vector<double> values;
  for (const Json& v : list)
    values.push_back(v.is_number() ? v.get<double>() : std::numeric_limits<double>::quiet_NaN());
  return values;
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

Result<Report> parseReport(std::string_view text, const std::string& where) {
  try {
    const Json json = Json::parse(text);
    Report report;
    report.name = json.at("experiment").get<std::string>();
    report.source = json.at("source").get<std::string>();
    report.machine = json.at("machine").get<std::string>();
    report.published = parseRows(json.at("published"));
    report.measured = parseRows(json.at("measured"));
    report.notes = json.at("notes").get<std::vector<std::string>>();
    for (const Json& p : json.at("plots")) {
      Plot plot{p.at("file"), p.at("title"), p.at("x_label"), p.at("y_label"), p.at("categories"), {}};
      for (const Json& s : p.at("series"))
        plot.series.push_back({s.at("name"), parseNumbers(s.at("x")), parseNumbers(s.at("y"))});
      report.plots.push_back(std::move(plot));
    }
    return report;
  } catch (const Json::exception& e) {
    return Finding{Severity::error, where, {}, "an experiment's JSON", e.what()};
  }
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
  bool good = write(report.name + ".json", toJson(report));
  if (!report.published.rows.empty())
    good = write(report.name + "-published.csv", toCsv(report.published)) && good;
  good = write(report.name + "-measured.csv", toCsv(report.measured)) && good;
  for (const Plot& plot : report.plots) good = write(plot.file + ".svg", toSvg(plot)) && good;
  if (!good) return findings;
  return {Done{}, findings};
}

}  // namespace trimtab::experiment
