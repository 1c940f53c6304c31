#include "trimtab/measure/paired_ratio.h"

#include "tests/core/measure/noisy_machine.h"
#include "trimtab/units/not_finite.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace trimtab {
namespace {

/// Exact: Pascal's triangle in whole numbers. Chance that the interval from the k-th smallest to the k-th
/// largest of n values holds the median.
double coverage(std::size_t n, std::size_t k) {
  std::vector<double> row{1};
  for (std::size_t i = 0; i < n; ++i) {
    row.push_back(0);
    for (std::size_t j = row.size() - 1; j > 0; --j) row[j] += row[j - 1];
  }
  double outside = 0;
  for (std::size_t i = 0; i < k; ++i) outside += 2 * row[i];
  return 1 - outside / std::exp2(static_cast<double>(n));
}

TEST(PairedRatio, cutsWhatTheBinomialTablesSay) {
  // Ranks of a 95 % interval for the median, as binomial tables at p = 0.5 give them.
  struct {
    std::size_t n, rank;
  } const table[] = {{5, 0}, {6, 1}, {8, 1}, {9, 2}, {10, 2}, {12, 3}, {15, 4}, {20, 6}, {25, 8}, {30, 10}};
  for (const auto& row : table) EXPECT_EQ(medianIntervalRank(row.n), row.rank) << row.n;
}

TEST(PairedRatio, isSureByAtLeastNinetyFivePercentAndNotByOneRankMore) {
  for (std::size_t n = 6; n <= 50; ++n) {
    EXPECT_GE(coverage(n, medianIntervalRank(n)), 0.95) << n;
    EXPECT_LT(coverage(n, medianIntervalRank(n) + 1), 0.95) << n;
  }
  // Far beyond where 2^-n is a number: the normal approximation's rank, n/2 - 0.98 sqrt(n), within one.
  EXPECT_NEAR(static_cast<double>(medianIntervalRank(100000)), 50000 - 0.98 * std::sqrt(100000.0), 1.5);
}

TEST(PairedRatio, holdsTheTrueMedianAsOftenAsItSays) {
  std::mt19937_64 random(11);
  // Skewed, heavy-tailed noise as schedulers make it; its median is known.
  std::lognormal_distribution<double> noise(0, 0.8);
  constexpr double kTrue = 0.7;
  for (const std::size_t n : {6u, 10u, 20u, 60u}) {
    int held = 0;
    constexpr int kRuns = 20000;
    std::vector<double> a(n), b(n);
    for (int run = 0; run < kRuns; ++run) {
      for (std::size_t i = 0; i < n; ++i) {
        a[i] = 1 + noise(random);
        b[i] = a[i] * kTrue * noise(random);
      }
      const PairedRatio ratio = pairedRatio(a, b);
      held += ratio.low <= kTrue && kTrue <= ratio.high;
    }
    const double expected = coverage(n, medianIntervalRank(n));
    // Four standard deviations of the simulation.
    const double tolerance = 4 * std::sqrt(expected * (1 - expected) / kRuns);
    EXPECT_NEAR(static_cast<double>(held) / kRuns, expected, tolerance) << n;
  }
}

TEST(PairedRatio, doesNotMindANoiseThatBothOfAPairShare) {
  const std::vector<double> a{10, 200, 13, 900, 11, 50, 10}, b{5, 100, 6.5, 450, 5.5, 25, 5};
  const PairedRatio ratio = pairedRatio(a, b);
  EXPECT_EQ(ratio.median, 0.5);
  EXPECT_EQ(ratio.low, 0.5);
  EXPECT_EQ(ratio.high, 0.5);
  EXPECT_EQ(ratio.pairs, 7u);
}

TEST(PairedRatio, isItsOwnReciprocalTheOtherWayRound) {
  const std::vector<double> a{1, 1, 1, 1, 1, 1}, b{1, 2, 4, 8, 16, 32};
  const PairedRatio there = pairedRatio(a, b), back = pairedRatio(b, a);
  EXPECT_DOUBLE_EQ(there.median, std::sqrt(32.0));
  EXPECT_DOUBLE_EQ(there.median * back.median, 1);
  EXPECT_EQ(there.low, 1 / back.high);
  EXPECT_EQ(there.high, 1 / back.low);
}

TEST(PairedRatio, countsOnlyPairsThatHaveARatio) {
  const std::vector<double> a{1, 0, kNan, 1, -1, 1, kInfinity}, b{2, 2, 2, kNan, 2, -2, 2};
  EXPECT_EQ(pairedRatio(a, b).pairs, 1u);
  EXPECT_EQ(pairedRatio(a, b).median, 2);
  const PairedRatio none = pairedRatio({}, b);
  EXPECT_EQ(none.pairs, 0u);
  EXPECT_TRUE(std::isnan(none.median) && std::isnan(none.low) && std::isnan(none.high));
}

TEST(PairedRatio, isSureOfNothingBelowSixPairs) {
  const std::vector<double> a(5, 1.0), b(5, 2.0);
  const PairedRatio ratio = pairedRatio(a, b);
  EXPECT_EQ(ratio.median, 2);
  EXPECT_EQ(ratio.low, 0);
  EXPECT_EQ(ratio.high, kInfinity);
}

TEST(PairedDifference, isTheMedianOfTheDifferencesWithItsInterval) {
  const std::vector<double> a{10, 10, 10, 10, 10, 10, kNan, 10}, b{11, 12, 13, 14, 15, 16, 17, kInfinity};
  const PairedDifference six = pairedDifference(a, b);
  EXPECT_EQ(six.pairs, 6u) << "what is not finite does not count";
  EXPECT_EQ(six.median, 3.5);
  EXPECT_EQ(six.low, 1);
  EXPECT_EQ(six.high, 6);
  const PairedDifference back = pairedDifference(b, a);
  EXPECT_EQ(back.median, -3.5);
  EXPECT_EQ(back.low, -6);
  const PairedDifference five = pairedDifference(std::span(a).first(5), b);
  EXPECT_EQ(five.median, 3);
  EXPECT_EQ(five.low, -kInfinity);
  EXPECT_EQ(five.high, kInfinity);
  EXPECT_TRUE(std::isnan(pairedDifference({}, {}).median));
}

TEST(MeasuredDifference, isWhatTheIntervalSays) {
  struct {
    PairedRatio ratio;
    MeasuredDifference difference;
    const char* words;
  } const table[] = {{{0.88, 0.86, 0.9, 60}, MeasuredDifference::less, "12 % faster"},
                     {{1.034, 1.02, 1.05, 60}, MeasuredDifference::more, "3.4 % slower"},
                     {{2.1, 1.9, 2.3, 60}, MeasuredDifference::more, "2.1 times as long"},
                     {{1.3, 0.99, 1.5, 60}, MeasuredDifference::none, "no difference"},
                     {{0.48, 0.4, 1, 60}, MeasuredDifference::none, "no difference"},
                     {{9.97, 0, kInfinity, 1}, MeasuredDifference::unknown, "too few pairs to tell"},
                     {{kNan, kNan, kNan, 0}, MeasuredDifference::unknown, "not measured"}};
  for (const auto& row : table) {
    EXPECT_EQ(differenceOf(row.ratio), row.difference) << row.words;
    EXPECT_EQ(inWords(row.ratio), row.words);
  }
  EXPECT_EQ(differenceOf(PairedDifference{-2, -3, -1, 9}), MeasuredDifference::less);
  EXPECT_EQ(differenceOf(PairedDifference{0, 0, 0, 9}), MeasuredDifference::none);
  EXPECT_EQ(differenceOf(PairedDifference{2, -kInfinity, kInfinity, 3}), MeasuredDifference::unknown);
}

TEST(ErrorDifference, ofIdenticalImagesIsNoneAndOfTooFewIsUnknown) {
  const std::vector<double> flip{0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  EXPECT_EQ(errorDifference(flip, flip), MeasuredDifference::none);
  EXPECT_EQ(errorDifference(std::span(flip).first(5), flip), MeasuredDifference::unknown);
}

TEST(ErrorDifference, isJudgedByTheFramesThatDiffer) {
  // A rule that fires in ten of sixty frames: the median of all differences is 0.
  std::vector<double> plain(60, 0.01), ruled = plain;
  for (std::size_t i = 0; i < 10; ++i) ruled[i] = 0.02;
  EXPECT_EQ(errorDifference(plain, ruled), MeasuredDifference::more);
  EXPECT_EQ(errorDifference(ruled, plain), MeasuredDifference::less);
  for (std::size_t i = 0; i < 5; ++i) ruled[i] = 0.005;
  EXPECT_EQ(errorDifference(plain, ruled), MeasuredDifference::none) << "five frames lose and five gain";
  for (std::size_t i = 0; i < 57; ++i) ruled[i] = plain[i];
  ruled[59] = 0.5;
  EXPECT_EQ(errorDifference(plain, ruled), MeasuredDifference::unknown) << "one frame of sixty";
}

TEST(ErrorDifference, needsTheMedianAndTheMeanToAgree) {
  std::vector<double> plain(60, 0.01), other = plain;
  for (double& flip : other) flip += 0.0001;
  for (std::size_t i = 0; i < 5; ++i) other[i] = 0;
  EXPECT_EQ(errorDifference(plain, other), MeasuredDifference::none) << "most lose a little, a few gain much";
}

TEST(Front, holdsWhatIsNotSurelyBeaten) {
  const std::vector<double> x{1, 2, 2.01, 3, kNan}, y{9, 5, 5.2, 4.9, 1};
  const auto exactly = [&](std::size_t i, std::size_t j) {
    return x[i] <= x[j] && y[i] <= y[j] && (x[i] < x[j] || y[i] < y[j]);
  };
  EXPECT_EQ(frontOf(x, y, exactly), (std::vector<std::size_t>{0, 1, 3}));
  // The same with a noise of 0.3 in y: what does not differ from a point of the front is on it, and what is
  // on it by noise alone is not.
  const auto noisily = [&](std::size_t i, std::size_t j) {
    const auto surely = [](double a, double b, double noise) {
      return a > b + noise   ? MeasuredDifference::more
             : a < b - noise ? MeasuredDifference::less
                             : MeasuredDifference::none;
    };
    return isBetterInBoth(surely(x[j], x[i], 0.1), surely(y[j], y[i], 0.3));
  };
  EXPECT_EQ(frontOf(x, y, noisily), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(PairedRatio, tellsASettingApartFromItselfOnANoisyMachineInAtMostTenOfAHundred) {
  test::NoisyMachine machine(3);
  int differ = 0, told = 0;
  for (int run = 0; run < 100; ++run) {
    std::vector<double> a, b, slower;
    for (int pair = 0; pair < 30; ++pair)
      for (const bool first : {pair % 2 == 0, pair % 2 == 1}) {
        (first ? a : b).push_back(10 * machine.next());
        if (!first) slower.push_back(11.5 * machine.next());
      }
    differ += differenceOf(pairedRatio(a, b)) != MeasuredDifference::none;
    told += differenceOf(pairedRatio(a, slower)) == MeasuredDifference::more;
  }
  EXPECT_LE(differ, 10);
  EXPECT_GE(told, 90) << "15 % slower";
}

}  // namespace
}  // namespace trimtab
