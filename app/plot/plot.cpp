#include "plot.h"

#include <algorithm>

#include "drawing.h"

namespace trimtab::plot {
namespace {

constexpr double kTextPx = 13, kSmallTextPx = 11.5, kSmallWidthPx = 480;

std::vector<Key> keysOf(const Plot& plot) {
  if (!plot.keys.empty()) return plot.keys;
  std::vector<Key> keys;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const Series& series = plot.series[s];
    const int look = series.look == -1 ? static_cast<int>(s) : series.look;
    const bool lines = series.draw == Series::Draw::line;
    const bool bars = lines && !plot.categories.empty(), marked = !lines || series.x.size() <= kMarkedPoints;
    if (series.draw != Series::Draw::steps)
      keys.push_back({series.name, look, bars ? -1 : std::max(look, 0), !bars && !marked});
  }
  return keys;
}

std::string open(double width, double height, double textPx, const std::string& more) {
  return "<svg " + more + "viewBox=\"0 0 " + decimal(width, 0) + ' ' + decimal(height, 0) +
         "\" font-family=\"sans-serif\" font-size=\"" + decimal(textPx, 1) + "\">\n";
}

struct Drawn {
  std::string content;
  double height = 0, textPx = 0;
};
Drawn drawn(const Plot& plot) {
  const double textPx = plot.widthPx < kSmallWidthPx ? kSmallTextPx : kTextPx;
  const auto drawing =
      plot.kind == Plot::Kind::rows ? makeRowsDrawing(plot, textPx) : makePlainDrawing(plot, textPx);
  drawing->draw();
  return {drawing->take(), drawing->height(), textPx};
}

constexpr const char* kFile = "xmlns=\"http://www.w3.org/2000/svg\" ";
constexpr const char* kGround = "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";

}  // namespace

double drawLegend(Svg& svg, const std::vector<Key>& keys, double x, double right, double y) {
  const double from = x;
  for (const Key& key : keys) {
    Key shown = key;
    shown.name = shortened(key.name, right - from - 30, svg.textPx());
    const double width = svg.keyWidth(shown);
    if (x > from && x + width - 12 > right) x = from, y += svg.textPx() * 1.4;
    x += svg.key(x, y, shown);
  }
  return y;
}

double Drawing::drawHead() {
  double y = 8;
  if (!plot_.title.empty()) {
    y += svg_.textPx();
    svg_.text(plot_.widthPx / 2, y, "middle", shortened(plot_.title, plot_.widthPx * 0.92, svg_.textPx()),
              "font-weight=\"bold\"");
    y += 3;
  }
  if (plot_.legend && !plot_.series.empty()) {
    const double indent = std::min(left_, plot_.widthPx * 0.12);
    y = drawLegend(svg_, keysOf(plot_), indent, plot_.widthPx - 12, y + svg_.textPx() * 1.3) + 4;
  }
  return y + svg_.textPx() * (plot_.guides.empty() ? 0.9 : 1.4);
}

void Drawing::drawXLabel(double y) {
  svg_.text((left_ + right_) / 2, y, "middle", shortened(plot_.xLabel, plot_.widthPx * 0.92, svg_.textPx()));
}

void Drawing::layOut(const Axis& y) {
  double widest = 0;
  for (const Tick& tick : y.ticks()) widest = std::max(widest, textWidthPx(tick.text, svg_.textPx()));
  left_ = svg_.textPx() * (plot_.yLabel.empty() ? 0.5 : 2) + widest + 8;
  right_ = plot_.widthPx - 20;
  top_ = drawHead();
  const double categoryLines = plot_.categories.empty() ? 0 : svg_.textPx() * 1.1;
  bottom_ = height_ - svg_.textPx() * (plot_.xLabel.empty() ? 1.8 : 3.2) - categoryLines;
  if (!plot_.xLabel.empty()) drawXLabel(height_ - svg_.textPx() * 0.6);
  if (plot_.yLabel.empty()) return;
  const std::string middle = decimal((top_ + bottom_) / 2, 1), x = decimal(svg_.textPx() * 1.2, 1);
  svg_.raw("<text class=\"ink\" x=\"" + x + "\" y=\"" + middle +
           "\" text-anchor=\"middle\" transform=\"rotate(-90 " + x + ' ' + middle + ")\">" +
           escaped(shortened(plot_.yLabel, height_ * 0.9, svg_.textPx())) + "</text>\n");
}

std::string toSvg(const Plot& plot) {
  const Drawn d = drawn(plot);
  return open(plot.widthPx, d.height, d.textPx, kFile) + kGround + d.content + "</svg>\n";
}

std::string toInlineSvg(const Plot& plot) {
  const Drawn d = drawn(plot);
  const std::string name = plot.title.empty() ? plot.yLabel : plot.title;
  return open(plot.widthPx, d.height, d.textPx,
              "class=\"plot\" role=\"img\" aria-label=\"" + escaped(name) + "\" ") +
         d.content + "</svg>\n";
}

std::string toSvg(const std::string& title, const std::vector<Key>& keys, const std::vector<Plot>& plots,
                  std::size_t columns) {
  columns = std::max<std::size_t>(columns, 1);
  double width = kSmallWidthPx;
  for (const Plot& plot : plots) width = std::max(width, plot.widthPx * static_cast<double>(columns));
  Svg svg(kTextPx);
  svg.text(width / 2, 22, "middle", title, "font-weight=\"bold\"");
  double y = drawLegend(svg, keys, 20, width - 20, 44) + 10;
  for (std::size_t i = 0; i < plots.size(); i += columns) {
    double height = 0;
    for (std::size_t c = 0; c < columns && i + c < plots.size(); ++c) {
      const Drawn d = drawn(plots[i + c]);
      svg.raw("<g transform=\"translate(" + decimal(static_cast<double>(c) * plots[i + c].widthPx, 1) + ' ' +
              decimal(y, 1) + ")\" font-size=\"" + decimal(d.textPx, 1) + "\">\n" + d.content + "</g>\n");
      height = std::max(height, d.height);
    }
    y += height;
  }
  return open(width, y + 8, kTextPx, kFile) + kGround + svg.take() + "</svg>\n";
}

std::string inlineMark(const Key& key) {
  Svg svg(16);
  svg.key(0, 13.5, {"", key.colour, key.shape, key.line});
  return "<svg class=\"key\" width=\"16\" height=\"16\" viewBox=\"0 0 16 16\" aria-hidden=\"true\">" +
         svg.take() + "</svg>";
}

}  // namespace trimtab::plot
