#include "app/harness/answer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/harness/text.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::harness {
namespace {

/// A unit of a hundred frames: `over` of them take 20 ms, the others 10 ms.
Unit unitOf(const char* preset, int over, double flip, const char* method = "proposed") {
  Unit unit;
  unit.name = {"circuit", preset, method};
  for (int i = 0; i < 100; ++i) {
    MeasuredFrame frame;
    frame.row = static_cast<std::size_t>(i);
    frame.cost.total = i < over ? 20 : 10;
    frame.error.flip = flip;
    frame.error.geometricMaxPx = i == 7 ? 3 : 1;
    frame.error.pop = i < 10 ? 0.5 : 0.1;
    unit.frames.push_back(frame);
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

TEST(Answer, countsWhatIsOverTheBudgetAndFitsToTheTwentiethFrame) {
  struct Case {
    int over;
    bool fits;
  };
  for (const Case& c : {Case{0, true}, {4, true}, {5, true}, {6, false}, {100, false}}) {
    const AnswerRow row = answerRow(unitOf("default", c.over, 0.01), 16.7);
    EXPECT_DOUBLE_EQ(row.overShare, c.over / 100.0);
    EXPECT_EQ(row.fits, c.fits) << c.over;
    EXPECT_EQ(row.geometricPx, 3);
    EXPECT_EQ(row.pop, 0.5);
  }
}

TEST(Answer, theBestFitsAndHasTheSmallestFlip) {
  const Answer answer =
      answerOf(resultsOf({unitOf("fine", 40, 0), unitOf("coarse", 0, 0.0213), unitOf("middle", 3, 0.0112)}),
               "circuit", 16.7);
  ASSERT_EQ(answer.rows.size(), 3u);
  ASSERT_TRUE(answer.best);
  EXPECT_EQ(answer.rows[*answer.best].name.preset, "middle");
  EXPECT_EQ(
      answer.why,
      "middle (proposed) is the best under 16.7 ms: 97 % of its frames are within it (p95 10 ms). It has the "
      "smallest FLIP of the 2 that fit, 0.0112; coarse (proposed) follows with 0.0213.");
}

TEST(Answer, aDifferenceOfFlipThatNobodyReadsLeavesItToTheTime) {
  Unit slow = unitOf("slow", 0, 0.011201);
  for (MeasuredFrame& frame : slow.frames) frame.cost.total = 12;
  const Answer answer = answerOf(resultsOf({slow, unitOf("quick", 0, 0.011204)}), "circuit", 16.7);
  ASSERT_TRUE(answer.best);
  EXPECT_EQ(answer.rows[*answer.best].name.preset, "quick");
  EXPECT_NE(answer.why.find("shortest p95"), std::string::npos) << answer.why;
}

TEST(Answer, saysWhoComesClosestIfNoneFitsAndNamesNoBest) {
  const Results results = resultsOf({unitOf("fine", 40, 0), unitOf("coarse", 100, 0.02)});
  const Answer answer = answerOf(results, "circuit", 16.7);
  EXPECT_FALSE(answer.best);
  EXPECT_NE(answer.why.find("fine (proposed) comes closest, with a p95 of 20 ms and 40 % of its frames"),
            std::string::npos)
      << answer.why;
  EXPECT_FALSE(answerOf(results, "another flight", 16.7).best);
  EXPECT_FALSE(answerOf(resultsOf({unitOf("fine", 0, 0)}), "circuit", kNan).best);
}

TEST(Answer, aUnitWithoutTimesOrFlipIsNeverBetterThanAMeasuredOne) {
  Unit timeless = unitOf("timeless", 0, 0);
  for (MeasuredFrame& frame : timeless.frames) frame.cost.total = kNan;
  const Answer answer =
      answerOf(resultsOf({timeless, unitOf("blind", 0, kNan), unitOf("seen", 0, 0.5)}), "circuit", 16.7);
  ASSERT_TRUE(answer.best);
  EXPECT_EQ(answer.rows[*answer.best].name.preset, "seen");
  EXPECT_FALSE(answer.rows[0].fits);
  EXPECT_TRUE(std::isnan(answer.rows[0].overShare));
}

TEST(Answer, isInTheFileAndInTheTextAndTheFileReadsBack) {
  const Results results = resultsOf({unitOf("default", 3, 0.01)});
  const std::string json = toJson(results);
  const auto document = nlohmann::json::parse(json);
  EXPECT_EQ(document["answers"][0]["best"]["preset"], "default");
  const auto& summary = document["units"][0]["summary"];
  EXPECT_DOUBLE_EQ(summary["over_budget_share"].get<double>(), 0.03);
  EXPECT_EQ(summary["p99_ms"], 20);
  EXPECT_EQ(summary["pop_p95"], 0.5);
  const auto read = parseResults(json, "results.json");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ(toJson(*read), json);
  const std::string text = toText(results);
  EXPECT_NE(text.find("over budget %"), std::string::npos);
  EXPECT_NE(text.find("circuit: default (proposed) is the best under 16.7 ms"), std::string::npos) << text;
}

}  // namespace
}  // namespace trimtab::harness
