#include "trimtab/terrain/format/pager.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/core/terrain/bake/slow_patches.h"

namespace trimtab::terrain {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
constexpr std::size_t kAll = ~std::size_t{0};

class PagerOf : public testing::Test {
 protected:
  static std::shared_ptr<const PatchTerrain> patches() {
    static const auto terrain = test::smallPatches(1100, 800);
    return terrain;
  }
  static std::uint32_t pages() { return static_cast<std::uint32_t>(patches()->index().pages.size()); }
  static std::vector<PageWant> wants(std::vector<std::uint32_t> numbers) {
    std::vector<PageWant> result;
    float error = 1000;
    for (const std::uint32_t page : numbers) result.push_back({page, error -= 1});
    return result;
  }
  /// Until so many have come, for no longer than a test may take.
  std::vector<std::uint32_t> take(std::size_t count) {
    std::vector<std::uint32_t> numbers;
    for (const auto end = Clock::now() + 20s; numbers.size() < count && Clock::now() < end;) {
      for (const auto& page : pager->takeArrived(kAll)) numbers.push_back(page->page);
      std::this_thread::sleep_for(1ms);
    }
    return numbers;
  }
  /// Until a read has begun, for no longer than a test may take, and the other threads had time to begin
  /// theirs.
  void wantAndAwaitReads(const std::vector<PageWant>& wanted) {
    const int before = slow->begun;
    pager->want(wanted);
    for (int ms = 0; slow->begun == before && ms < 20'000; ++ms) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(50ms);
  }
  void start(std::chrono::milliseconds delay) {
    slow = std::make_shared<test::SlowPatches>(patches(), delay);
    pager = Pager::start(slow);
  }
  std::shared_ptr<test::SlowPatches> slow;
  std::unique_ptr<Pager> pager;
};

TEST_F(PagerOf, bringsWhatIsWantedAsItIsOnDisk) {
  start(0ms);
  ASSERT_GT(pages(), 10u);
  std::vector<std::uint32_t> all(pages());
  std::iota(all.begin(), all.end(), 0u);
  pager->want(wants(all));
  std::size_t bytes = 0, fileBytes = 0;
  std::vector<std::uint32_t> got;
  for (const auto end = Clock::now() + 20s; got.size() < all.size() && Clock::now() < end;) {
    for (const auto& page : pager->takeArrived(kAll)) {
      got.push_back(page->page);
      const auto expected = patches()->readPage(page->page);
      ASSERT_TRUE(expected);
      ASSERT_EQ(page->bytes(), expected->bytes());
      ASSERT_EQ(page->patches.size(), expected->patches.size());
      for (std::size_t i = 0; i < page->patches.size(); ++i)
        ASSERT_EQ(page->patches[i].indices, expected->patches[i].indices);
      bytes += page->bytes();
      fileBytes += patches()->pageBytes(page->page);
    }
  }
  std::sort(got.begin(), got.end());
  EXPECT_EQ(got, all);
  EXPECT_GT(bytes, 0u);
  const Pager::Counters counters = pager->counters();
  EXPECT_EQ(counters.pagesRead, pages());
  EXPECT_EQ(counters.bytesRead, fileBytes);
  EXPECT_EQ(counters.waiting, 0u);
  EXPECT_EQ(counters.failed, 0u);
}

TEST_F(PagerOf, readsTheMostUrgentFirst) {
  start(15ms);
  // Given from the least urgent on; the first may be on its way before anything else is known.
  std::vector<PageWant> wanted;
  for (std::uint32_t page = 0; page < 9; ++page) wanted.push_back({page, 1.0f + static_cast<float>(page)});
  pager->want(wanted);
  ASSERT_EQ(take(9).size(), 9u);
  std::vector<std::uint32_t> order = slow->read();
  // Two may be read at a time, and overtake each other.
  for (std::size_t i = 0; i + 2 < order.size(); ++i) EXPECT_GT(order[i], order[i + 2]);
}

TEST_F(PagerOf, keepsNoCallerWaitingForASlowDisk) {
  start(150ms);
  slow->held = true;
  std::vector<std::uint32_t> all(pages());
  std::iota(all.begin(), all.end(), 0u);
  wantAndAwaitReads(wants(all));
  for (int i = 0; i < 200; ++i) {
    pager->want(wants(all));
    EXPECT_TRUE(pager->takeArrived(kAll).empty());
    EXPECT_GT(pager->counters().waiting, 0u);
    EXPECT_TRUE(pager->failures().empty());
  }
  EXPECT_TRUE(slow->read().empty()) << "a call waited until a read had ended";
  slow->held = false;
  EXPECT_GE(take(2).size(), 2u);
  EXPECT_GE(pager->counters().longestReadMs, 150);
}

TEST_F(PagerOf, itsThreadsGiveWayToWhoDraws) {
  const int own = ::getpriority(PRIO_PROCESS, 0);
  start(0ms);
  pager->want(wants({1, 2, 3}));
  EXPECT_EQ(take(3).size(), 3u);
  EXPECT_GE(slow->niceness, std::min(own + 10, 19));
  pager->waitFor(std::vector<std::uint32_t>{4});
  EXPECT_EQ(::getpriority(PRIO_PROCESS, 0), own) << "who waits stays as it is";
}

TEST_F(PagerOf, readsNothingThatIsNoLongerWanted) {
  start(20ms);
  slow->held = true;
  std::vector<std::uint32_t> first, then{pages() - 1, pages() - 2};
  for (std::uint32_t page = 0; page + 2 < pages(); ++page) first.push_back(page);
  wantAndAwaitReads(wants(first));
  pager->want(wants(then));
  const auto inHand = static_cast<std::size_t>(slow->begun);
  slow->held = false;
  const auto got = take(2);
  EXPECT_EQ(std::set<std::uint32_t>(got.begin(), got.end()),
            std::set<std::uint32_t>(then.begin(), then.end()))
      << "what had arrived and is not wanted now is given up";
  EXPECT_LE(slow->read().size(), inHand + then.size());

  slow->held = true;
  wantAndAwaitReads(wants(first));
  pager->want({});
  const int begun = slow->begun;
  slow->held = false;
  std::this_thread::sleep_for(120ms);
  EXPECT_EQ(slow->begun, begun);
}

TEST_F(PagerOf, canReadAPageAgainThatWasTaken) {
  start(0ms);
  for (int i = 0; i < 3; ++i) {
    pager->want(wants({3}));
    ASSERT_EQ(take(1), std::vector<std::uint32_t>{3});
    pager->want({});
  }
}

TEST_F(PagerOf, givesNoMoreAtATimeThanIsAskedForButOne) {
  start(0ms);
  const std::vector<std::uint32_t> numbers{1, 2, 3, 4, 5, 6};
  pager->want(wants(numbers));
  pager->waitFor(numbers);
  std::size_t left = numbers.size();
  auto one = pager->takeArrived(1);
  ASSERT_EQ(one.size(), 1u);
  --left;
  const std::size_t room = patches()->readPage(1)->bytes() * 2;
  while (left > 0) {
    const auto some = pager->takeArrived(room);
    ASSERT_FALSE(some.empty());
    std::size_t bytes = 0;
    for (const auto& page : some) bytes += page->bytes();
    EXPECT_TRUE(bytes <= room || some.size() == 1);
    left -= some.size();
  }
  EXPECT_TRUE(pager->takeArrived(kAll).empty());
}

TEST_F(PagerOf, waitsUntilPagesAreThereWhetherTheyWereWantedOrNot) {
  start(5ms);
  pager->want(wants({7, 8, 9, 10}));
  const std::vector<std::uint32_t> needed{0, 5, 9};
  pager->waitFor(needed);
  std::set<std::uint32_t> got;
  for (const auto& page : pager->takeArrived(kAll)) got.insert(page->page);
  for (const std::uint32_t page : needed) EXPECT_TRUE(got.count(page)) << page;
}

TEST_F(PagerOf, turnsFailuresIntoFindingsAndDoesNotTryAgain) {
  start(0ms);
  slow->broken = {2, 4};
  const std::vector<std::uint32_t> numbers{0, 1, 2, 3, 4};
  pager->want(wants(numbers));
  pager->waitFor(numbers);
  EXPECT_EQ(pager->takeArrived(kAll).size(), 3u);
  EXPECT_EQ(pager->counters().failed, 2u);
  ASSERT_EQ(pager->failures().size(), 2u);
  EXPECT_EQ(pager->failures()[0].expected, "its checksum");
  EXPECT_TRUE(pager->hasFailed(2));
  EXPECT_FALSE(pager->hasFailed(3));
  pager->want(wants({2, 4}));
  pager->waitFor(std::vector<std::uint32_t>{2, 4});
  EXPECT_TRUE(pager->takeArrived(kAll).empty());
  const auto read = slow->read();
  EXPECT_EQ(std::count(read.begin(), read.end(), 2u), 1);
  EXPECT_EQ(pager->counters().waiting, 0u);
}

TEST_F(PagerOf, outlivesATerrainThatThrowsOrGivesAnotherPage) {
  for (const bool throws : {true, false}) {
    start(0ms);
    slow->throws = throws;
    slow->lies = !throws;
    pager->want(wants({1, 2}));
    pager->waitFor(std::vector<std::uint32_t>{1, 2});
    EXPECT_EQ(pager->counters().failed, 2u);
    EXPECT_EQ(pager->failures().size(), 2u);
    EXPECT_TRUE(pager->takeArrived(kAll).empty());
  }
}

TEST_F(PagerOf, goesAtAnyTime) {
  for (int i = 0; i < 20; ++i) {
    start(std::chrono::milliseconds(i % 4));
    std::vector<std::uint32_t> all(pages());
    std::iota(all.begin(), all.end(), 0u);
    pager->want(wants(all));
    std::this_thread::sleep_for(std::chrono::milliseconds(i % 3));
  }
}

}  // namespace
}  // namespace trimtab::terrain
