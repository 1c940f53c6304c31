#pragma once

#include <limits>
#include <string>
#include <vector>

/// Pictures of numbers as SVG: experiments and the harness draw with it, headless.
namespace trimtab::plot {

/// What a plot draws in one colour, shape and dash. The lists of a point's properties are empty or as long
/// as its coordinates. NaN breaks a line and is no point; a whisker far beyond all points runs out of
/// the plot.
struct Series {
  std::string name;
  std::vector<double> x, y;
  enum class Draw { line, points, joined, steps };  ///< joined: points and a thin line through them
  Draw draw = Draw::line;
  std::vector<double> xLow{}, xHigh{}, yLow{}, yHigh{};  ///< ends of whiskers
  std::vector<std::string> labels{};                     ///< beside the point; never over another
  std::vector<std::string> hints{};                      ///< shown while the pointer rests on the point
  std::vector<int> shapes{};                             ///< of each point, in place of the series' own
  int look = -1;  ///< index of colour, shape and dash; -1: the place among the series

  static constexpr int kInk = -2;  ///< a look: the colour of text
};

/// A line across the plot that values are compared with, such as a budget.
struct Guide {
  enum class Axis { x, y } axis = Axis::y;
  double at = 0;
  std::string label;
};

/// An entry of a legend; below 0: the colour of text, no shape.
struct Key {
  std::string name;
  int colour = -1, shape = -1;
  bool line = false;  ///< a piece of the line, with the dash of `colour`
};

struct Plot {
  /// `plain` without categories: x against y. `plain` with categories: bars side by side. `rows`: categories
  /// down the side, lines as bars that are stacked to the right, points beside them; values are in `y`.
  enum class Kind { plain, rows };

  std::string file;  ///< name without ending
  std::string title, xLabel, yLabel;
  std::vector<std::string> categories;  ///< "\n" ends a line
  std::vector<Series> series;

  Kind kind = Kind::plain;
  double widthPx = 720, heightPx = 400;  ///< rows make their own height
  bool logX = false, logY = false;       ///< values of 0 and below stand in a band of their own
  /// Ends of the axes where plots are compared; NaN: from the values.
  double xFrom = kAuto, xTo = kAuto, yFrom = kAuto, yTo = kAuto;
  std::vector<Guide> guides{};
  std::vector<Key> keys{};  ///< empty: one for each series
  bool legend = true;

  static constexpr double kAuto = std::numeric_limits<double>::quiet_NaN();
};

/// Whether positive values spread so far that an even scale would crowd most of them at its foot.
bool spansDecades(const std::vector<double>& values);

/// A picture of its own that reads on light and dark pages.
std::string toSvg(const Plot& plot);
/// The same for a page that holds it (no namespace, no ground). Marks carry classes, so that the page may
/// recolour them: f0.. fills and k0.. strokes of a look, and ink, quiet, grid, ground, halo.
std::string toInlineSvg(const Plot& plot);
/// Plots side by side in one picture under one title and one legend, in so many columns.
std::string toSvg(const std::string& title, const std::vector<Key>& keys, const std::vector<Plot>& plots,
                  std::size_t columns);
/// The legend's mark alone, for a page that writes its own.
std::string inlineMark(const Key& key);

}  // namespace trimtab::plot
