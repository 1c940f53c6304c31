#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/plot/plot.h"
#include "trimtab/units/result.h"

/// The result of an experiment: the published rows beside the measured ones.
namespace trimtab::experiment {

/// A cell of a table; empty if the row has no value in that column.
using Cell = std::variant<std::monostate, double, std::string>;

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;  ///< each as long as `columns`

  /// Returns the number in a column by its name; NaN if the cell has none.
  double number(std::size_t row, std::string_view column) const;
  std::string text(std::size_t row, std::string_view column) const;
};

using plot::Plot;
using plot::Series;
using plot::toSvg;

struct Report {
  std::string name;                ///< "culling"
  std::string source;              ///< "A, B: comparison of culling"
  std::string machine;             ///< processor, cores and renderer
  Table published, measured;       ///< published is empty for what no document has
  std::vector<std::string> notes;  ///< conditions, and where and why measured rows differ
  std::vector<Plot> plots;
};

/// Returns `{published: [..], measured: [..], machine, notes}`, each row an object keyed by column names.
std::string toJson(const Report& report);
/// Returns both tables with aligned columns, and the notes.
std::string toText(const Report& report);
std::string toCsv(const Table& table);
/// Writes NAME.json, NAME-published.csv, NAME-measured.csv and one SVG per plot, each atomically.
Result<Done> writeReport(const std::filesystem::path& folder, const Report& report);

/// Reads the tables of a report from its JSON, for a program that runs the command and shows them.
Result<Report> parseReport(std::string_view json, const std::string& where);

}  // namespace trimtab::experiment
