#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/plot/plot.h"
#include "trimtab/units/result.h"

/// What an experiment yields: the published rows beside ours.
namespace trimtab::experiment {

/// Empty where a row has nothing to say in a column.
using Cell = std::variant<std::monostate, double, std::string>;

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;  ///< each as long as `columns`

  /// The number in a column by its name; NaN where there is none.
  double number(std::size_t row, std::string_view column) const;
  std::string text(std::size_t row, std::string_view column) const;
};

using plot::Plot;
using plot::Series;
using plot::toSvg;

struct Report {
  std::string name;     ///< "culling"
  std::string source;   ///< "A, B: comparison of culling"
  std::string machine;  ///< processor, cores, what draws
  Table published, measured;
  std::vector<std::string> notes;  ///< conditions, and where ours disagrees and why
  std::vector<Plot> plots;
};

/// `{published: [..], measured: [..], machine, notes}`: each row an object by column names.
std::string toJson(const Report& report);
/// Both tables with aligned columns, and the notes.
std::string toText(const Report& report);
std::string toCsv(const Table& table);
/// NAME.json, NAME-published.csv, NAME-measured.csv and an SVG a plot, each written atomically.
Result<Done> writeReport(const std::filesystem::path& folder, const Report& report);

/// The numbers of a report's JSON, for whoever runs the command and shows its tables.
Result<Report> parseReport(std::string_view json, const std::string& where);

}  // namespace trimtab::experiment
