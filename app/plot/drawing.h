#pragma once

#include <memory>
#include <string>
#include <vector>

#include "axis.h"
#include "labels.h"
#include "plot.h"
#include "svg.h"

namespace trimtab::plot {

constexpr std::size_t kMarkedPoints = 24;  ///< so few points of a line are marked one by one

/// A plot being drawn: frame, title, axis names and legend are alike for all kinds.
class Drawing {
 public:
  virtual ~Drawing() = default;
  virtual void draw() = 0;

  double height() const { return height_; }
  std::string take() { return svg_.take(); }

 protected:
  Drawing(const Plot& plot, double textPx) : plot_(plot), svg_(textPx), height_(plot.heightPx) {}

  /// Draws what stands around the axes and leaves their box in left_, top_, right_, bottom_.
  void layOut(const Axis& y);
  /// Title and legend; returns where the plot may begin.
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

/// A legend from `x` to `right`, its first line at `y`; returns the last line's y.
double drawLegend(Svg& svg, const std::vector<Key>& keys, double x, double right, double y);

}  // namespace trimtab::plot
