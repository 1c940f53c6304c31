#include "app/experiment/head_motion_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/measure/noisy_machine.h"

namespace trimtab::experiment {
namespace {

using testing::HasSubstr;

constexpr int kImages = 200;

/// Modes whose images take as much as `timesOf` says, drawn in turns on a noisy machine.
MotionRuns noisyRuns(test::NoisyMachine& machine, int passes, const MotionRuns& timesOf) {
  MotionRuns runs;
  for (MotionRun& run : runs) run.ms.resize(kImages);
  for (int pass = 0; pass < passes; ++pass)
    for (std::size_t m = 0; m < runs.size(); ++m)
      for (std::size_t i = 0; i < kImages; ++i)
        runs[m].ms[i].push_back(timesOf[m].ms[i].front() * machine.next());
  return runs;
}

/// All modes take 8 ms, those with a mechanism `factor` of it, in images from 100 on twice as much.
MotionRuns timesOf(double factor) {
  MotionRuns runs;
  for (std::size_t m = 0; m < runs.size(); ++m)
    for (int i = 0; i < kImages; ++i) runs[m].ms.push_back({(i < 100 ? 8 : 16) * (m == 0 ? 1 : factor)});
  return runs;
}

int ofAHundred(int passes, double factor, const char* verdict) {
  test::NoisyMachine machine(9);
  int count = 0;
  for (int run = 0; run < 100; ++run) {
    const MotionRuns runs = noisyRuns(machine, passes, timesOf(factor));
    count += gainText("levels", runs[0], runs[2], 0, kImages).find(verdict) != std::string::npos;
  }
  return count;
}

TEST(HeadMotionVerdict, ofIdenticalScenesShowsADifferenceInAtMostTenOfAHundred) {
  for (const int passes : {6, 9})
    EXPECT_GE(ofAHundred(passes, 1, "Over levels the passes show no difference"), 90);
}

TEST(HeadMotionVerdict, ofAGainHoldsAndOfALossDoesNot) {
  MotionRuns steady = timesOf(1 / 1.7);
  for (MotionRun& run : steady)
    for (auto& image : run.ms) image.resize(6, image.front());
  EXPECT_THAT(
      gainText("levels", steady[0], steady[2], 0, kImages),
      HasSubstr("the gain holds: with restoration the smallest rate of the sweep is 1.70 times (1.70 to "
                "1.70) that of before"));
  EXPECT_THAT(gainText("levels", steady[2], steady[0], 0, kImages), HasSubstr("the gain does not hold"));
}

TEST(HeadMotionVerdict, ofFewPassesIsThatTheyDoNotTell) {
  EXPECT_EQ(ofAHundred(1, 0.3, "the passes are too few to tell whether the gain holds"), 100);
  EXPECT_EQ(ofAHundred(5, 0.3, "the passes are too few to tell whether the gain holds"), 100);
}

TEST(HeadMotionVerdict, countsRapidDropsByPassAndCallsNoiseNoDifference) {
  test::NoisyMachine machine(4);
  int differ = 0;
  for (int run = 0; run < 100; ++run)
    differ += rapidDropsText("levels", noisyRuns(machine, 9, timesOf(1))).find("show no difference") ==
              std::string::npos;
  EXPECT_LE(differ, 10);
  MotionRuns runs = timesOf(1);
  for (MotionRun& run : runs)
    for (auto& image : run.ms) image.resize(6, image.front());
  EXPECT_EQ(rapidDrops(runs[1]), std::vector<double>(6, 1)) << "from 8 to 16 ms";
  for (auto& image : runs[2].ms) image.assign(6, 8);
  EXPECT_THAT(rapidDropsText("levels", runs),
              HasSubstr("restoration leaves fewer rapid drops of the rate: 0 with it, "
                        "1 without (difference -1, -1 to -1)"));
}

}  // namespace
}  // namespace trimtab::experiment
