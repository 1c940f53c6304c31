#include "app/harness/answer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "app/harness/text.h"
#include "tests/core/measure/noisy_machine.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::harness {
namespace {

using testing::HasSubstr;

/// A unit of a hundred frames: `over` of them take 20 ms, the others 10 ms.
Unit unitOf(const char* preset, int over, double flip, const char* method = "proposed") {
  Unit unit;
  unit.name = {"circuit", preset, method};
  for (int i = 0; i < 100; ++i) {
    MeasuredFrame frame;
    frame.row = static_cast<std::size_t>(i);
    frame.cost.total = i < over ? 20 : 10;
    frame.repeatsMs = {frame.cost.total};
    frame.error.flip = flip;
    frame.error.geometricMaxPx = i == 7 ? 3 : 1;
    frame.error.pop = i < 10 ? 0.5 : 0.1;
    unit.frames.push_back(frame);
  }
  return unit;
}

Unit timesScaled(Unit unit, double by) {
  for (MeasuredFrame& frame : unit.frames) {
    frame.cost.total *= by;
    for (double& ms : frame.repeatsMs) ms *= by;
  }
  return unit;
}

Results resultsOf(std::vector<Unit> units, double budgetMs = 16.7) {
  Results results;
  results.widthPx = 640;
  results.heightPx = 360;
  results.repeats = 1;
  results.budgetMs = budgetMs;
  results.units = std::move(units);
  return results;
}

std::vector<std::string> bestOf(const Answer& answer) {
  std::vector<std::string> names;
  for (const std::size_t row : answer.best) names.push_back(answer.rows[row].name.preset);
  return names;
}

using Names = std::vector<std::string>;

TEST(Answer, fitsIfTheFramesAreSureOfItAndMayFitIfTheyDoNotTell) {
  struct Case {
    int over;
    Fit fit;
  };
  // Ranks of the bounds of a 95th percentile of a hundred samples, from tables of the binomial distribution.
  for (const Case& c : {Case{0, Fit::yes},
                        {1, Fit::yes},
                        {2, Fit::unsure},
                        {9, Fit::unsure},
                        {10, Fit::no},
                        {100, Fit::no}}) {
    const AnswerRow row = answerRow(unitOf("default", c.over, 0.01), 16.7);
    EXPECT_DOUBLE_EQ(row.overShare, c.over / 100.0);
    EXPECT_EQ(row.fit, c.fit) << c.over;
    EXPECT_EQ(row.geometricPx, 3);
    EXPECT_EQ(row.pop, 0.5);
  }
  EXPECT_EQ(answerRow(unitOf("default", 0, 0.01), kNan).fit, Fit::no);
}

TEST(Answer, showsNoPercentileOfFewerFramesThanItNeeds) {
  Unit unit = unitOf("default", 0, 0.01);
  unit.frames.resize(99);
  EXPECT_TRUE(std::isnan(answerRow(unit, 16.7).p99Ms));
  EXPECT_EQ(answerRow(unit, 16.7).p95Ms, 10);
  unit.frames.resize(20);
  EXPECT_EQ(answerRow(unit, 16.7).p95Ms, 10);
  EXPECT_EQ(answerRow(unit, 16.7).fit, Fit::unsure) << "twenty frames below it are not 95 % of a flight";
  unit.frames.resize(19);
  EXPECT_TRUE(std::isnan(answerRow(unit, 16.7).p95Ms));
  const std::string text = toText(resultsOf({unit}));
  EXPECT_THAT(text, HasSubstr("A p95 needs 20 frames and a p99 100."));
  const auto summary = nlohmann::json::parse(toJson(resultsOf({unit})))["units"][0]["summary"];
  EXPECT_EQ(summary["p99_ms"], "nan");
  EXPECT_TRUE(summary["fits"].is_null());
}

TEST(Answer, theBestFitsAndHasTheSmallestFlip) {
  const Answer answer =
      answerOf(resultsOf({unitOf("fine", 40, 0), unitOf("coarse", 0, 0.0213), unitOf("middle", 1, 0.0112)}),
               "circuit", 16.7);
  ASSERT_EQ(answer.rows.size(), 3u);
  EXPECT_EQ(bestOf(answer), Names{"middle"});
  EXPECT_EQ(answer.why,
            "middle (proposed) is the best under 16.7 ms (FLIP 0.0112, p95 10 ms). coarse (proposed) follows "
            "with a FLIP of 0.0213.");
  EXPECT_EQ(verdictText(answer, 0), "over budget");
  EXPECT_EQ(verdictText(answer, 1), "fits");
  EXPECT_EQ(verdictText(answer, 2), "best");
}

TEST(Answer, identicalImagesAreRankedByTheTimeAloneAndOnlyWhereItDiffers) {
  const Unit none = timesScaled(unitOf("default", 0, 0.01, "none"), 1.3);
  const Answer faster = answerOf(resultsOf({none, unitOf("default", 0, 0.01)}), "circuit", 16.7);
  ASSERT_EQ(faster.best, std::vector<std::size_t>{1});
  EXPECT_THAT(faster.why,
              HasSubstr("default (none) follows: its FLIP does not differ, and its frames are 30 % "
                        "slower."));
  const Answer equal = answerOf(resultsOf({unitOf("a", 0, 0.01), unitOf("b", 0, 0.01), unitOf("c", 0, 0.01)}),
                                "circuit", 16.7);
  EXPECT_EQ(bestOf(equal), (Names{"a", "b", "c"}));
  EXPECT_EQ(equal.why,
            "a (proposed), b (proposed) and c (proposed) do not differ, and are the best under 16.7 "
            "ms (FLIP 0.01, p95 10 ms).");
  EXPECT_EQ(verdictText(equal, 2), "one of the best");
}

TEST(Answer, aDifferenceOfFlipThatNobodyReadsLeavesItToTheTime) {
  const Unit slow = timesScaled(unitOf("slow", 0, 0.011201), 1.2);
  EXPECT_EQ(bestOf(answerOf(resultsOf({slow, unitOf("quick", 0, 0.011204)}), "circuit", 16.7)),
            Names{"quick"});
}

TEST(Answer, aPresetThatDiffersInAFewFramesIsToldApart) {
  Unit ruled = unitOf("ruled", 0, 0.01);
  for (std::size_t i = 40; i < 55; ++i) ruled.frames[i].error.flip = 0.02;
  const Answer answer = answerOf(resultsOf({ruled, unitOf("plain", 0, 0.01)}), "circuit", 16.7);
  EXPECT_EQ(bestOf(answer), Names{"plain"}) << answer.why;
}

TEST(Answer, saysWhoComesClosestIfNoneFitsAndNamesNoBest) {
  const Results results = resultsOf({unitOf("fine", 40, 0), unitOf("coarse", 100, 0.02)});
  const Answer answer = answerOf(results, "circuit", 16.7);
  EXPECT_TRUE(answer.best.empty());
  EXPECT_THAT(answer.why, HasSubstr("fine (proposed) comes closest, with 40 % of its frames over it."));
  EXPECT_TRUE(answerOf(results, "another flight", 16.7).best.empty());
  EXPECT_TRUE(answerOf(resultsOf({unitOf("fine", 0, 0)}), "circuit", kNan).best.empty());
}

TEST(Answer, whatMayFitIsSaidApartAndIsTheBestOnlyWhereNothingSurelyFits) {
  const Unit maybe = timesScaled(unitOf("maybe", 5, 0.005), 1.1);
  const Answer sure = answerOf(resultsOf({maybe, unitOf("sure", 0, 0.02)}), "circuit", 16.7);
  EXPECT_EQ(bestOf(sure), Names{"sure"});
  EXPECT_THAT(
      sure.why,
      HasSubstr("Nothing else surely fits. Whether maybe (proposed) fits cannot be told from 100 frames."));
  EXPECT_EQ(verdictText(sure, 0), "may fit");
  const Answer open = answerOf(resultsOf({maybe, unitOf("over", 50, 0.001)}), "circuit", 16.7);
  EXPECT_EQ(bestOf(open), Names{"maybe"});
  EXPECT_THAT(open.why, HasSubstr("is not sure of it: measure more frames."));
  EXPECT_EQ(verdictText(open, 0), "best, may fit");
}

TEST(Answer, aBudgetBetweenTwoThatDoNotDifferDoesNotMakeThemDiffer) {
  Unit other = unitOf("other", 0, 0.01);
  std::swap(other.frames[0].cost, other.frames[1].cost);
  other.frames[0].cost.total = other.frames[1].cost.total = 20;
  const Answer answer = answerOf(resultsOf({unitOf("one", 0, 0.01), other}), "circuit", 16.7);
  ASSERT_EQ(answer.rows[0].fit, Fit::yes);
  ASSERT_EQ(answer.rows[1].fit, Fit::unsure);
  EXPECT_EQ(bestOf(answer), (Names{"one", "other"}));
}

TEST(Answer, aUnitWithoutTimesOrFlipIsNeverBetterThanAMeasuredOne) {
  Unit timeless = unitOf("timeless", 0, 0);
  for (MeasuredFrame& frame : timeless.frames) {
    frame.cost.total = kNan;
    frame.repeatsMs.clear();
  }
  const Answer answer =
      answerOf(resultsOf({timeless, unitOf("blind", 0, kNan), unitOf("seen", 0, 0.5)}), "circuit", 16.7);
  EXPECT_EQ(bestOf(answer), Names{"seen"});
  EXPECT_EQ(answer.rows[0].fit, Fit::no);
  EXPECT_TRUE(std::isnan(answer.rows[0].overShare));
}

TEST(Answer, ofFewFramesSaysThatTheyDoNotTellPresetsApart) {
  Results results = resultsOf({unitOf("a", 0, 0.01), timesScaled(unitOf("b", 0, 0.02), 1.2)});
  for (Unit& unit : results.units) unit.frames.resize(5);
  const Answer answer = answerOf(results, "circuit", 16.7);
  EXPECT_EQ(answer.best.size(), 2u);
  EXPECT_THAT(answer.why, HasSubstr("cannot be told apart by so few frames"));
}

TEST(Answer, saysIfTheMachineWasBusy) {
  Results results = resultsOf({unitOf("default", 0, 0.01)});
  results.othersShare = 0.02;
  EXPECT_THAT(toText(results), Not(HasSubstr("busy")));
  results.othersShare = 0.63;
  for (const std::string& report : {toText(results), toJson(results)})
    EXPECT_THAT(report, HasSubstr("The machine was busy: other programs took 63 % of its processors"));
  const auto read = parseResults(toJson(results), "results.json");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ(read->othersShare, 0.63);
}

/// What a run of `bench` makes of presets on a noisy machine: all of them draw in turns, frame by frame.
struct Noisy {
  std::string preset;
  double time = 1, flip = 1;   ///< factors on those of the plain preset
  std::size_t firesEvery = 1;  ///< the factor of FLIP counts in one of so many frames
  double flipNoise = 0;        ///< of a measurement, because load reaches a policy
};
Results noisyResults(const std::vector<Noisy>& presets, double budgetMs, test::NoisyMachine& machine,
                     std::mt19937_64& random) {
  constexpr std::size_t kFrames = 60, kRepeats = 5;
  std::normal_distribution<double> normal(0, 1);
  std::vector<Unit> units;
  for (const Noisy& preset : presets)
    units.push_back({{"circuit", preset.preset, "proposed"}, {}, {}, {}, 0, {}});
  for (std::size_t i = 0; i < kFrames; ++i) {
    const double ms = 9 + 3 * std::sin(0.2 * double(i)), flip = 0.01 + 0.004 * std::sin(0.07 * double(i));
    for (std::size_t u = 0; u < units.size(); ++u) {
      MeasuredFrame frame;
      frame.row = i;
      frame.error.flip = flip * (i % presets[u].firesEvery == 0 ? presets[u].flip : 1) *
                         (1 + presets[u].flipNoise * normal(random));
      units[u].frames.push_back(frame);
    }
    for (std::size_t repeat = 0; repeat < kRepeats; ++repeat)
      for (std::size_t n = 0; n < units.size(); ++n) {
        const std::size_t u = (n + repeat + i) % units.size();
        units[u].frames[i].repeatsMs.push_back(ms * presets[u].time * machine.next());
      }
    for (Unit& unit : units) unit.frames[i].cost.total = quantileOf(unit.frames[i].repeatsMs, 0.5);
  }
  return resultsOf(std::move(units), budgetMs);
}

/// Returns in how many of a hundred runs the answer is `as` expected.
int ofAHundred(const std::vector<Noisy>& presets, double budgetMs,
               const std::function<bool(const Answer&)>& as) {
  test::NoisyMachine machine(5);
  std::mt19937_64 random(6);
  int count = 0;
  for (int run = 0; run < 100; ++run)
    count += as(answerOf(noisyResults(presets, budgetMs, machine, random), "circuit", budgetMs));
  return count;
}

TEST(AnswerOnANoisyMachine, ofAHundredRepeatsOfOnePresetAgainstItselfAtMostTenDiffer) {
  const auto differ = [](const Answer& answer) { return answer.isBest(0) != answer.isBest(1); };
  // Far below the budget, close to it on either side, and far above.
  for (const double budgetMs : {30.0, 18.0, 14.0, 12.5, 5.0})
    for (const double flipNoise : {0.0, 0.05}) {
      const Noisy one{"one", 1, 1, 1, flipNoise}, same{"same", 1, 1, 1, flipNoise};
      EXPECT_LE(ofAHundred({one, same}, budgetMs, differ), 10) << budgetMs << ", " << flipNoise;
    }
}

TEST(AnswerOnANoisyMachine, ofAHundredRepeatsOfOnePresetUnderSevenNamesAtMostTenDiffer) {
  std::vector<Noisy> presets;
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g"}) presets.push_back({name});
  const auto differ = [&](const Answer& answer) { return answer.best.size() != presets.size(); };
  EXPECT_LE(ofAHundred(presets, 30, differ), 10);
}

TEST(AnswerOnANoisyMachine, presetsThatDifferAreToldApartInAtLeastNinetyOfAHundred) {
  const auto plainIsBest = [](const Answer& answer) { return bestOf(answer) == Names{"plain"}; };
  EXPECT_GE(ofAHundred({{"slower", 1.1}, {"plain"}}, 30, plainIsBest), 90) << "a tenth slower";
  EXPECT_GE(ofAHundred({{"coarser", 0.9, 1.05}, {"plain"}}, 30, plainIsBest), 90) << "faster, at more FLIP";
  EXPECT_GE(ofAHundred({{"ruled", 0.9, 1.5, 4}, {"plain"}}, 30, plainIsBest), 90) << "in a quarter of frames";
}

TEST(Answer, isInTheFileAndInTheTextAndTheFileReadsBack) {
  const Results results = resultsOf({unitOf("default", 1, 0.01), unitOf("same", 1, 0.01)});
  const std::string json = toJson(results);
  const auto document = nlohmann::json::parse(json);
  EXPECT_EQ(document["answers"][0]["best"]["preset"], "default");
  EXPECT_EQ(document["answers"][0]["equal"][0]["preset"], "same");
  const auto& summary = document["units"][0]["summary"];
  EXPECT_DOUBLE_EQ(summary["over_budget_share"].get<double>(), 0.01);
  EXPECT_EQ(summary["p95_low_ms"], 10);
  EXPECT_EQ(summary["p95_high_ms"], 10);
  EXPECT_EQ(summary["p99_ms"], 10);
  EXPECT_EQ(summary["fits"], true);
  EXPECT_EQ(summary["pop_p95"], 0.5);
  const auto read = parseResults(json, "results.json");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ(toJson(*read), json);
  const std::string text = toText(results);
  EXPECT_THAT(text, HasSubstr("over budget %"));
  EXPECT_THAT(text, HasSubstr("one of the best"));
  EXPECT_THAT(text,
              HasSubstr("circuit: default (proposed) and same (proposed) do not differ, and are the best "
                        "under 16.7 ms"));
}

}  // namespace
}  // namespace trimtab::harness
