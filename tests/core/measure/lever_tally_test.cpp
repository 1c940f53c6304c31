#include "trimtab/measure/lever_tally.h"

#include <gtest/gtest.h>

#include <cmath>

namespace trimtab {
namespace {

TEST(LeverTally, countsWhoChangedEachLeverLastWithTheMeansOfWhatWasAskedAndDrawn) {
  LeverTally tally;
  EXPECT_TRUE(std::isnan(tally.drawnMean(0)));
  LeverChain plain, ruled, held;
  ruled.policy.errorPx = ruled.drawn.errorPx = 4;
  held.drawn.errorPx = 8;
  held.weather.farM = held.policy.farM = held.drawn.farM = 1000;
  for (const LeverChain* chain : {&plain, &ruled, &held, &held}) tally.add(*chain);
  EXPECT_EQ(tally.images(), 4u);
  EXPECT_EQ(tally.changedBy(0, LeverStep::preset), 1u);
  EXPECT_EQ(tally.changedBy(0, LeverStep::policy), 1u);
  EXPECT_EQ(tally.changedBy(0, LeverStep::budget), 2u);
  EXPECT_DOUBLE_EQ(tally.askedMean(0), (2 + 4 + 2 + 2) / 4.0);
  EXPECT_DOUBLE_EQ(tally.drawnMean(0), (2 + 4 + 8 + 8) / 4.0);
  EXPECT_EQ(kFrameLeverRows[3].key, "far_distance");
  EXPECT_EQ(tally.changedBy(3, LeverStep::weather), 2u);
  EXPECT_TRUE(std::isinf(tally.drawnMean(3))) << "some images had no far distance";
}

}  // namespace
}  // namespace trimtab
