#include "trimtab/measure/machine_watch.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

namespace trimtab {
namespace {

using namespace std::chrono_literals;

constexpr auto kLong = 1500ms;

/// Runs `meanwhile` while so many threads of this process work without a pause.
template <class Meanwhile>
void whileWorking(unsigned threads, const Meanwhile& meanwhile) {
  std::atomic<bool> stop = false;
  std::vector<std::jthread> workers;
  for (unsigned i = 0; i < threads; ++i)
    workers.emplace_back([&stop] {
      while (!stop) std::atomic_signal_fence(std::memory_order_seq_cst);
    });
  meanwhile();
  stop = true;
}

unsigned processors() {
  return std::max(1u, std::thread::hardware_concurrency());
}

TEST(ProcessorTime, isReadFromTheFirstLineOfTheSystemsCounts) {
  const auto time = parseProcessorTime("cpu  100 20 30 400 50 6 7 8 90 10\ncpu0 1 2 3 4 5 6 7 8 9 10\n");
  ASSERT_TRUE(time);
  EXPECT_EQ(time->all, 621u) << "the guests' time is part of the users'";
  EXPECT_EQ(time->busy, 171u) << "waiting for a disk leaves the processor to others";
  for (const char* bad :
       {"", "cpu", "cpu0 1 2 3 4 5 6 7 8", "cpu 1 2 3 4 5 6 7", "cpu 1 2 x 4 5 6 7 8", "intr 1"})
    EXPECT_FALSE(parseProcessorTime(bad)) << bad;
}

TEST(MachineWatch, countsWhatNeitherIdledNorWasOurs) {
  const ProcessorTime before{1000, 500, 100};
  EXPECT_DOUBLE_EQ(othersShare(before, {1400, 700, 200}), 0.25);
  EXPECT_DOUBLE_EQ(othersShare(before, {1400, 600, 200}), 0) << "all of it was ours";
  EXPECT_DOUBLE_EQ(othersShare(before, {1400, 600, 260}), 0) << "clocks that do not agree";
  EXPECT_TRUE(std::isnan(othersShare(before, {1099, 599, 100}))) << "too short to tell";
  EXPECT_TRUE(std::isnan(othersShare(before, {900, 400, 100}))) << "the counts went back";
}

TEST(MachineWatch, saysBusyAboveATenthAndNothingOtherwise) {
  EXPECT_FALSE(isBusy(0.1));
  EXPECT_TRUE(isBusy(0.11));
  EXPECT_FALSE(isBusy(std::nan("")));
  EXPECT_TRUE(busyText(0.05).empty());
  EXPECT_TRUE(busyText(std::nan("")).empty());
  EXPECT_NE(busyText(0.634).find("63 %"), std::string::npos) << busyText(0.634);
}

TEST(MachineWatch, seesAnotherProgramAtWork) {
  const MachineWatch watch;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    whileWorking(processors(), [] { std::this_thread::sleep_for(10 * kLong); });
    _exit(0);
  }
  std::this_thread::sleep_for(kLong);
  const double share = watch.othersShare();
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  if (std::isnan(share)) GTEST_SKIP() << "the system does not say what its processors do";
  EXPECT_TRUE(isBusy(share)) << share;
}

TEST(MachineWatch, countsNoPause) {
  const MachineWatch watch;
  unwatched([] { std::this_thread::sleep_for(kLong); });
  EXPECT_TRUE(std::isnan(watch.othersShare())) << "too little of its time has passed";
}

TEST(MachineWatch, doesNotTakeTheWorkOfThisProgramForThatOfOthers) {
  const MachineWatch watch;
  double share = 0;
  // So many threads get most of the processors even on a machine that is busy.
  whileWorking(16 * processors(), [&] {
    std::this_thread::sleep_for(kLong);
    share = watch.othersShare();
  });
  if (std::isnan(share)) GTEST_SKIP() << "the system does not say what its processors do";
  EXPECT_LT(share, 0.8);
}

}  // namespace
}  // namespace trimtab
