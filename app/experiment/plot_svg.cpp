#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "trimtab/experiment/report.h"

namespace trimtab::experiment {
namespace {

constexpr double kWidth = 720, kHeight = 400, kLeft = 74, kRight = 20, kTop = 74, kBottom = 60;
/// Okabe and Ito's colours, told apart by the colour-blind too.
constexpr std::array<const char*, 6> kColours{"#0072b2", "#d55e00", "#009e73",
                                              "#cc79a7", "#e69f00", "#56b4e9"};

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

struct Axis {
  double low = 0, high = 1, step = 1;
};

/// Round steps, five or so, that reach from 0 or below to the largest value.
Axis axisFor(double low, double high, bool fromZero) {
  if (fromZero) low = std::min(low, 0.0);
  if (!(high > low)) high = low + 1;
  const double rough = (high - low) / 5, power = std::pow(10, std::floor(std::log10(rough)));
  const double scaled = rough / power;
  const double step = power * (scaled <= 1 ? 1 : scaled <= 2 ? 2 : scaled <= 5 ? 5 : 10);
  return {std::floor(low / step) * step, std::ceil(high / step - 1e-9) * step, step};
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot), bars_(!plot.categories.empty()) {
    double lowX = std::numeric_limits<double>::infinity(), highX = -lowX, lowY = lowX, highY = highX;
    for (const Series& s : plot.series) {
      for (const double v : s.x)
        if (std::isfinite(v)) lowX = std::min(lowX, v), highX = std::max(highX, v);
      for (const double v : s.y)
        if (std::isfinite(v)) lowY = std::min(lowY, v), highY = std::max(highY, v);
    }
    if (!(highY >= lowY)) lowY = 0, highY = 1;
    if (!(highX >= lowX)) lowX = 0, highX = 1;
    y_ = axisFor(lowY, highY, true);
    x_ = bars_ ? Axis{0, double(plot.categories.size()), 1} : axisFor(lowX, highX, false);
  }

  std::string svg() {
    out_ = formatted(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" font-family=\"sans-serif\" "
        "font-size=\"13\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
        kWidth, kHeight);
    text(kWidth / 2, 20, "middle", plot_.title, "font-weight=\"bold\"");
    text((kLeft + kWidth - kRight) / 2, kHeight - 8, "middle", plot_.xLabel);
    out_ += formatted("<text x=\"18\" y=\"%.1f\" text-anchor=\"middle\" transform=\"rotate(-90 18 %.1f)\">",
                      (kTop + kHeight - kBottom) / 2, (kTop + kHeight - kBottom) / 2) +
            escaped(plot_.yLabel) + "</text>\n";
    grid();
    if (bars_)
      drawBars();
    else
      drawLines();
    legend();
    return out_ + "</svg>\n";
  }

 private:
  double px(double x) const { return kLeft + (x - x_.low) / (x_.high - x_.low) * (kWidth - kLeft - kRight); }
  double py(double y) const {
    return kHeight - kBottom - (y - y_.low) / (y_.high - y_.low) * (kHeight - kTop - kBottom);
  }
  static const char* colour(std::size_t i) { return kColours[i % kColours.size()]; }

  void text(double x, double y, const char* anchor, const std::string& words, const char* more = "") {
    out_ += formatted("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" %s>", x, y, anchor, more) +
            escaped(words) + "</text>\n";
  }
  void line(double x1, double y1, double x2, double y2, const char* stroke) {
    out_ += formatted("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n", x1, y1, x2,
                      y2, stroke);
  }

  void grid() {
    for (double y = y_.low; y <= y_.high + y_.step / 2; y += y_.step) {
      line(kLeft, py(y), kWidth - kRight, py(y), "#dddddd");
      text(kLeft - 6, py(y) + 4, "end", formatted("%.6g", std::abs(y) < y_.step / 1e6 ? 0.0 : y));
    }
    if (bars_) {
      for (std::size_t i = 0; i < plot_.categories.size(); ++i)
        category(px(double(i) + 0.5), plot_.categories[i]);
    } else {
      for (double x = x_.low; x <= x_.high + x_.step / 2; x += x_.step) {
        line(px(x), kHeight - kBottom, px(x), kHeight - kBottom + 5, "#444444");
        text(px(x), kHeight - kBottom + 18, "middle",
             formatted("%.6g", std::abs(x) < x_.step / 1e6 ? 0.0 : x));
      }
    }
    line(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom, "#444444");
    line(kLeft, kTop, kLeft, kHeight - kBottom, "#444444");
  }

  /// Two words stand on two lines: twelve categories have no room for both on one.
  void category(double x, const std::string& words) {
    const std::size_t space = words.find(' ');
    text(x, kHeight - kBottom + 16, "middle", words.substr(0, space));
    if (space != std::string::npos) text(x, kHeight - kBottom + 30, "middle", words.substr(space + 1));
  }

  void drawBars() {
    const double slot = 0.8 / double(plot_.series.size());
    for (std::size_t s = 0; s < plot_.series.size(); ++s)
      for (std::size_t i = 0; i < plot_.series[s].y.size() && i < plot_.categories.size(); ++i) {
        const double y = plot_.series[s].y[i];
        if (!std::isfinite(y)) continue;
        const double from = px(double(i) + 0.1 + slot * double(s)),
                     to = px(double(i) + 0.1 + slot * double(s + 1));
        out_ += formatted("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n", from,
                          py(y), to - from - 1, py(0) - py(y), colour(s));
      }
  }

  void drawLines() {
    for (std::size_t s = 0; s < plot_.series.size(); ++s) {
      const Series& series = plot_.series[s];
      std::string path;
      bool pen = false;
      for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i) {
        if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) {
          pen = false;
          continue;
        }
        path += formatted("%c%.1f %.1f", pen ? 'L' : 'M', px(series.x[i]), py(series.y[i]));
        pen = true;
        if (series.x.size() <= 24)
          out_ += formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\" fill=\"%s\"/>\n", px(series.x[i]),
                            py(series.y[i]), colour(s));
      }
      out_ +=
          "<path d=\"" + path + formatted("\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"/>\n", colour(s));
    }
  }

  void legend() {
    double x = kLeft, y = 42;
    for (std::size_t s = 0; s < plot_.series.size(); ++s) {
      const double width = 26 + 7.2 * double(plot_.series[s].name.size());
      if (x + width > kWidth - kRight) x = kLeft, y += 18;
      out_ += formatted("<rect x=\"%.1f\" y=\"%.1f\" width=\"14\" height=\"10\" fill=\"%s\"/>\n", x, y - 9,
                        colour(s));
      text(x + 18, y, "start", plot_.series[s].name);
      x += width;
    }
  }

  const Plot& plot_;
  bool bars_;
  Axis x_, y_;
  std::string out_;
};

}  // namespace

std::string toSvg(const Plot& plot) {
  return Drawing(plot).svg();
}

}  // namespace trimtab::experiment
