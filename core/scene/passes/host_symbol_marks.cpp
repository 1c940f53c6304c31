#include "host_symbol_marks.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <span>
#include <string_view>
#include <tuple>

#include "clip_line.h"
#include "stroke_font.h"

namespace trimtab::scene {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;
constexpr double kThinnestPx = 1;
constexpr double kCapital = 0.7;  ///< share of a text's font size; the rest is descenders and padding

struct Point {
  double x, y;
};

/// Maps (u, v) to right * u + up * v + origin.
struct Affine {
  Point right{1, 0}, up{0, 1}, origin{0, 0};

  Point at(double u, double v) const {
    return {right.x * u + up.x * v + origin.x, right.y * u + up.y * v + origin.y};
  }
  /// This map after `first`.
  Affine after(const Affine& first) const {
    const Point r = at(first.right.x, first.right.y), u = at(first.up.x, first.up.y);
    return {{r.x - origin.x, r.y - origin.y},
            {u.x - origin.x, u.y - origin.y},
            at(first.origin.x, first.origin.y)};
  }
  /// Returns by how much it stretches lengths, in the mean of both axes.
  double stretch() const { return std::sqrt(std::abs(right.x * up.y - right.y * up.x)); }
};

Affine placeOf(const HostSymbol& s) {
  const double turn = static_cast<double>(s.rotationDeg) * kRadiansPerDegree, c = std::cos(turn),
               n = std::sin(turn);
  const double u = s.scaleU, v = s.scaleV;
  return {{c * u, n * u}, {-n * v, c * v}, {s.u, s.v}};
}

/// A symbol that is shown, with all that it has from its ancestors.
struct Shown {
  const HostSymbol* symbol = nullptr;
  const HostSurface* surface = nullptr;
  Affine onSurface;
  std::array<std::uint8_t, 4> rgba{};
};

enum class Verdict { shown, hidden, left_out };

/// Finds out whether a symbol is shown: it is not if an ancestor is hidden or dark, and it is left out if it
/// has no surface or too many ancestors.
Verdict resolve(const SymbologyRequest& request, const HostSymbol& symbol, Shown& shown) {
  const HostSymbols& all = *request.host;
  shown = {&symbol, nullptr, placeOf(symbol), symbol.rgba};
  bool inherits = true;  // as long as every generation so far does
  const HostSymbol* flashing = nullptr;
  const HostSymbol* s = &symbol;
  for (int ancestors = 0;; ++ancestors) {
    if (!s->visible) return Verdict::hidden;
    if (s->dutyPercent < 100) flashing = s;  // the oldest one counts for all its descendants
    if (!s->attached) break;
    inherits = inherits && s->inheritsColour;
    s = all.symbol(s->parent);
    if (!s || ancestors == HostSymbols::kMostAncestors) return Verdict::left_out;
    shown.onSurface = placeOf(*s).after(shown.onSurface);
    if (inherits) shown.rgba = s->rgba;
  }
  if (flashing && std::binary_search(request.dark.begin(), request.dark.end(), flashing->id))
    return Verdict::hidden;
  shown.surface = all.surface(s->surface);
  return shown.surface ? Verdict::shown : Verdict::left_out;
}

/// Makes marks of one symbol's shape.
class Marker {
 public:
  Marker(const Shown& shown, const SymbologyRequest& request, const ViewShape& view,
         SymbologyDrawing& drawing)
      : shape_(*shown.symbol->shape), rgba_(shown.rgba), drawing_(drawing) {
    const HostSurface& s = *shown.surface;
    const SymbolElement& e = request.setup.element[static_cast<std::size_t>(Symbol::host)];
    if (request.setup.general.recolourHost) {
      const auto rgb = symbolColour(e.colour);
      std::copy(rgb.begin(), rgb.end(), rgba_.begin());
    }
    const double w = view.widthPx, h = view.heightPx, size = e.size.value();
    // The preset scales about the image's middle and moves by fractions of half the image.
    const auto x = [&](double fraction) { return w * (0.5 + (fraction - 0.5) * size + 0.5 * e.x.value()); };
    const auto y = [&](double fraction) { return h * (0.5 + (fraction - 0.5) * size + 0.5 * e.y.value()); };
    const double perU = (x(s.right) - x(s.left)) / (static_cast<double>(s.maxU) - s.minU),
                 perV = (y(s.top) - y(s.bottom)) / (static_cast<double>(s.maxV) - s.minV);
    toPixels_ = Affine{{perU, 0}, {0, perV}, {x(s.left) - perU * s.minU, y(s.bottom) - perV * s.minV}}.after(
        shown.onSurface);
    // The preset's size leaves widths of lines as they are.
    const double wide = static_cast<double>(shape_.lineWidth) * toPixels_.stretch() / size;
    const double width = shape_.kind == HostShapeKind::text ? request.setup.general.lineWidth.value() : wide;
    halfWidth_ = 0.5 * std::clamp(width, kThinnestPx, w + h);
    const double margin = halfWidth_ + 1;
    clip_ = {std::max(x(s.left), -margin), std::max(y(s.bottom), -margin), std::min(x(s.right), w + margin),
             std::min(y(s.top), h + margin)};
  }

  void mark() {
    if (!(clip_.left < clip_.right) || !(clip_.bottom < clip_.top) || rgba_[3] == 0) return;
    if (shape_.kind == HostShapeKind::lines) lines();
    if (shape_.kind == HostShapeKind::circles)
      for (const HostArc& arc : shape_.arcs) circle(arc);
    if (shape_.kind == HostShapeKind::text) text();
  }

 private:
  void lines();
  void circle(const HostArc& arc);
  void text();
  void glyphAt(char character, double u, double v, double unit);
  void line(Point from, Point to);
  void triangle(Point a, Point b, Point c);
  Point at(const HostPoint& p) const { return toPixels_.at(p.u, p.v); }
  void add(const HostMark& mark);

  const HostShape& shape_;
  std::array<std::uint8_t, 4> rgba_;
  SymbologyDrawing& drawing_;
  Affine toPixels_;
  double halfWidth_ = 0;
  Rectangle clip_{};
};

void Marker::add(const HostMark& mark) {
  drawing_.marks.push_back(mark);
}

void Marker::line(Point from, Point to) {
  const double dx = to.x - from.x, dy = to.y - from.y;
  const auto part = partInside(clip_, from.x, from.y, dx, dy);
  if (!part) return;
  const auto [first, last] = *part;
  const auto x = [&](double t) { return static_cast<float>(from.x + t * dx); };
  const auto y = [&](double t) { return static_cast<float>(from.y + t * dy); };
  add({{x(first), x(last), x(last)}, {y(first), y(last), y(last)}, static_cast<float>(halfWidth_), rgba_});
}

/// Sutherland and Hodgman's clipping: each side of the surface adds at most one corner to the triangle.
void Marker::triangle(Point a, Point b, Point c) {
  std::array<Point, 8> polygon{a, b, c}, clipped;
  std::size_t corners = 3;
  const auto cut = [&](auto inside) {  // of a point: how far inside a side it is
    std::size_t kept = 0;
    for (std::size_t i = 0; i < corners; ++i) {
      const Point p = polygon[i], q = polygon[(i + 1) % corners];
      const double dp = inside(p), dq = inside(q);
      if (dp >= 0) clipped[kept++] = p;
      if ((dp >= 0) == (dq >= 0)) continue;
      const double t = dp / (dp - dq);
      clipped[kept++] = {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
    }
    corners = kept;
    polygon = clipped;
  };
  cut([this](Point p) { return p.x - clip_.left; });
  cut([this](Point p) { return clip_.right - p.x; });
  cut([this](Point p) { return p.y - clip_.bottom; });
  cut([this](Point p) { return clip_.top - p.y; });
  for (std::size_t i = 2; i < corners; ++i) {
    HostMark mark{{}, {}, HostMark::kFilled, rgba_};
    const Point points[] = {polygon[0], polygon[i - 1], polygon[i]};
    for (std::size_t k = 0; k < 3; ++k) {
      mark.x[k] = static_cast<float>(points[k].x);
      mark.y[k] = static_cast<float>(points[k].y);
    }
    add(mark);
  }
}

void Marker::lines() {
  const std::span<const HostPoint> p = shape_.points;
  const std::size_t n = p.size();
  switch (shape_.primitive) {
    case HostPrimitive::points:
      for (const HostPoint& point : p) line(at(point), at(point));
      break;
    case HostPrimitive::lines:
      for (std::size_t i = 1; i < n; i += 2) line(at(p[i - 1]), at(p[i]));
      break;
    case HostPrimitive::line_strip:
    case HostPrimitive::line_loop:
      for (std::size_t i = 1; i < n; ++i) line(at(p[i - 1]), at(p[i]));
      if (shape_.primitive == HostPrimitive::line_loop && n > 2) line(at(p[n - 1]), at(p[0]));
      break;
    case HostPrimitive::triangles:
      for (std::size_t i = 2; i < n; i += 3) triangle(at(p[i - 2]), at(p[i - 1]), at(p[i]));
      break;
    case HostPrimitive::triangle_strip:
      for (std::size_t i = 2; i < n; ++i) triangle(at(p[i - 2]), at(p[i - 1]), at(p[i]));
      break;
    case HostPrimitive::triangle_fan:
      for (std::size_t i = 2; i < n; ++i) triangle(at(p[0]), at(p[i - 1]), at(p[i]));
      break;
  }
}

void Marker::circle(const HostArc& arc) {
  const double start = static_cast<double>(arc.startDeg);
  double sweep = std::fmod(static_cast<double>(arc.endDeg) - start, 360.0);
  if (sweep <= 0) sweep += 360;
  // An arc gets so many sides that none is a quarter of a pixel off it; a circle far larger than an image
  // gets no more.
  const double radiusPx = static_cast<double>(arc.radius) * toPixels_.stretch();
  const int sides =
      static_cast<int>(std::ceil(std::clamp(4.5 * std::sqrt(radiusPx), 12.0, 240.0) * sweep / 360));
  const auto on = [&](double radius, int i) {
    const double turn = (start + sweep * i / sides) * kRadiansPerDegree;
    return toPixels_.at(arc.u + radius * std::cos(turn), arc.v + radius * std::sin(turn));
  };
  for (int i = 0; i < sides; ++i) {
    const Point a = on(arc.radius, i), b = on(arc.radius, i + 1);
    if (!shape_.filled) {
      line(a, b);
      continue;
    }
    const Point c = on(arc.innerRadius, i), d = on(arc.innerRadius, i + 1);
    triangle(a, b, c);
    if (arc.innerRadius > 0) triangle(b, d, c);
  }
}

void Marker::glyphAt(char character, double u, double v, double unit) {
  for (const GlyphLine& g : glyph(character))
    line(toPixels_.at(u + g.x0 * unit, v + g.y0 * unit), toPixels_.at(u + g.x1 * unit, v + g.y1 * unit));
}

/// Small letters are written as capitals; a character that the font misses leaves its place blank.
void Marker::text() {
  std::string characters;
  for (const char c : shape_.text)
    if ((static_cast<unsigned char>(c) & 0xc0U) != 0x80)  // one place for each character of UTF-8
      characters += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (characters.empty()) return;
  const double unit = kCapital * static_cast<double>(shape_.fontSize) / kGlyphHeight;
  const Point steps[] = {
      {kGlyphAdvance * unit, 0}, {0, -shape_.fontSize}, {-kGlyphAdvance * unit, 0}, {0, shape_.fontSize}};
  const Point step = steps[shape_.orientation & 3U];
  const auto last = static_cast<double>(characters.size() - 1);
  const double left = std::min(0.0, last * step.x), bottom = std::min(0.0, last * step.y);
  const double width = std::abs(last * step.x) + kGlyphWidth * unit,
               height = std::abs(last * step.y) + kGlyphHeight * unit;
  // The point of the text that lies at the symbol's own origin.
  const double u = left + width * 0.5 * (shape_.alignment % 3),
               v = bottom + height * (1 - 0.5 * (shape_.alignment / 3));
  for (std::size_t i = 0; i < characters.size(); ++i)
    glyphAt(characters[i], static_cast<double>(i) * step.x - u, static_cast<double>(i) * step.y - v, unit);
}

}  // namespace

void drawHostSymbols(const SymbologyRequest& request, const ViewShape& view, SymbologyDrawing& drawing) {
  const std::size_t index = static_cast<std::size_t>(Symbol::host);
  if (!request.host || !request.setup.element[index].show) return;
  std::vector<Shown> all;
  Shown shown;
  for (const HostSymbol& symbol : request.host->symbols) {
    const Verdict verdict = resolve(request, symbol, shown);
    if (verdict == Verdict::shown) all.push_back(shown);
    drawing.hostSymbolsLeftOut += verdict == Verdict::left_out;
  }
  const auto order = [](const Shown& s) { return std::tuple(s.surface->id, s.symbol->layer, s.symbol->id); };
  std::sort(all.begin(), all.end(), [&order](const Shown& a, const Shown& b) { return order(a) < order(b); });
  for (const Shown& s : all) {
    const std::size_t before = drawing.marks.size();
    Marker(s, request, view, drawing).mark();
    if (drawing.marks.size() <= SymbologyDrawing::kMostMarks) continue;
    drawing.marks.resize(before);
    ++drawing.hostSymbolsLeftOut;
  }
  SymbolBox& box = drawing.box[index];
  for (const HostMark& m : drawing.marks)
    for (std::size_t i = 0; i < 3; ++i) {
      if (box.empty()) box = {m.x[i], m.y[i], m.x[i], m.y[i]};
      box = {std::min(box.left, m.x[i]), std::min(box.bottom, m.y[i]), std::max(box.right, m.x[i]),
             std::max(box.top, m.y[i])};
    }
}

}  // namespace trimtab::scene
