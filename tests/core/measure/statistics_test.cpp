#include "trimtab/measure/statistics.h"
#include "trimtab/units/not_finite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace trimtab {
namespace {

TEST(SampleWindow, hasNoStatisticsWhileEmpty) {
  const SampleWindow window(10);
  EXPECT_EQ(window.size(), 0u);
  for (const double value :
       {window.last(), window.mean(), window.largest(), window.median(), window.quantile(0.99)})
    EXPECT_TRUE(std::isnan(value));
}

TEST(SampleWindow, agreesWithSortingTheNewestSamples) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> values(0, 100);
  for (const std::size_t capacity : {1u, 2u, 7u, 100u}) {
    SampleWindow window(capacity);
    std::deque<double> newest;
    for (int i = 0; i < 350; ++i) {
      const double value = values(random);
      window.add(value);
      newest.push_back(value);
      if (newest.size() > capacity) newest.pop_front();
      std::vector<double> sorted(newest.begin(), newest.end());
      std::sort(sorted.begin(), sorted.end());
      ASSERT_EQ(window.size(), newest.size());
      ASSERT_EQ(window.last(), value);
      ASSERT_EQ(window.largest(), sorted.back());
      for (const double q : {0.0, 0.25, 0.5, 0.95, 0.99, 1.0}) {
        if (!isEnoughFor(q, sorted.size())) {
          ASSERT_TRUE(std::isnan(window.quantile(q))) << q << " of " << sorted.size();
          continue;
        }
        // Nearest rank, stated directly: the first that enough samples do not exceed.
        std::size_t at = 0;
        while (static_cast<double>(at + 1) < q * static_cast<double>(sorted.size())) ++at;
        ASSERT_EQ(window.quantile(q), sorted[at]) << q << " of " << sorted.size();
      }
    }
  }
}

TEST(SampleWindow, leavesOutWhatIsNotANumber) {
  SampleWindow window(4);
  for (const double value : {1.0, kNan, 2.0, std::numeric_limits<double>::infinity(), 6.0}) window.add(value);
  EXPECT_EQ(window.size(), 3u);
  EXPECT_EQ(window.mean(), 3);
  EXPECT_EQ(window.last(), 6);
  EXPECT_TRUE(std::isnan(window.quantile(kNan)));
  EXPECT_EQ(window.quantile(-1), 1);
  EXPECT_EQ(window.quantile(2), 6);
  window.clear();
  EXPECT_EQ(window.size(), 0u);
}

TEST(Percentiles, areSaidFromTheFirstNumberOfSamplesOnThatHasOneBeyondThem) {
  struct {
    double fraction;
    std::size_t from;
  } const table[] = {{0.95, 20}, {0.05, 20}, {0.99, 100}, {0.999, 1000}, {0.9, 10},
                     {0.25, 4},  {0.5, 1},   {0, 1},      {1, 1}};
  for (const auto& row : table) {
    EXPECT_TRUE(isEnoughFor(row.fraction, row.from)) << row.fraction;
    EXPECT_FALSE(isEnoughFor(row.fraction, row.from - 1)) << row.fraction;
    EXPECT_EQ(quantileOf(std::vector(row.from, 3.0), row.fraction), 3) << row.fraction;
    EXPECT_TRUE(std::isnan(quantileOf(std::vector(row.from - 1, 3.0), row.fraction))) << row.fraction;
  }
}

TEST(Percentiles, countWhatIsInfiniteAndLeaveOutWhatIsNoNumber) {
  EXPECT_EQ(quantileOf({1, kNan, 2, kInfinity}, 1), kInfinity);
  EXPECT_EQ(quantileOf({1, kNan, 2, kInfinity}, 0.5), 2);
  EXPECT_TRUE(std::isnan(quantileOf({kNan}, 0.5)));
}

TEST(QuantileBounds, holdTheTrueQuantileAsOftenAsTheySay) {
  std::mt19937_64 random(7);
  std::exponential_distribution<double> times(1);
  const double truth = -std::log(0.05);
  for (const std::size_t n : {60u, 100u, 300u}) {
    int above = 0, below = 0;
    constexpr int kRuns = 4000;
    for (int run = 0; run < kRuns; ++run) {
      std::vector<double> samples(n);
      for (double& sample : samples) sample = times(random);
      const QuantileBounds bounds = quantileBounds(samples, 0.95);
      above += bounds.low > truth;
      below += bounds.high < truth;
    }
    // Four standard deviations of the simulation above one in twenty.
    const double most = 0.05 + 4 * std::sqrt(0.05 * 0.95 / kRuns);
    EXPECT_LT(above / double{kRuns}, most) << n;
    EXPECT_LT(below / double{kRuns}, most) << n;
    EXPECT_GT(above / double{kRuns}, 0.01) << "a bound that is always right says nothing";
    EXPECT_GT(below / double{kRuns}, 0.01);
  }
}

TEST(QuantileBounds, haveNoUpperEndForTheNinetyFifthPercentileBelowFiftyNineSamples) {
  EXPECT_EQ(quantileBounds(std::vector(58, 1.0), 0.95).high, kInfinity);
  EXPECT_EQ(quantileBounds(std::vector(59, 1.0), 0.95).high, 1);
  EXPECT_EQ(quantileBounds(std::vector(20, 1.0), 0.95).low, 1);
  EXPECT_TRUE(std::isnan(quantileBounds({}, 0.95).low));
}

TEST(FrameStatistics, keepsStagesApartAndSkipsThoseNotRun) {
  FrameStatistics statistics(100);
  for (int i = 1; i <= 100; ++i) {
    FrameCost cost;
    cost.total = i;
    cost.gpu = kNan;
    cost.occlusion = i % 2 ? 5 : kNan;
    statistics.add(cost);
  }
  const Distribution total = statistics.of(&FrameCost::total);
  EXPECT_EQ(total.median, 50);
  EXPECT_EQ(total.p95, 95);
  EXPECT_EQ(total.p99, 99);
  EXPECT_EQ(total.mean, 50.5);
  EXPECT_EQ(total.largest, 100);
  EXPECT_EQ(statistics.of(&FrameCost::gpu).samples, 0u);
  const Distribution half = statistics.of(&FrameCost::occlusion);
  EXPECT_EQ(half.samples, 50u);
  EXPECT_EQ(half.p95, 5);
  EXPECT_TRUE(std::isnan(half.p99)) << "fifty samples have no 99th percentile";
  EXPECT_EQ(statistics.frames(), 100u);
}

TEST(CostStages, nameEachFieldOfACostOnce) {
  // Whoever adds a field without its line here has a stage that no trace, plot or report shows.
  EXPECT_EQ(kCostStages.size() * sizeof(double), sizeof(FrameCost));
  std::set<std::string> names;
  FrameCost cost;
  double value = 0;
  for (const CostStage& stage : kCostStages) {
    names.insert({stage.name, stage.column, stage.lastColumn});
    EXPECT_EQ(stage.column, std::string(stage.name) + "_ms");
    EXPECT_EQ(stage.lastColumn, std::string("last_") + stage.column);
    cost.*stage.ms = ++value;
  }
  EXPECT_EQ(names.size(), 3 * kCostStages.size());
  value = 0;
  for (const CostStage& stage : kCostStages) EXPECT_EQ(cost.*stage.ms, ++value) << stage.name;
}

}  // namespace
}  // namespace trimtab
