#include <algorithm>
#include <cmath>
#include <limits>

#include "drawing.h"

namespace trimtab::plot {
namespace {

double extent(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : std::numeric_limits<double>::quiet_NaN();
}

/// Whiskers widen an axis, but one far value must not crowd the points: what reaches farther runs out of the
/// plot.
void addWhiskers(std::vector<double>& values, const Plot& plot, bool logarithmic,
                 std::vector<double> Series::*lows, std::vector<double> Series::*highs) {
  constexpr double kBeyondValues = 1.5;
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    if (v > 0) smallest = std::min(smallest, v);
    largest = std::max(largest, v);
  }
  for (const Series& s : plot.series) {
    for (const double high : s.*highs)
      if (std::isfinite(high)) values.push_back(std::min(high, largest * kBeyondValues));
    for (const double low : s.*lows)
      if (std::isfinite(low)) values.push_back(logarithmic ? std::max(low, smallest / kBeyondValues) : low);
  }
}

/// x against y, or bars side by side.
class PlainDrawing : public Drawing {
 public:
  PlainDrawing(const Plot& plot, double textPx) : Drawing(plot, textPx), bars_(!plot.categories.empty()) {
    std::vector<double> xs, ys;
    for (const Series& s : plot.series) {
      xs.insert(xs.end(), s.x.begin(), s.x.end());
      ys.insert(ys.end(), s.y.begin(), s.y.end());
    }
    addWhiskers(xs, plot, plot.logX, &Series::xLow, &Series::xHigh);
    addWhiskers(ys, plot, plot.logY, &Series::yLow, &Series::yHigh);
    bool points = !plot.series.empty();
    for (const Series& s : plot.series) points = points && s.draw != Series::Draw::line;
    for (const Guide& g : plot.guides) (g.axis == Guide::Axis::x ? xs : ys).push_back(g.at);
    const int steps = plot.heightPx < 300 ? 4 : 5;
    y_ = std::isfinite(plot.yFrom) && std::isfinite(plot.yTo) ? Axis::exactly(plot.yFrom, plot.yTo)
                                                              : Axis::of(ys, plot.logY, true, steps);
    x_ = bars_ ? Axis::categories(plot.categories.size())
         : std::isfinite(plot.xFrom) && std::isfinite(plot.xTo)
             ? Axis::exactly(plot.xFrom, plot.xTo)
             : Axis::of(xs, plot.logX, points, plot.widthPx < 480 ? 4 : 5);
    if (!points || bars_) return;
    x_.widen(0.03, 0.03);
    y_.widen(0, 0.03);
  }

  void draw() override {
    layOut(y_);
    grid();
    if (bars_) return drawBars();
    // Lines lie under the points of all series, labels over everything.
    for (std::size_t s = 0; s < plot_.series.size(); ++s) drawLine(s);
    for (std::size_t s = 0; s < plot_.series.size(); ++s) drawPoints(s);
    drawLabels();
  }

 private:
  double px(double x) const { return left_ + std::clamp(x_.at(x), 0.0, 1.0) * (right_ - left_); }
  double py(double y) const { return bottom_ - std::clamp(y_.at(y), 0.0, 1.0) * (bottom_ - top_); }

  void grid() {
    for (const Tick& tick : y_.ticks()) {
      svg_.line(left_, py(tick.value), right_, py(tick.value), "grid");
      svg_.text(left_ - 6, py(tick.value) + svg_.textPx() * 0.32, "end", tick.text);
    }
    if (bars_)
      for (std::size_t i = 0; i < plot_.categories.size(); ++i)
        category(px(static_cast<double>(i) + 0.5), plot_.categories[i]);
    else
      tickX();
    svg_.line(left_, bottom_, right_, bottom_, "axis");
    svg_.line(left_, top_, left_, bottom_, "axis");
    for (const Guide& guide : plot_.guides) drawGuide(guide);
  }

  void drawGuide(const Guide& guide) {
    constexpr const char* kDashed = "stroke-dasharray=\"8 4\" stroke-width=\"1.5\"";
    const double width = textWidthPx(guide.label, svg_.textPx()), height = svg_.textPx();
    if (guide.axis == Guide::Axis::x) {
      svg_.line(px(guide.at), top_, px(guide.at), bottom_, "axis", kDashed);
      svg_.text(px(guide.at) + 4, top_ + height, "start", guide.label, {}, "halo");
      return;
    }
    const double y = py(guide.at);
    svg_.line(left_, y, right_, y, "axis", kDashed);
    // At the end, over or under the line, where the fewest points are.
    Box best{};
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (const double top : {y - height - 4, y + 3})
      for (const double x : {right_ - width, left_ + 4}) {
        const Box box{x, top, width, height};
        const std::size_t hit = coveredBy({x - 20, top - 6, width + 40, height + 12});
        if (top < top_ || top + height > bottom_ || hit >= fewest) continue;
        fewest = hit;
        best = box;
      }
    if (fewest == std::numeric_limits<std::size_t>::max()) return;
    svg_.text(best.x, best.y + height * 0.8, "start", guide.label, {}, "halo");
    taken_.push_back(best);
    thin_.push_back({left_, y - 2, right_ - left_, 4});
  }

  /// What a box would cover: points count more than whiskers.
  std::size_t coveredBy(const Box& box) const {
    std::size_t count = 0;
    for (const Series& s : plot_.series)
      for (std::size_t i = 0; i < s.x.size() && i < s.y.size(); ++i) {
        if (!std::isfinite(s.x[i]) || !std::isfinite(s.y[i])) continue;
        const double x = px(s.x[i]), y = py(s.y[i]);
        if (box.overlaps({x, y, 1, 1})) count += 3;
        const double left = extent(s.xLow, i), right = extent(s.xHigh, i);
        if (right > left && box.overlaps({px(left), y, px(right) - px(left), 1})) ++count;
        const double low = extent(s.yLow, i), high = extent(s.yHigh, i);
        if (high > low && box.overlaps({x, py(high), 1, py(low) - py(high)})) ++count;
      }
    return count;
  }

  void tickX() {
    double free = -1e9;
    for (const Tick& tick : x_.ticks()) {
      const double x = px(tick.value), half = textWidthPx(tick.text, svg_.textPx()) / 2;
      svg_.line(x, bottom_, x, bottom_ + 5, "axis");
      if (plot_.logX || !plot_.guides.empty()) svg_.line(x, top_, x, bottom_, "grid");
      if (x - half < free) continue;
      svg_.text(x, bottom_ + 7 + svg_.textPx() * 0.85, "middle", tick.text);
      free = x + half + 4;
    }
  }

  /// Two words stand on two lines: twelve categories have no room for both on one.
  void category(double x, const std::string& words) {
    const std::size_t space = words.find(' ');
    const double line = svg_.textPx() * 1.1;
    svg_.text(x, bottom_ + 2 + line, "middle", words.substr(0, space));
    if (space != std::string::npos) svg_.text(x, bottom_ + 2 + 2 * line, "middle", words.substr(space + 1));
  }

  void drawBars() {
    const double slot = 0.8 / static_cast<double>(plot_.series.size());
    for (std::size_t s = 0; s < plot_.series.size(); ++s)
      for (std::size_t i = 0; i < plot_.series[s].y.size() && i < plot_.categories.size(); ++i) {
        const double y = plot_.series[s].y[i];
        if (!std::isfinite(y)) continue;
        const double at = static_cast<double>(i) + 0.1 + slot * static_cast<double>(s);
        const double from = px(at), to = px(at + slot);
        svg_.bar(from, std::min(py(y), py(0)), to - from - 1, std::abs(py(0) - py(y)), look(s));
      }
  }

  void drawLine(std::size_t s) {
    const Series& series = plot_.series[s];
    if (series.draw == Series::Draw::points) return;
    std::string path;
    bool pen = false;
    for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i) {
      if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) {
        pen = false;
        continue;
      }
      const std::string x = decimal(px(series.x[i]), 1), y = decimal(py(series.y[i]), 1);
      if (pen && series.draw == Series::Draw::steps)
        path += 'H' + x + 'V' + y;
      else
        path += (pen ? "L" : "M") + x + ' ' + y;
      pen = true;
    }
    if (series.draw == Series::Draw::steps) {
      svg_.raw("<path class=\"quiet\" d=\"" + path +
               "\" fill=\"none\" stroke=\"#767676\" stroke-width=\"1.5\" stroke-dasharray=\"5 4\"/>\n");
      return;
    }
    const bool thin = series.draw == Series::Draw::joined;
    const std::string dash = dashOf(look(s));
    svg_.path(path, look(s), thin ? 1.2 : 2, dash.empty() ? "" : "stroke-dasharray=\"" + dash + '"');
  }

  void drawPoints(std::size_t s) {
    const Series& series = plot_.series[s];
    const bool line = series.draw == Series::Draw::line;
    if (series.draw == Series::Draw::steps || (line && series.x.size() > kMarkedPoints)) return;
    const double size = plot_.heightPx < 300 ? 4 : line ? 3.8 : 5;
    for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i) {
      if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
      const double x = px(series.x[i]), y = py(series.y[i]);
      whisker(s, extent(series.xLow, i), extent(series.xHigh, i), y, true);
      whisker(s, extent(series.yLow, i), extent(series.yHigh, i), x, false);
      svg_.marker(x, y, size, i < series.shapes.size() ? series.shapes[i] : look(s), look(s),
                  i < series.hints.size() ? series.hints[i] : std::string());
      taken_.push_back({x - size - 2, y - size - 2, 2 * size + 4, 2 * size + 4});
      if (i < series.labels.size() && !series.labels[i].empty())
        labels_.push_back({shortened(series.labels[i], (right_ - left_) * 0.42, labelPx()), x, y});
    }
  }

  void whisker(std::size_t s, double low, double high, double across, bool alongX) {
    if (!(high > low)) return;
    const double from = alongX ? px(low) : py(high), to = alongX ? px(high) : py(low);
    if (to - from < 1) return;
    const std::string a = decimal(from, 1), b = decimal(to, 1), c = decimal(across, 1),
                      end = decimal(across - 3, 1);
    // No end where the whisker runs out of the plot.
    const Axis& axis = alongX ? x_ : y_;
    const auto ends = [&](double value) { return axis.at(value) >= 0 && axis.at(value) <= 1; };
    const std::string stroke = alongX ? "v6" : "h6";
    std::string path = alongX ? 'M' + a + ' ' + c + 'H' + b : 'M' + c + ' ' + a + 'V' + b;
    if (ends(alongX ? low : high)) path += 'M' + (alongX ? a + ' ' + end : end + ' ' + a) + stroke;
    if (ends(alongX ? high : low)) path += 'M' + (alongX ? b + ' ' + end : end + ' ' + b) + stroke;
    svg_.path(path, look(s), 1.2, "opacity=\"0.55\"");
    thin_.push_back(alongX ? Box{from, across - 2, to - from, 4} : Box{across - 2, from, 4, to - from});
  }

  double labelPx() const { return svg_.textPx() - 1; }

  void drawLabels() {
    const std::string size = "font-size=\"" + decimal(labelPx(), 1) + '"';
    for (const PlacedLabel& label : placeLabels(
             labels_, taken_, thin_, {left_ + 2, top_, right_ - left_ - 2, bottom_ - top_ - 2}, labelPx())) {
      if (label.text.empty()) continue;
      const Box& box = label.box;
      if (label.leader)
        svg_.line(label.pointX, label.pointY, std::clamp(label.pointX, box.x, box.x + box.width),
                  std::clamp(label.pointY, box.y, box.y + box.height), "quiet");
      svg_.text(box.x + 1, box.y + box.height * 0.76, "start", label.text, size, "halo");
    }
  }

  bool bars_;
  Axis x_, y_;
  std::vector<Box> taken_, thin_;
  std::vector<Label> labels_;
};

}  // namespace

std::unique_ptr<Drawing> makePlainDrawing(const Plot& plot, double textPx) {
  return std::make_unique<PlainDrawing>(plot, textPx);
}

}  // namespace trimtab::plot
