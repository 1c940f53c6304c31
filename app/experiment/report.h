#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "trimtab/units/result.h"

/// The result of an experiment: the published rows beside the measured ones.
namespace trimtab::experiment {

/// A cell of a table; empty if the row has no value in that column.
using Cell = std::variant<std::monostate, double, std::string>;

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;  ///< each as long as `columns`

  /// Adds a row by the names of its cells. The first row gives the columns; every other has the same, in the
  /// same order.
  void add(const std::vector<std::pair<const char*, Cell>>& row);

  /// Returns the number in a column by its name; NaN if the cell has none.
  double number(std::size_t row, std::string_view column) const;
  std::string text(std::size_t row, std::string_view column) const;
};

/// What a plot draws in one colour. The lists are empty or as long as `y`. NaN breaks a line and is no point.
struct Series {
  enum class Draw { line, points, joined };  ///< joined: points and a thin line through them

  std::string name;
  std::vector<double> x, y;  ///< without x, one value per category
  Draw draw = Draw::line;
  std::vector<double> xLow{}, xHigh{}, yLow{}, yHigh{};  ///< ends of intervals
};

/// A plot for resources/report.html. With categories, lines are bars: side by side, or with `rows` end to end
/// down the side.
struct Plot {
  std::string file;  ///< a name for the plot's file, without ending
  std::string title, xLabel, yLabel;
  std::vector<std::string> categories;  ///< "\n" ends a line
  std::vector<Series> series;
  bool rows = false;
  bool logX = false, logY = false;  ///< values of 0 and below are in a band of their own
};

struct Report {
  std::string name;                ///< "culling"
  std::string source;              ///< "A, B: comparison of culling"
  std::string machine;             ///< processor, cores and renderer
  Table published, measured;       ///< published is empty for what no document has
  std::vector<std::string> notes;  ///< conditions, and where and why measured rows differ
  std::vector<Plot> plots;
};

/// Returns `{published: [..], measured: [..], machine, notes, plots}`, each row an object keyed by column
/// names. NaN is null, and infinity "inf".
std::string toJson(const Report& report);
/// Returns both tables with aligned columns, and the notes.
std::string toText(const Report& report);
std::string toCsv(const Table& table);
/// Writes NAME.json, NAME.html with tables and plots, NAME-published.csv and NAME-measured.csv, each
/// atomically.
Result<Done> writeReport(const std::filesystem::path& folder, const Report& report);

}  // namespace trimtab::experiment
