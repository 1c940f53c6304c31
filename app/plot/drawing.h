#pragma once

#include <memory>
#include <string>
#include <vector>

#include "axis.h"
#include "labels.h"
#include "plot.h"
#include "svg.h"

namespace trimtab::plot {

constexpr std::size_t kMarkedPoints = 24;  ///< a line with at most so many points marks each

/// Draws one plot; frame, title, axis labels and legend are the same for all kinds.
class Drawing {
 public:
  virtual ~Drawing() = default;
  virtual void draw() = 0;

  double height() const { return height_; }
  std::string take() { return svg_.take(); }

 protected:
  Drawing(const Plot& plot, double textPx) : plot_(plot), svg_(textPx), height_(plot.heightPx) {}

  /// Draws everything around the axes and stores their box in left_, top_, right_, bottom_.
  void layOut(const Axis& y);
  /// Draws title and legend; returns the y at which the plot may begin.
  double drawHead();
  void drawXLabel(double y);
  int look(std::size_t series) const {
    return plot_.series[series].look == -1 ? static_cast<int>(series) : plot_.series[series].look;
  }

  const Plot& plot_;
  Svg svg_;
  double height_;
  double left_ = 0, top_ = 0, right_ = 0, bottom_ = 0;
};

std::unique_ptr<Drawing> makePlainDrawing(const Plot& plot, double textPx);
std::unique_ptr<Drawing> makeRowsDrawing(const Plot& plot, double textPx);

/// Draws a legend from `x` to `right` with its first line at `y`; returns the y of its last line.
double drawLegend(Svg& svg, const std::vector<Key>& keys, double x, double right, double y);

}  // namespace trimtab::plot
