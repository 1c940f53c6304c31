#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "quad.h"
#include "table.h"
#include "trimtab/scene/symbology_geometry.h"

namespace trimtab::stress {
namespace {

using scene::SymbologyDrawing;

/// Pitch at and beside the vertical, roll at half turns, headings at the wrap; or anything.
Attitude extreme(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto pick = [&](std::initializer_list<double> corners, double range) {
    if (unit(random) > 0) return range * unit(random);
    const double corner = corners.begin()[static_cast<std::size_t>(std::abs(unit(random)) * 0.999 *
                                                                   static_cast<double>(corners.size()))];
    return unit(random) > 0 ? corner : corner + std::pow(10, -3 - 12 * std::abs(unit(random))) * unit(random);
  };
  const double pitch = std::clamp(pick({-90, 0, 90}, 90), -90.0, 90.0);
  return {wrapped360(Degrees{pick({0, 90, 180, 270, 360}, 360)}), Degrees{pitch},
          Degrees{pick({-180, -90, 0, 90, 180}, 180)}};
}

struct Pixel {
  Quad x, y;
};
/// Pixels of a direction of the world (east, north, up).
Pixel projected(const Attitude& a, const ViewShape& v, Quad3 d) {
  const Quad sh = sinDegrees(a.heading.value()), ch = cosDegrees(a.heading.value());
  const Quad sp = sinDegrees(a.pitch.value()), cp = cosDegrees(a.pitch.value());
  const Quad sr = sinDegrees(a.roll.value()), cr = cosDegrees(a.roll.value());
  const Quad3 ahead{sh * cp, ch * cp, sp}, level{ch, -sh, 0}, levelUp = cross(level, ahead);
  const Quad3 right = level * cr - levelUp * sr, up = levelUp * cr + level * sr;
  const Quad depth = dot(ahead, d);
  return {(dot(right, d) / depth - v.left) / (Quad{v.right} - v.left) * v.widthPx,
          (dot(up, d) / depth - v.bottom) / (Quad{v.top} - v.bottom) * v.heightPx};
}

SymbologyRequest only(Symbol symbol) {
  SymbologyRequest r;
  r.setup = symbologySetup(TuningParameters{});
  r.setup.general.enabled = true;
  for (auto& e : r.setup.element) e.show = false;
  r.setup.element[static_cast<std::size_t>(symbol)].show = true;
  return r;
}

TEST(SymbologyStress, whatBelongsToTheWorldLiesWhereItSays) {
  std::mt19937_64 random(71);
  std::uniform_real_distribution<double> unit(-1, 1);
  const double rounding = 4000 * kFloatU + 1e-9;
  Case marker("symbology", "flight path marker at any attitude", rounding, "px",
              "middles of strokes' floats below 4,000 px, each rounded once; doubles before");
  Case horizon("symbology", "ends of the horizon off the exact horizon", rounding + 4000 * kFloatU, "px",
               "two floats below 4,000 px; the line is exact from end to end");
  Case nose("symbology", "aircraft reference at any attitude of aircraft and view", rounding, "px",
            "one stroke's end, a float below 4,000 px");
  ViewShape v;
  v.widthPx = 1920, v.heightPx = 1080;
  SymbologyDrawing drawing;
  for (std::size_t i = 0; i < samples(25000); ++i) {
    SymbologyRequest r = only(Symbol::flight_path);
    r.state.view = extreme(random);
    // Somewhere in the picture.
    const Mat3 axes = eyeAxes(LocalFrame(), GeodeticPosition{}, r.state.view);
    const Vec3 d =
        transposed(axes) * Vec3{0.5 * unit(random), 0.25 * unit(random), -1} * (50 + 49 * unit(random));
    r.state.velocity = Velocity{MetresPerSecond{d.y}, MetresPerSecond{d.x}, MetresPerSecond{-d.z}};
    drawSymbology(r, v, drawing);
    const auto where = [&] {
      return digits(r.state.view.heading.value()) + ' ' + digits(r.state.view.pitch.value()) + ' ' +
             digits(r.state.view.roll.value());
    };
    const Pixel exact = projected(r.state.view, v, quad(d));
    const auto inside = [](Pixel p) { return p.x > 200 && p.x < 1720 && p.y > 200 && p.y < 880; };
    if (inside(exact)) {
      // The two wings are level with the marker's middle in its own sheet, and as long: their mean is not the
      // middle in perspective, but the line through all four ends passes it.
      ASSERT_GE(drawing.strokes.size(), 27u);
      const auto& left = drawing.strokes[drawing.strokes.size() - 3];
      const auto& right = drawing.strokes[drawing.strokes.size() - 2];
      const Quad dx = Quad{right.x1} - left.x0, dy = Quad{right.y1} - left.y0;
      const Quad off = fabsq(dx * (exact.y - left.y0) - dy * (exact.x - left.x0)) / sqrtq(dx * dx + dy * dy);
      marker.see(toDouble(off), where);
    }

    r = only(Symbol::aircraft_reference);
    r.state.view = extreme(random);
    r.state.aircraft = i % 2 == 0 ? extreme(random) : r.state.view;
    drawSymbology(r, v, drawing);
    const Attitude& a = r.state.aircraft;
    const Quad3 ahead{sinDegrees(a.heading.value()) * cosDegrees(a.pitch.value()),
                      cosDegrees(a.heading.value()) * cosDegrees(a.pitch.value()),
                      sinDegrees(a.pitch.value())};
    const Attitude& w = r.state.view;
    const Quad3 look{sinDegrees(w.heading.value()) * cosDegrees(w.pitch.value()),
                     cosDegrees(w.heading.value()) * cosDegrees(w.pitch.value()),
                     sinDegrees(w.pitch.value())};
    const Pixel at = projected(w, v, ahead);
    if (dot(ahead, look) > Quad{0.5} && inside(at)) {
      ASSERT_FALSE(drawing.strokes.empty());
      const auto& s = drawing.strokes.front();
      nose.see(toDouble(sqrtq((at.x - s.x0) * (at.x - s.x0) + (at.y - s.y0) * (at.y - s.y0))), where);
    }

    r = only(Symbol::pitch_ladder);
    r.state.view = extreme(random);
    r.state.view.pitch = Degrees{std::clamp(r.state.view.pitch.value() / 6, -14.0, 14.0)};
    drawSymbology(r, v, drawing);
    // The exact horizon: two directions of it make a line in the picture.
    const double h = r.state.view.heading.value();
    const auto on = [&](double turn) {
      return projected(r.state.view, v, {sinDegrees(h + turn), cosDegrees(h + turn), 0});
    };
    const Pixel p = on(-20), q = on(20);
    const Quad dx = q.x - p.x, dy = q.y - p.y, size = sqrtq(dx * dx + dy * dy);
    const auto off = [&](float x, float y) {
      return toDouble(fabsq(dx * (y - p.y) - dy * (x - p.x)) / size);
    };
    std::size_t onHorizon = 0;
    for (const auto& s : drawing.strokes) {
      const double length = std::hypot(s.x1 - s.x0, s.y1 - s.y0);
      if (length < 100 || off(s.x0, s.y0) > 1 || off(s.x1, s.y1) > 1) continue;
      ++onHorizon;
      horizon.see(std::max(off(s.x0, s.y0), off(s.x1, s.y1)));
    }
    if (std::abs(r.state.view.pitch.value()) < 8)
      horizon.see(onHorizon >= 2 ? 0 : HUGE_VAL,
                  [&] { return "no horizon at pitch " + digits(r.state.view.pitch.value()); });
  }
}

TEST(SymbologyStress, nothingLeavesThePicture) {
  std::mt19937_64 random(72);
  std::uniform_real_distribution<double> unit(-1, 1);
  Case inside("symbology", "strokes outside the picture or no number, all symbols", 0, "violations",
              "clipped to the picture and a line's width; what is not finite is not shown");
  Case silent("symbology", "strokes of an attitude that is no number", 0, "strokes", "not shown");
  SymbologyDrawing drawing;
  const double odd[] = {0, 5e-324, 1e-3, 1e9, -1e9, 1e308, HUGE_VAL, -HUGE_VAL, std::nan("")};
  const auto any = [&] { return odd[static_cast<std::size_t>(std::abs(unit(random)) * 8.99)]; };
  for (std::size_t i = 0; i < samples(3000); ++i) {
    SymbologyRequest r;
    r.setup = symbologySetup(TuningParameters{});
    r.setup.general.enabled = true;
    r.setup.general.frame = i % 2 == 0 ? SymbologyFrame::head : SymbologyFrame::aircraft;
    for (auto& e : r.setup.element) e.show = true;
    r.state.aircraft = extreme(random), r.state.view = extreme(random);
    r.state.altitude = Metres{any()};
    r.state.speed = Knots{any()};
    r.state.velocity =
        Velocity{MetresPerSecond{any()}, MetresPerSecond{unit(random) * 100}, MetresPerSecond{any()}};
    ViewShape v;
    v.widthPx = 1 + static_cast<int>(2000 * std::abs(unit(random))),
    v.heightPx = 1 + static_cast<int>(1200 * std::abs(unit(random)));
    drawSymbology(r, v, drawing);
    const double margin = r.setup.general.lineWidth.value() + r.setup.general.outline.value() + 1.001;
    for (const auto& s : drawing.strokes)
      for (const auto& [x, y] : {std::pair{s.x0, s.y0}, std::pair{s.x1, s.y1}})
        inside.require(x >= -margin && x <= v.widthPx + margin && y >= -margin && y <= v.heightPx + margin);
    drawSymbology(scene::quantised(r, v), v, drawing);
    for (const auto& s : drawing.strokes) inside.require(std::isfinite(s.x0 + s.y0 + s.x1 + s.y1));
    for (const double bad : {std::nan(""), HUGE_VAL}) {
      SymbologyRequest lost = r;
      (i % 3 == 0   ? lost.state.view.pitch
       : i % 3 == 1 ? lost.state.aircraft.roll
                    : lost.state.view.heading) = Degrees{bad};
      drawSymbology(lost, v, drawing);
      silent.see(static_cast<double>(drawing.strokes.size()));
    }
  }
}

}  // namespace
}  // namespace trimtab::stress
