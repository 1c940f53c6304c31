#include "trimtab/scene/symbology_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/scene/passes/stroke_font.h"
#include "core/scene/passes/symbology_canvas.h"
#include "trimtab/preset/table.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::scene {
namespace {

constexpr double kPi = std::numbers::pi;

ViewShape viewOf(int width, int height, double horizontalDeg, double verticalDeg) {
  ViewShape v;
  v.widthPx = width;
  v.heightPx = height;
  v.right = std::tan(horizontalDeg / 2 * kPi / 180);
  v.top = std::tan(verticalDeg / 2 * kPi / 180);
  v.left = -v.right;
  v.bottom = -v.top;
  return v;
}
const ViewShape kView = viewOf(1280, 720, 60, 36);

SymbologyRequest requestOf(const Attitude& aircraft, const Attitude& view) {
  TuningParameters p;
  p.symbology.enabled = true;
  SymbologyRequest r{{aircraft, view, Feet{12340}.as<Metres>(), Knots{250}, false, std::nullopt},
                     symbologySetup(p)};
  return r;
}
SymbologyRequest requestOf(const Attitude& attitude) {
  return requestOf(attitude, attitude);
}

SymbologyRequest only(SymbologyRequest r, Symbol symbol) {
  for (std::size_t i = 0; i < kSymbols; ++i) r.setup.element[i].show = i == static_cast<std::size_t>(symbol);
  return r;
}

SymbologyDrawing linesOf(const SymbologyRequest& r, const ViewShape& view = kView) {
  SymbologyDrawing d;
  drawSymbology(r, view, d);
  return d;
}

/// Where a direction north, east, down is in the picture: by rotations about one axis at a time, and no
/// matrix of the code under test.
struct Pixel {
  double x, y;
  bool inFront;
};
Pixel project(const Attitude& a, const ViewShape& v, double north, double east, double down) {
  const double h = a.heading.in<Radians>(), p = a.pitch.in<Radians>(), r = a.roll.in<Radians>();
  double x = north * std::cos(h) + east * std::sin(h), y = -north * std::sin(h) + east * std::cos(h),
         z = down;
  const double x2 = x * std::cos(p) - z * std::sin(p), z2 = x * std::sin(p) + z * std::cos(p);
  const double y3 = y * std::cos(r) + z2 * std::sin(r), z3 = -y * std::sin(r) + z2 * std::cos(r);
  const double px = (y3 / x2 - v.left) / (v.right - v.left) * v.widthPx;
  const double py = (-z3 / x2 - v.bottom) / (v.top - v.bottom) * v.heightPx;
  return {px, py, x2 > 0};
}

Attitude attitude(double heading, double pitch, double roll) {
  return {Degrees{heading}, Degrees{pitch}, Degrees{roll}};
}

double longest(const SymbologyDrawing& d) {
  double most = 0;
  for (const SymbolStroke& s : d.strokes)
    most = std::max(most, std::hypot(double{s.x1} - s.x0, double{s.y1} - s.y0));
  return most;
}

TEST(Symbology, putsTheHorizonBarOnTheHorizon) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> turn(0, 360), nod(-14, 14), bank(-180, 180);
  for (int i = 0; i < 300; ++i) {
    const Attitude a = attitude(turn(random), nod(random), bank(random));
    const auto d = linesOf(quantised(only(requestOf(a), Symbol::pitch_ladder), kView));
    // The two longest lines are the horizon's; every point of them has elevation 0.
    std::vector<SymbolStroke> strokes = d.strokes;
    ASSERT_GE(strokes.size(), 2u);
    std::sort(strokes.begin(), strokes.end(), [](const auto& s, const auto& t) {
      return std::hypot(s.x1 - s.x0, s.y1 - s.y0) > std::hypot(t.x1 - t.x0, t.y1 - t.y0);
    });
    const double h = a.heading.in<Radians>();
    const Pixel ahead = project(a, kView, std::cos(h), std::sin(h), 0);
    const Pixel aside = project(a, kView, std::cos(h + 0.3), std::sin(h + 0.3), 0);
    const double dx = aside.x - ahead.x, dy = aside.y - ahead.y, length = std::hypot(dx, dy);
    for (const auto& [x, y] :
         {std::pair{strokes[0].x0, strokes[0].y0}, std::pair{strokes[0].x1, strokes[0].y1}})
      EXPECT_LT(std::abs((x - ahead.x) * dy - (y - ahead.y) * dx) / length, 0.5)
          << a.heading.value() << ' ' << a.pitch.value() << ' ' << a.roll.value();
  }
}

TEST(Symbology, putsLadderBarsAtTheirElevation) {
  for (const double roll : {0.0, 35.0, -120.0, 180.0})
    for (const double pitch : {-60.0, -20.0, 3.0, 47.0}) {
      const Attitude a = attitude(359.7, pitch, roll);
      const auto d = linesOf(only(requestOf(a), Symbol::pitch_ladder));
      const double h = a.heading.in<Radians>();
      int bars = 0;
      for (int elevation = -80; elevation <= 80; elevation += 5) {
        const double e = elevation * kPi / 180;
        const Pixel at =
            project(a, kView, std::cos(h) * std::cos(e), std::sin(h) * std::cos(e), -std::sin(e));
        if (!at.inFront || std::hypot(at.x - 640, at.y - 360) > 220) continue;
        ++bars;
        // The bar's gap is in the middle: the line through two opposite strokes passes the place.
        double nearest = 1e9;
        for (const SymbolStroke& s : d.strokes) {
          const double dx = double{s.x1} - s.x0, dy = double{s.y1} - s.y0, length = std::hypot(dx, dy);
          if (length < 3) continue;
          const double off = std::abs((at.x - s.x0) * dy - (at.y - s.y0) * dx) / length;
          const double along = std::hypot(at.x - s.x0, at.y - s.y0);
          if (along < 200) nearest = std::min(nearest, off);
        }
        EXPECT_LT(nearest, 0.1) << elevation << " seen from " << pitch << ", " << roll;
      }
      EXPECT_GE(bars, 4);
    }
}

TEST(Symbology, putsTheFlightPathMarkerWhereTheAircraftFliesTo) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> turn(0, 360), nod(-80, 80), bank(-180, 180), small(-0.25, 0.25);
  int seen = 0;
  for (int i = 0; i < 400; ++i) {
    const Attitude a = attitude(turn(random), nod(random), bank(random));
    const double track = a.heading.in<Radians>() + small(random),
                 climb = a.pitch.in<Radians>() + small(random);
    const double n = std::cos(climb) * std::cos(track), e = std::cos(climb) * std::sin(track),
                 down = -std::sin(climb);
    auto r = only(requestOf(a), Symbol::flight_path);
    r.state.velocity =
        Velocity{MetresPerSecond{120 * n}, MetresPerSecond{120 * e}, MetresPerSecond{120 * down}};
    const auto d = linesOf(quantised(r, kView));
    const Pixel at = project(a, kView, n, e, down);
    if (!at.inFront || at.x < 60 || at.x > 1220 || at.y < 60 || at.y > 660) continue;
    ++seen;
    // The wings are the two long strokes; the ring's middle is half way between their outer ends.
    ASSERT_EQ(d.strokes.size(), 27u);
    const SymbolStroke &left = d.strokes[24], &right = d.strokes[25];
    EXPECT_NEAR(0.5 * (left.x0 + right.x1), at.x, 0.5);
    EXPECT_NEAR(0.5 * (left.y0 + right.y1), at.y, 0.5);
  }
  EXPECT_GT(seen, 150);
}

TEST(Symbology, marksTheNoseAndTheLineOfSightWhenTheHeadIsTurned) {
  const Attitude aircraft = attitude(350, 4, 10), view = attitude(5, -3, 6);
  const auto nose = linesOf(only(requestOf(aircraft, view), Symbol::aircraft_reference));
  const double h = aircraft.heading.in<Radians>(), p = aircraft.pitch.in<Radians>();
  const Pixel at = project(view, kView, std::cos(p) * std::cos(h), std::cos(p) * std::sin(h), -std::sin(p));
  ASSERT_EQ(nose.strokes.size(), 6u);
  EXPECT_NEAR(nose.strokes[0].x0, at.x, 0.1);
  EXPECT_NEAR(nose.strokes[0].y0, at.y, 0.1);

  ViewShape aside = kView;  // the picture's middle is not where the eye looks
  aside.left *= 0.5;
  aside.top *= 1.5;
  const auto cue = linesOf(only(requestOf(aircraft, view), Symbol::line_of_sight), aside);
  ASSERT_GE(cue.strokes.size(), 4u);
  const double x = 1280 * -aside.left / (aside.right - aside.left),
               y = 720 * -aside.bottom / (aside.top - aside.bottom);
  EXPECT_NEAR(0.5 * (cue.strokes[0].x1 + cue.strokes[2].x1), x, 0.1);
  EXPECT_NEAR(0.5 * (cue.strokes[1].y1 + cue.strokes[3].y1), y, 0.1);
  // Ahead, no way back is needed.
  EXPECT_EQ(linesOf(only(requestOf(view), Symbol::line_of_sight)).strokes.size(), 4u);
}

TEST(Symbology, pointsBackToTheNoseWhereverTheHeadLooks) {
  for (const double heading : {-170.0, -90.0, 40.0, 120.0})
    for (const double pitch : {-60.0, 20.0}) {
      const auto d =
          linesOf(only(requestOf(attitude(0, 0, 0), attitude(heading, pitch, 0)), Symbol::line_of_sight));
      const SymbolStroke& pointer = d.strokes[d.strokes.size() - 3];
      const double h = heading * kPi / 180, p = pitch * kPi / 180;
      // The nose (north) in the view's right and up.
      const double right = -std::sin(h), up = -std::sin(p) * std::cos(h);
      const double c = (pointer.x1 - pointer.x0) * right + (pointer.y1 - pointer.y0) * up;
      EXPECT_NEAR(c / std::hypot(right, up) / std::hypot(pointer.x1 - pointer.x0, pointer.y1 - pointer.y0), 1,
                  1e-3);
    }
}

TEST(Symbology, keepsReadoutsInThePictureWhenFixedToTheHeadAndInTheCockpitOtherwise) {
  auto r = only(requestOf(attitude(0, 0, 0), attitude(10, 0, 0)), Symbol::altitude);
  const auto middle = [](const SymbolBox& b) {
    return std::pair{0.5 * (b.left + b.right), 0.5 * (b.bottom + b.top)};
  };
  const std::size_t i = static_cast<std::size_t>(Symbol::altitude);
  const auto straight = linesOf(only(requestOf(attitude(0, 0, 0)), Symbol::altitude)).box[i];
  const auto head = linesOf(r).box[i];
  EXPECT_EQ(middle(head), middle(straight));
  r.setup.general.frame = SymbologyFrame::aircraft;
  const auto aircraft = linesOf(r).box[i];
  // The box's middle by hand: a direction of the cockpit, seen from a head turned right by ten degrees.
  const double azimuth = std::atan(0.6 * kView.right) - 10 * kPi / 180;
  EXPECT_NEAR(middle(aircraft).first, 640 + 640 * std::tan(azimuth) / kView.right, 4);
  r.state.view = attitude(120, 0, 0);
  EXPECT_TRUE(linesOf(r).strokes.empty()) << "the cockpit is behind";
}

/// The number that a symbol's strokes write cannot be read back here; but equal numbers draw equal strokes.
bool same(const SymbologyDrawing& a, const SymbologyDrawing& b) {
  return std::equal(a.strokes.begin(), a.strokes.end(), b.strokes.begin(), b.strokes.end(),
                    [](const SymbolStroke& s, const SymbolStroke& t) {
                      return s.x0 == t.x0 && s.y0 == t.y0 && s.x1 == t.x1 && s.y1 == t.y1 &&
                             s.symbol == t.symbol;
                    });
}

TEST(Symbology, changesOnlyWhenSomethingThatIsSeenHasChanged) {
  auto r = requestOf(attitude(123, 4, 5));
  r.state.velocity = Velocity{MetresPerSecond{100}, MetresPerSecond{3}, MetresPerSecond{1}};
  const auto base = quantised(r, kView);
  EXPECT_EQ(quantised(base, kView), base) << "rounded once, it stays";
  auto less = r;
  less.state.altitude = less.state.altitude + Metres{0.5};
  less.state.speed = Knots{250.3};
  less.state.aircraft.heading = less.state.aircraft.heading + Degrees{1e-5};
  less.state.view.heading = less.state.aircraft.heading;
  less.state.velocity->north = MetresPerSecond{100.001};
  EXPECT_EQ(quantised(less, kView), base);
  auto more = r;
  more.state.altitude = more.state.altitude + Feet{10}.as<Metres>();
  EXPECT_NE(quantised(more, kView), base);
  more.setup.element[static_cast<std::size_t>(Symbol::altitude)].show = false;
  less.setup = more.setup;
  EXPECT_EQ(quantised(more, kView), quantised(less, kView)) << "nobody sees the altitude";
  more = r;
  more.state.view.pitch = more.state.view.pitch + Degrees{0.05};  // a pixel
  EXPECT_NE(quantised(more, kView), base);
}

TEST(Symbology, hasNoFlightPathAtRest) {
  auto r = only(requestOf(attitude(0, 0, 0)), Symbol::flight_path);
  for (const double speed : {0.0, 0.5, kNan, std::numeric_limits<double>::infinity()}) {
    r.state.velocity = Velocity{MetresPerSecond{speed}, {}, {}};
    EXPECT_TRUE(linesOf(r).strokes.empty()) << speed;
    EXPECT_TRUE(linesOf(quantised(r, kView)).strokes.empty()) << speed;
  }
  r.state.velocity = Velocity{MetresPerSecond{1.5}, {}, {}};
  EXPECT_FALSE(linesOf(r).strokes.empty());
  r.state.velocity = Velocity{MetresPerSecond{-50}, {}, {}};
  EXPECT_TRUE(linesOf(r).strokes.empty()) << "backwards: behind the eye";
}

TEST(Symbology, staysInThePictureAndFiniteAtEveryAttitude) {
  for (const double heading : {0.0, 359.999999, -720.5, 180.0})
    for (const double pitch : {-90.0, -89.999, 0.0, 89.999, 90.0})
      for (const double roll : {-180.0, 0.0, 90.0, 180.0, 3600.0})
        for (const SymbologyFrame frame : {SymbologyFrame::head, SymbologyFrame::aircraft}) {
          auto r = requestOf(attitude(heading, pitch, roll), attitude(heading + 170, -pitch, roll));
          r.setup.general.frame = frame;
          for (const auto& d : {linesOf(r), linesOf(requestOf(attitude(heading, pitch, roll)))})
            for (const SymbolStroke& s : d.strokes)
              for (const float c : {s.x0, s.x1, s.y0, s.y1}) {
                ASSERT_TRUE(std::isfinite(c));
                ASSERT_GE(c, -5);
                ASSERT_LE(c, 1285);
              }
          EXPECT_FALSE(linesOf(requestOf(attitude(heading, pitch, roll))).strokes.empty());
        }
}

TEST(Symbology, drawsTheSameLadderOverTheTopOfALoop) {
  // Through the vertical the heading turns round and the wings roll over; the view does not jump.
  const auto before = linesOf(only(requestOf(attitude(30, 89.9999, 0)), Symbol::pitch_ladder));
  const auto after = linesOf(only(requestOf(attitude(210, 89.9999, 180)), Symbol::pitch_ladder));
  EXPECT_NEAR(longest(before), longest(after), 0.1);
  const auto nearest = [&](const SymbolStroke& s, const SymbologyDrawing& d) {
    double least = 1e9;
    for (const SymbolStroke& t : d.strokes) {
      const double straight = std::hypot(s.x0 - t.x0, s.y0 - t.y0) + std::hypot(s.x1 - t.x1, s.y1 - t.y1);
      const double turned = std::hypot(s.x0 - t.x1, s.y0 - t.y1) + std::hypot(s.x1 - t.x0, s.y1 - t.y0);
      least = std::min({least, straight, turned});
    }
    return least;
  };
  for (const SymbolStroke& s : before.strokes) {
    if (std::hypot(s.x1 - s.x0, s.y1 - s.y0) < 60) continue;
    EXPECT_LT(nearest(s, after), 1.0) << "a bar jumps";
  }
}

TEST(Symbology, writesHeadingsAcrossNorth) {
  const auto at = [](double heading) {
    return linesOf(only(requestOf(attitude(heading, 0, 0)), Symbol::heading_tape));
  };
  EXPECT_TRUE(same(at(0), at(360)));
  EXPECT_TRUE(same(at(-0.75), at(359.25)));
  EXPECT_FALSE(same(at(359.25), at(0)));
  // Eight marks of 5 degrees and the one in the middle, on the tape whatever the heading.
  for (const double heading : {0.0, 90.0, 355.0, 180.0}) {
    const auto d = at(heading);
    const auto vertical = std::count_if(d.strokes.begin(), d.strokes.end(), [](const SymbolStroke& s) {
      return s.x0 == s.x1 && s.y0 < s.y1 && s.y1 - s.y0 < 17 && s.y0 == std::min(s.y0, s.y1) &&
             s.y0 > 640.0f && std::abs(s.y0 - 0.89f * 720) < 0.6f;
    });
    EXPECT_EQ(vertical, 9) << heading;
  }
}

TEST(Symbology, showsDashesForWhatIsNotKnown) {
  auto r = only(requestOf(attitude(0, 0, 0)), Symbol::airspeed);
  r.state.speed.reset();
  const auto unknown = linesOf(r);
  EXPECT_FALSE(unknown.strokes.empty());
  r.state.speed = Knots{kNan};
  EXPECT_TRUE(same(linesOf(r), unknown));
  EXPECT_TRUE(same(linesOf(quantised(r, kView)), unknown));
  r.state.speed = Knots{0};
  EXPECT_FALSE(same(linesOf(r), unknown)) << "at rest the speed is known";
  const auto calibrated = linesOf(r);
  r.state.groundSpeed = true;
  EXPECT_FALSE(same(linesOf(r), calibrated)) << "and says which one it is";
  auto lost = requestOf(attitude(kNan, 0, 0));
  EXPECT_TRUE(linesOf(lost).strokes.empty());
  EXPECT_TRUE(linesOf(quantised(lost, kView)).strokes.empty());
}

TEST(Symbology, obeysPlaceAndSize) {
  auto r = only(requestOf(attitude(0, 0, 0)), Symbol::airspeed);
  SymbolElement& e = r.setup.element[static_cast<std::size_t>(Symbol::airspeed)];
  const std::size_t i = static_cast<std::size_t>(Symbol::airspeed);
  const SymbolBox base = linesOf(r).box[i];
  e.x = Ratio{0.4};
  e.y = Ratio{-0.5};
  const SymbolBox moved = linesOf(r).box[i];
  EXPECT_NEAR(moved.left - base.left, 640, 0.01);
  EXPECT_NEAR(moved.bottom - base.bottom, -0.6 * 360, 0.01);
  e.size = Ratio{2};
  const SymbolBox larger = linesOf(r).box[i];
  EXPECT_NEAR(larger.right - larger.left, 2 * (moved.right - moved.left), 0.01);
  // Symbols of the world, too, by what they are moved.
  auto ladder = only(requestOf(attitude(0, 0, 0)), Symbol::aircraft_reference);
  ladder.setup.element[static_cast<std::size_t>(Symbol::aircraft_reference)].x = Ratio{0.25};
  EXPECT_NEAR(linesOf(ladder).strokes[0].x0, 640 + 160, 0.01);
}

TEST(SymbologyCanvas, keepsWhatIsBeforeTheEyeOfALineThatPassesIt) {
  SymbologyDrawing d;
  Canvas canvas(kView, 0, d);
  canvas.begin(Symbol::pitch_ladder);
  // From the picture's middle over the right edge to behind the eye.
  const Sheet sheet{{0, 0, -1}, {1, 0, 1}, {0, 1, 0}};
  for (const bool turned : {false, true}) {
    d.strokes.clear();
    canvas.line(sheet, turned ? 3 : 0, 0, turned ? 0 : 3, 0);
    ASSERT_EQ(d.strokes.size(), 1u);
    EXPECT_NEAR(std::min(d.strokes[0].x0, d.strokes[0].x1), 640, 0.01);
    EXPECT_NEAR(std::max(d.strokes[0].x0, d.strokes[0].x1), 1280, 0.01);
    EXPECT_NEAR(d.strokes[0].y0, 360, 0.01);
  }
  d.strokes.clear();
  canvas.line(sheet, 2, 0, 3, 0);
  EXPECT_TRUE(d.strokes.empty()) << "all of it behind";
}

TEST(StrokeFont, hasEveryCharacterThatSymbolsWrite) {
  for (const char c : std::string_view("0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ-+.*")) {
    EXPECT_FALSE(glyph(c).empty()) << c;
    for (const GlyphLine& g : glyph(c)) {
      EXPECT_LE(std::max(g.x0, g.x1), kGlyphWidth) << c;
      EXPECT_LE(std::max(g.y0, g.y1), kGlyphHeight) << c;
    }
  }
  EXPECT_TRUE(glyph(' ').empty());
  EXPECT_TRUE(glyph('\xff').empty());
}

}  // namespace
}  // namespace trimtab::scene
