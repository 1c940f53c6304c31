#include "trimtab/fuzzy/membership.h"
#include "trimtab/units/not_finite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/core/fuzzy/published_tables.h"

namespace trimtab {
namespace {

/// Copied from, not made in place: g++ 12 takes a default made in a function for uninitialised.
const AltitudeParameters kTable;
const PitchParameters kLine;

/// With as many decimals as the paper printed.
std::string likePrinted(double value, const std::string& printed) {
  const std::size_t point = printed.find('.');
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(printed.size() - point - 1);
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}
std::string threeDecimals(double value) {
  return likePrinted(value, "0.000");
}

AltitudeParameters reading(AltitudeReading r) {
  AltitudeParameters p = kTable;
  p.reading = r;
  return p;
}
PitchParameters roundedStep() {
  PitchParameters p = kLine;
  p.reading = PitchReading::rounded_step;
  return p;
}

TEST(AltitudeMembership, reproducesThePublishedTable) {
  for (const test::Printed& row : test::kPrintedAltitude) {
    const double value = altitudeMembership(kTable, row.x);
    EXPECT_EQ(likePrinted(value, row.membership), row.membership) << row.x << " ft";
    EXPECT_NEAR(value, std::stod(row.membership), 0.0005) << row.x << " ft";
  }
}

TEST(AltitudeMembership, equationAMissesThePublishedTableInOneRowOnly) {
  for (const test::Printed& row : test::kPrintedAltitude) {
    const double value = altitudeMembership(reading(AltitudeReading::equation_a), row.x);
    if (row.x == 7990)
      EXPECT_EQ(threeDecimals(value), "0.099");
    else
      EXPECT_EQ(likePrinted(value, row.membership), row.membership) << row.x << " ft";
  }
}

TEST(AltitudeMembership, equationAJumpsAtThePhaseEndAsPrinted) {
  const AltitudeParameters a = reading(AltitudeReading::equation_a);
  EXPECT_NEAR(altitudeMembership(a, std::nextafter(5000.0, 0.0)), 0.7, 1e-12);
  EXPECT_EQ(altitudeMembership(a, 5000), 0.6);
}

TEST(AltitudeMembership, equationBIsASawtoothThatStartsAgainAtOne) {
  const AltitudeParameters b = reading(AltitudeReading::equation_b);
  for (const double phase : {4000.0, 5000.0, 6000.0, 7000.0}) EXPECT_EQ(altitudeMembership(b, phase), 1.0);
  // By hand: (0.6 - 500 * 2500 * 1e-6 / 10) / 0.6.
  EXPECT_NEAR(altitudeMembership(b, 5500), (0.6 - 0.125) / 0.6, 1e-12);
  EXPECT_EQ(altitudeMembership(b, 8000), 0.0) << "undefined as printed: 0 / 0";
}

TEST(AltitudeMembership, equationsAreZeroFromTheirMaximumUp) {
  for (const AltitudeReading r : {AltitudeReading::equation_a, AltitudeReading::equation_b}) {
    AltitudeParameters p = reading(r);
    p.maximum = Feet{7500};
    EXPECT_GT(altitudeMembership(p, 7499), 0);
    EXPECT_EQ(altitudeMembership(p, 7500), 0);
    EXPECT_EQ(altitudeMembership(p, 7700), 0);
    EXPECT_EQ(altitudeMembership(p, 90000), 0);
  }
}

TEST(PitchMembership, roundedStepReproducesThePublishedTable) {
  for (const test::Printed& row : test::kPrintedPitch)
    EXPECT_EQ(likePrinted(pitchMembership(roundedStep(), row.x), row.membership), row.membership)
        << row.x << " deg";
}

TEST(PitchMembership, linearIsTheLineFromNoseDownToNoseUp) {
  for (double pitch = -90; pitch <= 90; pitch += 0.37)
    EXPECT_NEAR(pitchMembership(kLine, pitch), std::min(1.0, std::max(0.0, (30 - pitch) / 60)), 1e-15);
  EXPECT_EQ(pitchMembership(kLine, 0), 0.5);
  EXPECT_EQ(threeDecimals(pitchMembership(kLine, 1)), "0.483") << "the table's 0.493 is off the line";
  EXPECT_EQ(threeDecimals(pitchMembership(kLine, -1)), "0.517") << "the table's 0.507 is off the line";
}

TEST(PitchMembership, roundedStepIsNotMonotoneAroundLevelFlight) {
  EXPECT_GT(pitchMembership(roundedStep(), 1e-9), 0.5);
  EXPECT_EQ(pitchMembership(roundedStep(), 0), 0.5);
  EXPECT_EQ(pitchMembership(roundedStep(), -0.0), 0.5);
  EXPECT_LT(pitchMembership(roundedStep(), -1e-9), 0.5);
}

TEST(Membership, isNotANumberWhereTheInputIsNone) {
  for (const AltitudeReading r :
       {AltitudeReading::table, AltitudeReading::equation_a, AltitudeReading::equation_b})
    EXPECT_TRUE(std::isnan(altitudeMembership(reading(r), kNan)));
  EXPECT_TRUE(std::isnan(pitchMembership(kLine, kNan)));
  EXPECT_TRUE(std::isnan(pitchMembership(roundedStep(), kNan)));
  EXPECT_TRUE(std::isnan(curveValue(CurvePoints{}, 1)));
}

TEST(Membership, hasTheCurvesEndsAtInfinity) {
  for (const AltitudeReading r :
       {AltitudeReading::table, AltitudeReading::equation_a, AltitudeReading::equation_b}) {
    EXPECT_EQ(altitudeMembership(reading(r), -kInfinity), 1);
    EXPECT_EQ(altitudeMembership(reading(r), kInfinity), 0);
  }
  for (const PitchParameters& p : {kLine, roundedStep()}) {
    EXPECT_EQ(pitchMembership(p, -kInfinity), 1);
    EXPECT_EQ(pitchMembership(p, kInfinity), 0);
  }
}

TEST(Membership, staysBetweenZeroAndOneWhateverTheInput) {
  std::mt19937_64 random(1);
  const auto any = [&random] {
    // Bit patterns: every exponent, denormals too.
    double value = 0;
    const std::uint64_t bits = random();
    static_assert(sizeof bits == sizeof value);
    std::memcpy(&value, &bits, sizeof value);
    return std::isfinite(value) ? value : 0.0;
  };
  for (int i = 0; i < 20000; ++i) {
    const double x = i % 2 ? any() : std::uniform_real_distribution(-1000.0, 12000.0)(random);
    for (const AltitudeReading r :
         {AltitudeReading::table, AltitudeReading::equation_a, AltitudeReading::equation_b}) {
      const double value = altitudeMembership(reading(r), x);
      ASSERT_TRUE(value >= 0 && value <= 1) << x;
    }
    for (const PitchParameters& p : {kLine, roundedStep()}) {
      const double value = pitchMembership(p, x);
      ASSERT_TRUE(value >= 0 && value <= 1) << x;
    }
  }
}

TEST(CurveValue, isExactAtEveryPointAndContinuousAnUlpBeside) {
  const AltitudeParameters& p = kTable;
  for (const CurvePoint& point : p.curve.span()) {
    EXPECT_EQ(curveValue(p.curve, point.x), point.y);
    EXPECT_NEAR(curveValue(p.curve, std::nextafter(point.x, -kInfinity)), point.y, 1e-15);
    EXPECT_NEAR(curveValue(p.curve, std::nextafter(point.x, kInfinity)), point.y, 1e-15);
  }
}

TEST(CurveValue, hasAStepWherePointsShareAnXAndTheLastOneCounts) {
  const CurvePoints step{{0, 1}, {10, 0.8}, {10, 0.2}, {20, 0}};
  EXPECT_NEAR(curveValue(step, std::nextafter(10.0, 0.0)), 0.8, 1e-15);
  EXPECT_EQ(curveValue(step, 10), 0.2);
  EXPECT_NEAR(curveValue(step, std::nextafter(10.0, 20.0)), 0.2, 1e-15);
  const CurvePoints startsWithStep{{5, 1}, {5, 0.5}, {6, 0}};
  EXPECT_EQ(curveValue(startsWithStep, std::nextafter(5.0, 0.0)), 1);
  EXPECT_EQ(curveValue(startsWithStep, 5), 0.5);
  const CurvePoints endsWithStep{{5, 1}, {6, 0.5}, {6, 0}};
  EXPECT_EQ(curveValue(endsWithStep, 6), 0);
}

TEST(CurveValue, copesWithPointsADenormalApart) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  const CurvePoints steep{{0, 1}, {2 * tiny, 0}};
  EXPECT_EQ(curveValue(steep, 0), 1);
  EXPECT_EQ(curveValue(steep, tiny), 0.5);
  EXPECT_EQ(curveValue(steep, 2 * tiny), 0);
  EXPECT_EQ(curveValue(steep, -tiny), 1);
}

TEST(CurveValue, neverLeavesItsNeighboursAndIsMonotoneBetweenThem) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 300; ++round) {
    const double x0 = -500 + 1000 * unit(random), width = std::exp2(-20 + 30 * unit(random));
    const CurvePoints curve{{x0, unit(random)}, {x0 + width, unit(random)}};
    const auto [low, high] = std::minmax(curve.point[0].y, curve.point[1].y);
    const bool rises = curve.point[1].y >= curve.point[0].y;
    std::vector<double> arguments;
    for (int i = 0; i <= 100; ++i) arguments.push_back(x0 + width * i / 100);
    for (double x = x0 + width; arguments.size() < 200; x = std::nextafter(x, x0)) arguments.push_back(x);
    std::sort(arguments.begin(), arguments.end());
    double before = curve.point[0].y;
    for (const double x : arguments) {
      const double y = curveValue(curve, x);
      ASSERT_TRUE(y >= low && y <= high);
      ASSERT_TRUE(rises ? y >= before : y <= before) << x;
      before = y;
    }
  }
}

}  // namespace
}  // namespace trimtab
