#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "fuzzylite_oracle.h"

namespace trimtab {
namespace {

using test::FuzzyResult;
using test::Grid;

constexpr double kAgreement = 1e-9;
const AltitudeParameters kAltitude;
const PitchParameters kPitch;

void expectAgreement(const AltitudeParameters& altitude, const PitchParameters& pitch, const Grid& grid) {
  std::string error;
  const std::vector<FuzzyResult> theirs = test::byFuzzylite(altitude, pitch, grid, error);
  ASSERT_EQ(error, "");
  ASSERT_EQ(theirs.size(), grid.size());
  std::size_t point = 0, differing = 0;
  double worst = 0;
  for (const double a : grid.altitude) {
    for (const double p : grid.pitch) {
      const FuzzyResult ours = test::byUs(altitude, pitch, a, p);
      for (std::size_t i = 0; i < ours.size(); ++i) {
        const double difference = std::abs(ours[i] - theirs[point][i]);
        if (difference > worst) worst = difference;
        if (!(difference <= kAgreement) && ++differing <= 5)
          ADD_FAILURE() << a << " ft, " << p << " deg, result " << i << ": " << ours[i] << " against "
                        << theirs[point][i];
      }
      ++point;
    }
  }
  EXPECT_EQ(differing, 0u);
  std::printf("fuzzylite: %zu points, largest difference %.2g\n", point, worst);
}

#define NEEDS_FUZZYLITE() \
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program"

TEST(FuzzyArithmetic, agreesWithFuzzyliteOverTheDefaults) {
  NEEDS_FUZZYLITE();
  const Grid grid = test::gridFor(kAltitude, kPitch, 401, 251);
  ASSERT_GE(grid.size(), 100000u);
  expectAgreement(kAltitude, kPitch, grid);
}

TEST(FuzzyArithmetic, agreesWithFuzzyliteOverEditedCurves) {
  NEEDS_FUZZYLITE();
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 3; ++round) {
    AltitudeParameters altitude = kAltitude;
    altitude.curve.size = 0;
    for (int i = 0; i < 6; ++i)
      altitude.curve.point[altitude.curve.size++] = {3000.0 + 1000 * i + 800 * unit(random), unit(random)};
    PitchParameters pitch = kPitch;
    pitch.curve.size = 0;
    for (int i = 0; i < 5; ++i)
      pitch.curve.point[pitch.curve.size++] = {-40.0 + 20 * i + 15 * unit(random), unit(random)};
    expectAgreement(altitude, pitch, test::gridFor(altitude, pitch, 101, 71));
  }
}

}  // namespace
}  // namespace trimtab
