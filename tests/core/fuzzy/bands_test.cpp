#include "trimtab/fuzzy/bands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "tests/core/fuzzy/published_tables.h"
#include "trimtab/fuzzy/membership.h"
#include "trimtab/preset/parameters.h"

namespace trimtab {
namespace {

const BandList kPublished = SchemeParameters{}.bands;

/// The least that is surely more than rounding.
constexpr double kBelow = 1e-11;

TEST(Bands, reproduceThePublishedSizesOverEachHalfOpenRange) {
  for (const test::PrintedBand& row : test::kPrintedBands) {
    for (const double total : {row.low, (row.low + row.high) / 2, row.high - kBelow}) {
      const int band = bandOf(kPublished, total);
      ASSERT_GE(band, 0) << total;
      EXPECT_EQ(kPublished.band[static_cast<std::size_t>(band)], (Band{row.low, row.width, row.height}))
          << total;
    }
  }
  EXPECT_EQ(bandOf(kPublished, 2.0), 3) << "the top band is closed";
  EXPECT_EQ(bandOf(kPublished, 0.1 - kBelow), -1);
  EXPECT_EQ(bandOf(kPublished, 0), -1);
}

/// Every altitude and pitch of the published table's spacing, against the same sum in whole numbers:
/// thousandths of altitude membership and sixtieths of pitch membership, so that no edge is missed or met by
/// rounding.
TEST(Bands, putATotalOnAnEdgeIntoTheBandAbove) {
  constexpr int kWhole = 3000;  // a total of 1
  int onAnEdge = 0;
  for (int ft = 3000; ft <= 30000; ft += 10) {
    int thousandths = ft <= 4000 ? 1000 : ft >= 8000 ? 0 : -1;
    for (const auto& [from, top, fall] :
         {std::array{4000, 1000, 4}, {5000, 600, 3}, {6000, 300, 2}, {7000, 100, 1}})
      if (ft > from && ft <= from + 1000) thousandths = top - fall * (ft - from) / 10;
    for (int degrees = -40; degrees <= 40; ++degrees) {
      const int sixtieths = std::clamp(30 - degrees, 0, 60);
      const int total = 3 * thousandths + 50 * sixtieths;
      int band = -1;
      for (const int low : {kWhole / 10, kWhole / 2, kWhole, 3 * kWhole / 2}) {
        band += total >= low;
        onAnEdge += total == low;
      }
      const double sum = altitudeMembership({}, ft) + pitchMembership({}, degrees);
      ASSERT_EQ(bandOf(kPublished, sum), band) << ft << " ft, " << degrees << " degrees: " << sum;
    }
  }
  EXPECT_GT(onAnEdge, 4000);
  EXPECT_EQ(bandOf(kPublished, 0.09999999999999998), 0) << "30,000 ft, 24 degrees";
}

TEST(Bands, putNoTotalBelowAnEdgeIntoTheBandAbove) {
  for (const Band& band : kPublished.span()) {
    const int above = bandOf(kPublished, band.low);
    EXPECT_EQ(bandOf(kPublished, band.low - kBelow), above - 1);
    EXPECT_EQ(bandOf(kPublished, std::nextafter(band.low, 2)), above);
    EXPECT_EQ(bandOf(kPublished, std::nextafter(band.low, 0)), above) << "rounding";
  }
  BandList tiny;
  tiny.size = 1;
  tiny.band[0] = {1e-13, 16, 16};
  EXPECT_EQ(bandOf(tiny, 0), -1);
}

TEST(Bands, putNothingIntoABandThatIsNotANumberOrWhereThereAreNone) {
  EXPECT_EQ(bandOf(kPublished, std::numeric_limits<double>::quiet_NaN()), -1);
  EXPECT_EQ(bandOf(BandList{}, 1), -1);
  EXPECT_EQ(nextBand(BandList{}, 0.05, 1, 2).band, -1);
}

TEST(Hysteresis, isAPlainLookUpTheFirstTime) {
  for (double total = 0; total <= 2; total += 0.001) {
    const BandChoice choice = nextBand(kPublished, 0.05, total, std::nullopt);
    EXPECT_EQ(choice.band, bandOf(kPublished, total));
    EXPECT_FALSE(choice.held);
  }
}

TEST(Hysteresis, movesUpAtTheEdgePlusItAndDownBelowTheEdgeMinusIt) {
  const double h = 0.0625, up = 0.5 + h, down = 0.5 - h;  // exact in binary
  EXPECT_EQ(nextBand(kPublished, h, up - kBelow, 0).band, 0);
  EXPECT_TRUE(nextBand(kPublished, h, up - kBelow, 0).held);
  EXPECT_EQ(nextBand(kPublished, h, up, 0).band, 1);
  EXPECT_FALSE(nextBand(kPublished, h, up, 0).held);
  EXPECT_EQ(nextBand(kPublished, h, down, 1).band, 1);
  EXPECT_TRUE(nextBand(kPublished, h, down, 1).held);
  EXPECT_EQ(nextBand(kPublished, h, down - kBelow, 1).band, 0);
}

TEST(Hysteresis, holdsFrustumAsItHoldsABand) {
  EXPECT_EQ(nextBand(kPublished, 0.05, 0.14, -1).band, -1);
  EXPECT_TRUE(nextBand(kPublished, 0.05, 0.14, -1).held);
  EXPECT_EQ(nextBand(kPublished, 0.05, 0.16, -1).band, 0);
  EXPECT_EQ(nextBand(kPublished, 0.05, 0.06, 0).band, 0);
  EXPECT_EQ(nextBand(kPublished, 0.05, 0.04, 0).band, -1);
}

TEST(Hysteresis, crossesSeveralBandsAtOnceAndHoldsOnlyAtTheLastEdge) {
  EXPECT_EQ(nextBand(kPublished, 0.05, 1.9, -1).band, 3);
  EXPECT_EQ(nextBand(kPublished, 0.05, 1.52, 0).band, 2);
  EXPECT_TRUE(nextBand(kPublished, 0.05, 1.52, 0).held);
  EXPECT_EQ(nextBand(kPublished, 0.05, 0.98, 3).band, 2);
  EXPECT_EQ(nextBand(kPublished, 0.05, 0.0, 3).band, -1);
}

TEST(Hysteresis, ofZeroIsThePlainLookUp) {
  for (int previous = -1; previous < 4; ++previous)
    for (double total = 0; total <= 2; total += 0.0005)
      EXPECT_EQ(nextBand(kPublished, 0, total, previous).band, bandOf(kPublished, total));
}

TEST(Hysteresis, neverLocksOutTheEndsOfTheScale) {
  for (int previous = -1; previous < 4; ++previous) {
    EXPECT_EQ(nextBand(kPublished, 0.2, 0, previous).band, -1);
    EXPECT_EQ(nextBand(kPublished, 0.6, 2, previous).band, 3);
  }
}

TEST(Hysteresis, forgetsABandThatTheListNoLongerHas) {
  EXPECT_EQ(nextBand(kPublished, 0.05, 0.52, 7).band, 1);
  EXPECT_EQ(nextBand(kPublished, 0.05, 0.52, -5).band, 1);
}

TEST(Hysteresis, agreesWithADirectStatementOfItsRule) {
  // The rule as a set: from `previous`, every band that is allowed; the choice is the allowed one nearest to
  // it.
  const auto allowed = [](int band, double total, double h, int previous) {
    const auto edge = [](int b) { return kPublished.band[static_cast<std::size_t>(b)].low; };
    const bool lowSide = band < 0 || total >= edge(band) + (band > previous ? h : -h);
    const bool highSide = band == 3 || total < edge(band + 1) + (band < previous ? -h : h);
    return lowSide && highSide;
  };
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> totals(1e-9, 2 - 1e-9), hs(0, 0.0999);
  for (int round = 0; round < 200000; ++round) {
    const double total = totals(random), h = hs(random);
    const int previous = static_cast<int>(random() % 5) - 1;
    const int band = nextBand(kPublished, h, total, previous).band;
    ASSERT_TRUE(allowed(band, total, h, previous)) << total << " from " << previous << " gave " << band;
  }
}

TEST(Hysteresis, neverFlipsBackUnlessTheTotalMovedByTwiceIt) {
  constexpr double h = 0.05;
  int flips = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> step(-0.02, 0.02);
    double total = 2 * std::generate_canonical<double, 53>(random), totalAtChange = total;
    int band = bandOf(kPublished, total), before = -2;
    for (int i = 0; i < 3000; ++i) {
      total = std::clamp(total + step(random), 0.0, 2.0);
      const int next = nextBand(kPublished, h, total, band).band;
      if (next == band) continue;
      if (next == before) {
        ++flips;
        ASSERT_GE(std::abs(total - totalAtChange), 2 * h - 1e-12) << "seed " << seed;
      }
      before = band;
      band = next;
      totalAtChange = total;
    }
  }
  EXPECT_GT(flips, 100) << "the walk must come back now and then, or this shows nothing";
}

}  // namespace
}  // namespace trimtab
