#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "quad.h"
#include "table.h"
#include "trimtab/fuzzy/bands.h"
#include "trimtab/fuzzy/combination.h"
#include "trimtab/fuzzy/membership.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::stress {
namespace {

/// A line between the neighbours of x, by the other of the two formulas: y = (a (bx - x) + b (x - ax)) / (bx
/// - ax).
Quad curveTwin(const CurvePoints& curve, Quad x) {
  if (x < curve.point[0].x) return curve.point[0].y;
  for (std::size_t i = curve.size - 1;; --i) {
    const CurvePoint a = curve.point[i];
    if (x < a.x) continue;
    if (i + 1 == curve.size) return a.y;
    const CurvePoint b = curve.point[i + 1];
    return (a.y * (Quad{b.x} - x) + b.y * (x - a.x)) / (Quad{b.x} - a.x);
  }
}

Quad clamped01(Quad y) {
  return std::clamp<Quad>(y, 0, 1);
}

/// Eq. (1) of A and B: the phase's membership less (h - phase)(max - h) offset / height offset.
Quad equationTwin(const AltitudeParameters& p, Quad h, bool divided) {
  const auto points = p.curve.span();
  if (h < points.front().x) return points.front().y;
  if (h >= p.maximum.value()) return 0;
  std::size_t i = points.size() - 1;
  while (h < points[i].x) --i;
  if (i + 1 == points.size()) return points[i].y;
  const Quad fall =
      (h - points[i].x) * (p.maximum.value() - h) * p.membershipOffset.value() / p.heightOffset.value();
  if (!divided) return clamped01(points[i].y - fall);
  return points[i].y > 0 ? clamped01(1 - fall / points[i].y) : 0;
}

/// At and beside a place: the next numbers, some ulps on, and a billionth.
std::vector<double> around(double x) {
  std::vector<double> places{x, x - 1e-9, x + 1e-9, x * (1 - 1e-12), x * (1 + 1e-12)};
  for (const int ulps : {-3, -2, -1, 1, 2, 3}) places.push_back(stepped(x, ulps));
  return places;
}

/// Where to look at a curve: every point and its surroundings, between, and beyond both ends.
std::vector<double> placesOf(const CurvePoints& curve, std::mt19937_64& random) {
  std::vector<double> places{-kInfinity, kInfinity, 0.0, -0.0, 5e-324, -5e-324};
  for (const CurvePoint& p : curve.span())
    for (const double x : around(p.x)) places.push_back(x);
  const double low = curve.point[0].x, high = curve.point[curve.size - 1].x;
  std::uniform_real_distribution<double> unit(-0.1, 1.1);
  for (int i = 0; i < 20; ++i) places.push_back(low + (high - low) * unit(random));
  return places;
}

/// Any curve that a preset may hold, and stranger ones: steps, zero width, one point, scales from 1e-300 to
/// 1e300.
CurvePoints randomCurve(std::mt19937_64& random, bool anyScale) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::uniform_int_distribution<std::size_t> count(1, CurvePoints::kCapacity);
  CurvePoints curve;
  curve.size = count(random);
  const double scale = anyScale ? std::pow(10, -300 + 600 * unit(random)) : 40000;
  double x = scale * (2 * unit(random) - 1) / 4;
  for (std::size_t i = 0; i < curve.size; ++i) {
    const double kind = unit(random);
    if (kind > 0.9)
      x = stepped(x, 1);
    else if (kind > 0.15 || (i > 1 && curve.point[i - 2].x == x))
      x += scale * unit(random) / 32;
    const double y = unit(random);
    curve.point[i] = {x, kind < 0.3 ? std::round(y) : y};
  }
  return curve;
}

AltitudeParameters altitudeOf(const CurvePoints& curve, AltitudeReading reading) {
  AltitudeParameters p;
  p.reading = reading;
  static_cast<CurvePoints&>(p.curve) = curve;
  return p;
}

TEST(MembershipStress, curvesAreLinesBetweenTheirPoints) {
  std::mt19937_64 random(1);
  Case line("membership", "table, random curves", 6 * kU, "",
            "3 roundings of the fraction, 2 of the rise, 1 of the sum, all of at most 1");
  Case everyScale("membership", "curve from 1e-300 to 1e300 wide", 6 * kU, "",
                  "the same six roundings: none depends on the scale");
  Case exact("membership", "at the points themselves", 0, "",
             "x - a.x is 0: the point's own value, of a step the later one's");
  Case within("membership", "never outside the neighbours", 0, "violations",
              "clamped to the two points' values");
  for (std::size_t i = 0; i < samples(10000); ++i) {
    const bool anyScale = i % 2 == 1;
    const CurvePoints curve = randomCurve(random, anyScale);
    for (std::size_t k = 0; k < curve.size; ++k)
      if (k + 1 == curve.size || curve.point[k + 1].x != curve.point[k].x)
        exact.see(distance(curveValue(curve, curve.point[k].x), curve.point[k].y));
    for (const double x : placesOf(curve, random)) {
      const double y = curveValue(curve, x);
      (anyScale ? everyScale : line)
          .see(distance(y, std::isinf(x) ? Quad{x > 0 ? curve.point[curve.size - 1].y : curve.point[0].y}
                                         : curveTwin(curve, x)),
               [&] { return "x " + digits(x) + " of " + std::to_string(curve.size) + " points"; });
      double low = 1, high = 0;
      for (const CurvePoint& p : curve.span()) low = std::min(low, p.y), high = std::max(high, p.y);
      within.require(y >= low && y <= high);
    }
  }
}

TEST(MembershipStress, theShippedCurvesHoldBesideEachBreakpoint) {
  Case table("membership", "table of A and B beside each point", 6 * kU, "", "six roundings of at most 1");
  Case pitch("membership", "linear pitch beside each point", 6 * kU, "", "six roundings of at most 1");
  const AltitudeParameters altitude;
  const PitchParameters pitches;
  for (double centre = -1000; centre <= 9000; centre += 250)
    for (const double x : around(centre))
      table.see(distance(altitudeMembership(altitude, x), curveTwin(altitude.curve, x)));
  for (double centre = -90; centre <= 90; centre += 2.5)
    for (const double x : around(centre))
      pitch.see(distance(pitchMembership(pitches, x), curveTwin(pitches.curve, x)));
}

TEST(MembershipStress, thePrintedEquationsHold) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  Case a("membership", "equation_a", 6 * kU, "",
         "5 roundings of a fall of at most 1 (beyond, both are 0), 1 of the difference");
  Case b("membership", "equation_b", 8 * kU, "",
         "as A, divided by the phase: fall and difference are at most the phase where it counts, and the "
         "quotient rounds once more");
  for (std::size_t i = 0; i < samples(6000); ++i) {
    AltitudeParameters p = altitudeOf(i == 0 ? CurvePoints(kAltitudeCurve) : randomCurve(random, false),
                                      AltitudeReading::equation_a);
    p.maximum = Feet{p.curve.point[p.curve.size - 1].x + (i % 3 == 0 ? 0 : 1000 * unit(random))};
    if (i == 0) p.maximum = Feet{8000};
    if (i > 0)
      p.heightOffset = Feet{std::pow(10, -3 + 7 * unit(random))},
      p.membershipOffset = Membership{std::pow(10, -12 * unit(random))};
    std::vector<double> places = placesOf(p.curve, random);
    for (const double x : around(p.maximum.value())) places.push_back(x);
    for (const double x : places) {
      const Quad h = std::isinf(x) ? Quad{std::copysign(1e300, x)} : Quad{x};
      const auto where = [&] { return "h " + digits(x); };
      p.reading = AltitudeReading::equation_a;
      a.see(distance(altitudeMembership(p, x), equationTwin(p, h, false)), where);
      p.reading = AltitudeReading::equation_b;
      b.see(distance(altitudeMembership(p, x), equationTwin(p, h, true)), where);
    }
  }
}

TEST(MembershipStress, theRoundedStepHolds) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  Case step("membership", "rounded step of pitch", 3 * kU, "",
            "two roundings of the product and one of 1 - it, all of at most 1");
  for (std::size_t i = 0; i < samples(20000); ++i) {
    PitchParameters p;
    p.reading = PitchReading::rounded_step;
    if (i > 0) p.step = Membership{i % 5 == 0 ? 0 : unit(random)}, p.limit = Degrees{90 * unit(random)};
    std::vector<double> places{0.0, -0.0, -90, 90, -180 + 360 * unit(random)};
    for (const double edge : {0.0, p.limit.value(), -p.limit.value()})
      for (const double x : around(edge)) places.push_back(x);
    for (const double x : places) {
      const Quad s = p.step.value(), limit = p.limit.value();
      const Quad exact = x == 0 ? Quad{0.5} : clamped01(x > 0 ? s * (limit - x) : 1 - s * (limit + x));
      step.see(distance(pitchMembership(p, x), exact), [&] { return "pitch " + digits(x); });
    }
  }
}

TEST(MembershipStress, whatIsNoNumberStaysNone) {
  Case none("membership", "NaN in, NaN out; never outside 0..1", 0, "violations", "said in membership.h");
  std::mt19937_64 random(4);
  for (const auto reading :
       {AltitudeReading::table, AltitudeReading::equation_a, AltitudeReading::equation_b})
    for (int i = 0; i < 200; ++i) {
      const AltitudeParameters p = altitudeOf(randomCurve(random, false), reading);
      none.require(std::isnan(altitudeMembership(p, kNan)));
      for (const double x : {-kInfinity, kInfinity, -1e308, 1e308, 5e-324, -0.0}) {
        const double y = altitudeMembership(p, x);
        none.require(y >= 0 && y <= 1);
      }
    }
  none.require(std::isnan(curveValue({}, 1)));
}

TEST(CombinationStress, sumAndTwiceTheMinimumHold) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  Case sum("combination", "sum", 0, "", "the exact sum, rounded once");
  Case twice("combination", "twice the minimum", 0, "", "doubling is exact");
  for (std::size_t i = 0; i < samples(100000); ++i) {
    const double a = i % 7 == 0 ? 5e-324 : unit(random), p = i % 5 == 0 ? stepped(1, -1) : unit(random);
    sum.see(distance(combine(Combination::sum, a, p), toDouble(Quad{a} + p)));
    twice.see(distance(combine(Combination::twice_minimum, a, p), 2 * std::min(Quad{a}, Quad{p})));
  }
}

BandList randomBands(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  BandList bands;
  bands.size = 1 + static_cast<std::size_t>(unit(random) * 15.99);
  std::vector<double> lows;
  for (std::size_t i = 0; i < bands.size; ++i) lows.push_back(0.01 + 1.98 * unit(random));
  std::sort(lows.begin(), lows.end());
  for (std::size_t i = 0; i < bands.size; ++i) bands.band[i] = {lows[i], 64, 64};
  return bands;
}

/// A total reaches an edge from 1e-12 below it on, but a total of 0 reaches none above 0.
bool reaches(double total, double edge) {
  return total >= edge || (total > 0 && total >= toDouble(Quad{edge} - Quad{1e-12}));
}

/// Edges with their hysteresis as exact arithmetic gives them, rounded once.
int bandTwin(const BandList& bands, Quad hysteresis, double total, int previous) {
  int plain = -1, band = previous;
  for (std::size_t i = 0; i < bands.size; ++i)
    if (reaches(total, bands.band[i].low)) plain = static_cast<int>(i);
  if (total <= 0 || total >= 2) return plain;
  const auto low = [&](int b) { return Quad{bands.band[static_cast<std::size_t>(b)].low}; };
  while (band < plain && reaches(total, toDouble(low(band + 1) + hysteresis))) ++band;
  while (band > plain && !reaches(total, toDouble(low(band) - hysteresis))) --band;
  return band;
}

TEST(BandsStress, edgesAreWhereTheySay) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  Case plain("bands", "look-up at and beside each edge", 0, "violations",
             "an edge less 1e-12 is rounded once");
  Case edge("bands", "bands with hysteresis at and beside each edge", 0, "violations",
            "edge and hysteresis are added exactly and rounded once, less 1e-12 rounded once");
  for (std::size_t i = 0; i < samples(5000); ++i) {
    const BandList bands = i == 0 ? kDepthMapBands : randomBands(random);
    const double hysteresis = i == 0 ? 0.05 : i % 4 == 0 ? 0 : 0.2 * unit(random);
    std::vector<double> places{0, 2, 2 * unit(random), 5e-324, stepped(2, -1), stepped(2, 1)};
    for (const Band& b : bands.span())
      for (const double centre : {b.low, b.low + hysteresis, b.low - hysteresis})
        for (const double x : around(centre)) places.push_back(x);
    for (const double total : places) {
      int band = -1;
      for (std::size_t k = 0; k < bands.size; ++k)
        if (reaches(total, bands.band[k].low)) band = static_cast<int>(k);
      plain.require(bandOf(bands, total) == band);
      for (int previous = -1; previous < static_cast<int>(bands.size); previous += 3) {
        edge.require(
            nextBand(bands, hysteresis, total, previous).band == bandTwin(bands, hysteresis, total, previous),
            [&] { return "total " + digits(total) + " after band " + std::to_string(previous); });
      }
    }
  }
  plain.require(bandOf(kDepthMapBands, kNan) == -1);
}

}  // namespace
}  // namespace trimtab::stress
