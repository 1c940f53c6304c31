#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "plot.h"

/// The pieces that SVG pictures and pages are written with.
namespace trimtab::plot {

/// Fixed decimals in the C locale, without trailing zeros.
std::string decimal(double value, int decimals);
/// A number on an axis: 0.05, 12, 20k, 1.2M, 1e-5.
std::string tickText(double value);

/// Text for XML content and quoted attributes. What is no character of XML, or no UTF-8, becomes U+FFFD.
std::string escaped(std::string_view text);

/// About how wide a sans-serif draws it: what lays out cannot ask the font.
double textWidthPx(std::string_view utf8, double sizePx);
/// The text, or its beginning and end around an ellipsis, so that it fits.
std::string shortened(std::string_view utf8, double widthPx, double sizePx);

constexpr int kShapes = 7;

class Svg {
 public:
  explicit Svg(double textPx) : textPx_(textPx) {}

  double textPx() const { return textPx_; }
  void text(double x, double y, const char* anchor, std::string_view words, std::string_view more = {},
            const char* cls = "ink");
  /// `cls`: ink, quiet or grid.
  void line(double x1, double y1, double x2, double y2, const char* cls, std::string_view more = {});
  void path(std::string_view d, int look, double width, std::string_view more = {});
  void bar(double x, double y, double width, double height, int look, std::string_view hint = {});
  /// `colour` below 0: of text.
  void marker(double x, double y, double size, int shape, int colour, std::string_view hint = {});
  void raw(std::string_view text) { out_ += text; }
  /// An entry of a legend; returns its width.
  double key(double x, double y, const Key& key);
  double keyWidth(const Key& key) const;

  std::string take() { return std::move(out_); }

 private:
  double textPx_;
  std::string out_;
};

/// `stroke-dasharray` of a look, empty for the first.
std::string dashOf(int look);

}  // namespace trimtab::plot
