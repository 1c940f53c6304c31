#include "app/tune/search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/tune/candidates.h"
#include "app/tune/search_space.h"

namespace trimtab::tune {
namespace {

/// Returns the area between a front and the corner (1.1, 1.1).
double areaOf(const std::vector<Candidate>& front) {
  double area = 0, above = 1.1;
  for (const Candidate& candidate : front) {
    if (candidate.objectives[0] >= 1.1 || candidate.objectives[1] >= above) continue;
    area += (1.1 - candidate.objectives[0]) * (above - candidate.objectives[1]);
    above = candidate.objectives[1];
  }
  return area;
}

/// A synthetic cost whose front is known (Zitzler, Deb and Thiele 2000, ZDT1): one number chooses the place
/// on the front, and only with all others right does a candidate lie on it.
Objectives planted(double chooses, double wrong) {
  const double g = 1 + 9 * wrong;
  return {chooses, g * (1 - std::sqrt(chooses / g))};
}

TEST(Search, findsAPlantedFrontFromBrokenCurves) {
  TuningParameters broken;
  for (std::size_t i = 0; i < broken.altitude.curve.size; ++i)
    broken.altitude.curve.point[i].y = i % 2 ? 0.9 : 0.1;
  broken.pitch.curve = {{-80, 0.2}, {-79, 1.0}};
  const TuningParameters truth;
  const auto space =
      SearchSpace::make(broken, {"lod.scale=1..8", "fuzzy.altitude.curve_ft", "fuzzy.pitch.curve_deg"});
  ASSERT_TRUE(space) << toString(space.findings());
  const auto wrong = [&](const TuningParameters& p) {
    double sum = 0;
    for (std::size_t i = 0; i < truth.altitude.curve.size; ++i)
      sum += std::abs(p.altitude.curve.point[i].y - truth.altitude.curve.point[i].y);
    for (std::size_t i = 0; i < truth.pitch.curve.size; ++i)
      sum += std::abs(p.pitch.curve.point[i].y - truth.pitch.curve.point[i].y);
    return sum / static_cast<double>(truth.altitude.curve.size + truth.pitch.curve.size);
  };
  Search search;
  search.axes = space->size();
  search.seeds = {space->placeOf(broken)};
  std::size_t evaluations = 0;
  search.evaluate = [&](std::span<const double> place) {
    ++evaluations;
    const TuningParameters p = space->at(place);
    return planted(std::log2(p.lod.scale.value()) / 3, wrong(p));
  };
  const std::vector<Candidate> front = frontOf(search);
  EXPECT_LE(evaluations, 20000u);
  EXPECT_GT(evaluations, 19000u);
  constexpr double kWhole = 1.1 * 1.1 - 1.0 / 3;
  EXPECT_GE(areaOf(front), 0.98 * kWhole) << areaOf(front) / kWhole;
  EXPECT_LE(areaOf(front), kWhole) << "nothing lies beyond the front";
  EXPECT_TRUE(std::is_sorted(front.begin(), front.end(), [](const Candidate& a, const Candidate& b) {
    return a.objectives[0] < b.objectives[0] && a.objectives[1] > b.objectives[1];
  }));
}

Search small(std::uint64_t seed) {
  Search search;
  search.axes = 5;
  search.evaluations = 800;
  search.seed = seed;
  search.evaluate = [](std::span<const double> place) {
    return planted(place[0], (place[1] + place[2] + place[3] + place[4]) / 4);
  };
  return search;
}

bool equal(const std::vector<Candidate>& a, const std::vector<Candidate>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Candidate& x, const Candidate& y) {
    return x.place == y.place && x.objectives == y.objectives;
  });
}

TEST(Search, theSameSeedFindsTheSameBitsAndAnotherOneDoesNot) {
  const std::vector<Candidate> first = frontOf(small(7));
  EXPECT_TRUE(equal(first, frontOf(small(7))));
  EXPECT_FALSE(equal(first, frontOf(small(8))));
}

TEST(Search, joinsFrontsIntoOneThatNoneBeats) {
  const std::vector<Candidate> a = frontOf(small(1)), b = frontOf(small(2));
  const std::vector<Candidate> both = joined(a, b);
  EXPECT_GE(areaOf(both), std::max(areaOf(a), areaOf(b)));
  for (const Candidate& x : both)
    for (const std::vector<Candidate>* list : {&a, &b})
      for (const Candidate& y : *list)
        EXPECT_FALSE(y.objectives[0] < x.objectives[0] && y.objectives[1] < x.objectives[1]);
  EXPECT_TRUE(equal(joined(both, a), both)) << "twice the same is once";
}

TEST(Search, whatIsNoNumberNeverWins) {
  Search search = small(3);
  search.evaluate = [](std::span<const double> place) {
    if (place[0] < 0.5) return Objectives{std::numeric_limits<double>::quiet_NaN(), 0};
    if (place[1] < 0.2) return Objectives{0, -std::numeric_limits<double>::infinity()};
    return Objectives{place[0], 1 - place[0]};
  };
  const std::vector<Candidate> front = frontOf(search);
  ASSERT_FALSE(front.empty());
  for (const Candidate& candidate : front) EXPECT_GE(candidate.place[0], 0.5);
}

/// A front of so many presets from 10 to 30 ms.
std::vector<Candidate> evenFront(std::size_t count) {
  std::vector<Candidate> front;
  for (std::size_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    front.push_back({{part}, {10 + 20 * part, 0.05 - 0.04 * part}});
  }
  return front;
}

TEST(Candidates, lieEvenlyAroundTheLimit) {
  Plan plan;
  plan.budgetMs = 20;
  const std::vector<Candidate> drawn = chosen(plan, evenFront(1000), 4, 0.7, 1.3);
  ASSERT_EQ(drawn.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(drawn[i].objectives[0], 20 * (0.7 + 0.2 * static_cast<double>(i)), 0.05);
  plan.budgetMs.reset();
  plan.maxError = 0.03;
  const std::vector<Candidate> exact = chosen(plan, evenFront(1000), 2, 0.8, 1.05);
  EXPECT_NEAR(exact[0].objectives[1], 1.05 * 0.03, 1e-4);
  EXPECT_NEAR(exact[1].objectives[1], 0.8 * 0.03, 1e-4);
}

TEST(Candidates, areAsManyAsAskedForWhereTheFrontIsSparse) {
  Plan plan;
  for (const bool limited : {true, false})
    for (const double budgetMs : {1.0, 12.0, 20.0, 100.0})
      for (std::size_t size = 2; size < 12; ++size)
        for (std::size_t count = 1; count < 12; ++count) {
          plan.budgetMs = limited ? std::optional(budgetMs) : std::nullopt;
          const std::vector<Candidate> drawn = chosen(plan, evenFront(size), count, 0.7, 1.3);
          ASSERT_EQ(drawn.size(), std::min(count, size)) << budgetMs << " ms, " << count << " of " << size;
          for (std::size_t i = 1; i < drawn.size(); ++i)
            EXPECT_GT(drawn[i].objectives[0], drawn[i - 1].objectives[0]) << "each once";
        }
  EXPECT_TRUE(chosen(plan, {}, 3, 0.7, 1.3).empty());
}

TEST(Search, endsWhenItIsAsked) {
  Search search = small(3);
  int generations = 0;
  search.progress = [&](double) { return ++generations < 4; };
  EXPECT_FALSE(frontOf(search).empty());
  EXPECT_EQ(generations, 4);
}

}  // namespace
}  // namespace trimtab::tune
