#include <algorithm>
#include <cmath>
#include <limits>

#include "drawing.h"

namespace trimtab::plot {
namespace {

double valueAt(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text)
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  return lines;
}

/// Categories down the side: stacked bars, and points with intervals.
class RowsDrawing : public Drawing {
 public:
  RowsDrawing(const Plot& plot, double textPx) : Drawing(plot, textPx) {
    std::vector<double> ends;
    for (std::size_t row = 0; row < plot.categories.size(); ++row) {
      double sum = 0;
      for (const Series& s : plot.series) {
        const double value = valueAt(s.y, row);
        if (s.draw == Series::Draw::line && std::isfinite(value)) ends.push_back(sum += value);
        if (s.draw == Series::Draw::line) continue;
        for (const auto* list : {&s.y, &s.xLow, &s.xHigh}) ends.push_back(valueAt(*list, row));
      }
    }
    for (const Guide& g : plot.guides)
      if (g.axis == Guide::Axis::x) ends.push_back(g.at);
    bool bars = false;
    for (const Series& s : plot.series) bars = bars || s.draw == Series::Draw::line;
    x_ = Axis::of(ends, plot.logX, bars, plot.widthPx < 480 ? 4 : 6);
  }

  void draw() override {
    std::size_t lines = 1;
    double widest = 0;
    for (const std::string& category : plot_.categories) {
      const auto parts = linesOf(category);
      lines = std::max(lines, parts.size());
      for (const std::string& part : parts) widest = std::max(widest, textWidthPx(part, svg_.textPx()));
    }
    const double row = svg_.textPx() * (1.15 * static_cast<double>(lines) + 0.9);
    left_ = 16 + std::min(widest, plot_.widthPx * 0.42);
    right_ = plot_.widthPx - 20;
    top_ = drawHead();
    bottom_ = top_ + row * static_cast<double>(std::max<std::size_t>(plot_.categories.size(), 1));
    height_ = bottom_ + svg_.textPx() * (plot_.xLabel.empty() ? 2.4 : 3.9);
    drawXLabel(height_ - svg_.textPx() * 0.7);
    grid();
    for (std::size_t i = 0; i < plot_.categories.size(); ++i)
      drawRow(i, top_ + row * (static_cast<double>(i) + 0.5), row);
    drawGuides();
  }

 private:
  double px(double x) const { return left_ + std::clamp(x_.at(x), 0.0, 1.0) * (right_ - left_); }

  void grid() {
    double free = -1e9;
    for (const Tick& tick : x_.ticks()) {
      const double x = px(tick.value), half = textWidthPx(tick.text, svg_.textPx()) / 2;
      svg_.line(x, top_, x, bottom_, "grid");
      if (x - half < free) continue;
      svg_.text(x, bottom_ + 4 + svg_.textPx(), "middle", tick.text);
      free = x + half + 4;
    }
    svg_.line(left_, top_, left_, bottom_, "axis");
    svg_.line(left_, bottom_, right_, bottom_, "axis");
  }

  void drawGuides() {
    for (const Guide& guide : plot_.guides) {
      if (guide.axis != Guide::Axis::x) continue;
      svg_.line(px(guide.at), top_, px(guide.at), bottom_, "axis",
                "stroke-width=\"1.5\" stroke-dasharray=\"8 4\"");
      svg_.text(px(guide.at), top_ - 3, "middle", guide.label);
    }
  }

  void drawRow(std::size_t i, double y, double rowPx) {
    const auto lines = linesOf(plot_.categories[i]);
    const double step = svg_.textPx() * 1.15;
    double at = y - step * (static_cast<double>(lines.size()) - 1) / 2 + svg_.textPx() * 0.35;
    for (const std::string& line : lines) {
      svg_.text(left_ - 8, at, "end", shortened(line, left_ - 12, svg_.textPx()));
      at += step;
    }
    const double bar = std::min(rowPx * 0.72, svg_.textPx() * 1.7);
    double sum = 0;
    for (std::size_t s = 0; s < plot_.series.size(); ++s) {
      const Series& series = plot_.series[s];
      const double value = valueAt(series.y, i);
      const std::string hint = i < series.hints.size() ? series.hints[i] : std::string();
      if (!std::isfinite(value)) continue;
      if (series.draw == Series::Draw::line) {
        // A negative value is a bar to the left.
        const double from = px(std::min(sum, sum + value)), width = px(std::max(sum, sum + value)) - from;
        svg_.bar(from, y - bar / 2, width > 2 ? width - 0.7 : width, bar, look(s), hint);
        sum += value;
      } else {
        drawInterval(s, i, y);
        svg_.marker(px(value), y, 5, i < series.shapes.size() ? series.shapes[i] : look(s), look(s), hint);
      }
    }
  }

  /// An end beyond the axis, or none, is an arrow.
  void drawInterval(std::size_t s, std::size_t i, double y) {
    const Series& series = plot_.series[s];
    const auto end = [&](const std::vector<double>& ends, bool high) {
      if (i >= ends.size() || std::isnan(ends[i])) return std::string();
      const double x = std::isfinite(ends[i]) ? px(ends[i]) : high ? right_ : left_;
      const std::string tip = decimal(x, 1) + ' ' + decimal(y, 1);
      if (std::isfinite(ends[i])) return 'M' + tip + "m0 -5v10M" + tip;
      return 'M' + tip + (high ? "m-6 -4l6 4l-6 4M" : "m6 -4l-6 4l6 4M") + tip;
    };
    for (const bool high : {false, true}) {
      const std::string whisker = end(high ? series.xHigh : series.xLow, high);
      if (!whisker.empty()) svg_.path(whisker + 'H' + decimal(px(series.y[i]), 1), look(s), 2);
    }
  }

  Axis x_;
};

}  // namespace

std::unique_ptr<Drawing> makeRowsDrawing(const Plot& plot, double textPx) {
  return std::make_unique<RowsDrawing>(plot, textPx);
}

}  // namespace trimtab::plot
