#include "symbology_canvas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "clip_line.h"
#include "stroke_font.h"

namespace trimtab::scene {
namespace {

constexpr double kBeforeEye = 1e-4;  ///< depth at which lines are cut off, where the direction has length 1

}  // namespace

Canvas::Canvas(const ViewShape& view, double marginPx, SymbologyDrawing& drawing)
    : view_(view), margin_(marginPx), drawing_(drawing) {}

void Canvas::begin(Symbol symbol, double moveX, double moveY) {
  symbol_ = symbol;
  moveX_ = 0.5 * moveX * view_.widthPx;
  moveY_ = 0.5 * moveY * view_.heightPx;
}

bool Canvas::project(Vec3 d, double& x, double& y) const {
  if (!(-d.z > 0)) return false;
  x = (d.x / -d.z - view_.left) / (view_.right - view_.left) * view_.widthPx + moveX_;
  y = (d.y / -d.z - view_.bottom) / (view_.top - view_.bottom) * view_.heightPx + moveY_;
  return true;
}

bool Canvas::isCentral(Vec3 direction, double reach) const {
  double x = 0, y = 0;
  if (!project(direction, x, y)) return false;
  return std::hypot(x - moveX_ - 0.5 * view_.widthPx, y - moveY_ - 0.5 * view_.heightPx) <=
         0.5 * reach * view_.heightPx;
}

void Canvas::line(const Sheet& sheet, double a0, double b0, double a1, double b1) {
  Vec3 from = sheet.at(a0, b0), to = sheet.at(a1, b1);
  if (-from.z < kBeforeEye && -to.z < kBeforeEye) return;
  if (-from.z < kBeforeEye) from = from + (to - from) * ((-kBeforeEye - from.z) / (to.z - from.z));
  if (-to.z < kBeforeEye) to = to + (from - to) * ((-kBeforeEye - to.z) / (from.z - to.z));
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  if (project(from, x0, y0) && project(to, x1, y1)) add(x0, y0, x1, y1);
}

void Canvas::add(double x0, double y0, double x1, double y1) {
  const double dx = x1 - x0, dy = y1 - y0;
  const auto part =
      partInside({-margin_, -margin_, view_.widthPx + margin_, view_.heightPx + margin_}, x0, y0, dx, dy);
  if (!part) return;
  const auto [first, last] = *part;
  const SymbolStroke s{static_cast<float>(x0 + first * dx), static_cast<float>(y0 + first * dy),
                       static_cast<float>(x0 + last * dx), static_cast<float>(y0 + last * dy), symbol_};
  drawing_.strokes.push_back(s);
  SymbolBox& box = drawing_.box[static_cast<std::size_t>(symbol_)];
  if (box.empty()) box = {s.x0, s.y0, s.x0, s.y0};
  box.left = std::min({box.left, s.x0, s.x1});
  box.right = std::max({box.right, s.x0, s.x1});
  box.bottom = std::min({box.bottom, s.y0, s.y1});
  box.top = std::max({box.top, s.y0, s.y1});
}

void Canvas::circle(const Sheet& sheet, double a, double b, double radius) {
  constexpr int kSides = 24;
  double fromA = a + radius, fromB = b;
  for (int i = 1; i <= kSides; ++i) {
    const double turn = 2 * std::numbers::pi * i / kSides;
    const double toA = a + radius * std::cos(turn), toB = b + radius * std::sin(turn);
    line(sheet, fromA, fromB, toA, toB);
    fromA = toA;
    fromB = toB;
  }
}

void Canvas::rectangle(const Sheet& sheet, const Extent& e) {
  line(sheet, e.left, e.bottom, e.right, e.bottom);
  line(sheet, e.right, e.bottom, e.right, e.top);
  line(sheet, e.right, e.top, e.left, e.top);
  line(sheet, e.left, e.top, e.left, e.bottom);
}

double Canvas::widthOf(std::string_view text, double height) {
  if (text.empty()) return 0;
  return (static_cast<double>(text.size() - 1) * kGlyphAdvance + kGlyphWidth) * height / kGlyphHeight;
}

void Canvas::text(const Sheet& sheet, double a, double b, double height, std::string_view text) {
  const double unit = height / kGlyphHeight;
  double left = a - 0.5 * widthOf(text, height);
  const double foot = b - 0.5 * height;
  for (const char c : text) {
    for (const GlyphLine& g : glyph(c))
      line(sheet, left + g.x0 * unit, foot + g.y0 * unit, left + g.x1 * unit, foot + g.y1 * unit);
    left += kGlyphAdvance * unit;
  }
}

Sheet Canvas::picture(double x, double y) const {
  const double wide = view_.right - view_.left, high = view_.top - view_.bottom;
  // Units are square in pixels, also where the field of view is not.
  const double perUnit = 0.5 * view_.heightPx;
  return {{view_.left + 0.5 * (1 + x) * wide, view_.bottom + 0.5 * (1 + y) * high, -1},
          {perUnit * wide / view_.widthPx, 0, 0},
          {0, perUnit * high / view_.heightPx, 0}};
}

}  // namespace trimtab::scene
