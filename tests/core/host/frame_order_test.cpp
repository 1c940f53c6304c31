#include "core/host/frame_order.h"

#include <set>

#include "host_support.h"
#include "tests/support.h"

namespace trimtab::test {
namespace {

using Verdict = FrameOrder::Verdict;

TEST(FrameOrder, agreesWithASetOfAllFramesSeen) {
  // Frames of a lossy, shuffling, duplicating network across the wrap at 2^32, judged by plain 64-bit
  // book-keeping.
  FrameOrder order;
  std::set<std::uint64_t> seen;
  std::uint64_t highest = 0, next = 4294967296 - 500;
  std::uint32_t random = 1;
  const auto below = [&random](std::uint32_t n) {
    return (random = random * 1664525 + 1013904223) / 65536 % n;
  };
  std::vector<std::uint64_t> late;
  const auto arrive = [&](std::uint64_t frame) {
    const bool repeated = seen.contains(frame), newest = seen.empty() || frame > highest;
    const Verdict expected = repeated ? Verdict::repeated : newest ? Verdict::next : Verdict::reordered;
    EXPECT_EQ(order.accept(static_cast<std::uint32_t>(frame), false), expected) << frame;
    seen.insert(frame);
    highest = std::max(highest, frame);
  };
  arrive(next++);
  for (int i = 0; i < 2000; ++i, ++next) {
    const auto fate = below(20);
    if (fate == 0) continue;
    if (fate == 1) {
      late.push_back(next);
      continue;
    }
    arrive(next);
    if (fate == 2) arrive(next);
    if (fate == 3 && !late.empty()) {
      if (highest - late.back() < 60) arrive(late.back());
      late.clear();
    }
  }
  EXPECT_EQ(order.lost(), highest - (4294967296 - 500) + 1 - seen.size());
  EXPECT_GT(order.lost(), 100U);
  EXPECT_GT(highest, 4294967296U);
}

TEST(FrameOrder, seesAHostThatCountsAnew) {
  FrameOrder far;
  for (std::uint32_t f = 9000; f < 9100; ++f) far.accept(f, false);
  EXPECT_EQ(far.accept(0, false), Verdict::implausible);
  EXPECT_EQ(far.accept(1, false), Verdict::restarted) << "the second one confirms it";
  EXPECT_EQ(far.accept(2, false), Verdict::next);
  EXPECT_EQ(far.lost(), 0U);
  EXPECT_EQ(far.implausible(), 0U);

  FrameOrder ahead;
  ahead.accept(5, false);
  EXPECT_EQ(ahead.accept(2000000000, false), Verdict::implausible);
  EXPECT_EQ(ahead.accept(2000000000, false), Verdict::repeated) << "a copy of it confirms nothing";
  EXPECT_EQ(ahead.accept(2000000003, false), Verdict::restarted);
  EXPECT_EQ(ahead.lost(), 0U);

  FrameOrder soon;  // within the window of late packets
  for (std::uint32_t f = 0; f < 30; ++f) soon.accept(f, false);
  std::uint32_t f = 0;
  while (f < 30 && soon.accept(f, false) != Verdict::restarted) ++f;
  EXPECT_LE(f, 5U);
  EXPECT_EQ(soon.accept(f + 1, false), Verdict::next);

  FrameOrder after;  // a pause or another sender says so at once
  for (std::uint32_t i = 0; i < 30; ++i) after.accept(i, false);
  EXPECT_EQ(after.accept(3, true), Verdict::restarted);
}

TEST(FrameOrder, takesADamagedNumberForNoLossAndNoRestart) {
  // Every single bit of the number flipped in transit, now and then.
  FrameOrder order;
  std::uint64_t next = 0, far = 0;
  for (std::uint32_t f = 1000; f < 20000; ++f) {
    const std::uint32_t bit = f / 100 % 32, damaged = f ^ (1U << bit);
    const bool flips = f % 100 == 50 && bit >= 7;
    const auto verdict = order.accept(flips ? damaged : f, false);
    next += verdict == Verdict::next;
    far += verdict == Verdict::implausible;
    ASSERT_NE(verdict, Verdict::restarted) << f;
  }
  EXPECT_EQ(far, order.implausible());
  EXPECT_GT(far, 100U);
  EXPECT_EQ(order.lost(), far) << "the number of each was lost, and no other";
  EXPECT_EQ(next, 19000 - far);
}

TEST(FrameOrder, countsALongOutageAsLossOnceTheNextFrameConfirmsIt) {
  FrameOrder order;
  for (std::uint32_t f = 1; f <= 100; ++f) order.accept(f, false);
  EXPECT_EQ(order.accept(301, false), Verdict::implausible);
  EXPECT_EQ(order.accept(302, false), Verdict::next);
  EXPECT_EQ(order.lost(), 200U) << "101 to 300";
  EXPECT_EQ(order.implausible(), 0U);
  FrameOrder silent;
  for (std::uint32_t f = 1; f <= 100; ++f) silent.accept(f, false);
  EXPECT_EQ(silent.accept(301, true), Verdict::next) << "a silence makes it plausible";
  EXPECT_EQ(silent.lost(), 200U);
}

TEST(FrameOrder, decidesNoPacketThatIsVeryLate) {
  FrameOrder order;
  for (std::uint32_t f = 1; f <= 1000; ++f) {
    ASSERT_NE(order.accept(f, false), Verdict::restarted);
    if (f % 100 == 0) {
      EXPECT_EQ(order.accept(f - 90, false), Verdict::implausible) << f;
    }
  }
  EXPECT_EQ(order.lost(), 0U);
}

TEST(FrameOrder, reachesTheStatistics) {
  HostDecoder decoder;
  AircraftState s = aState();
  double t = 1;
  for (const std::uint32_t frame : {10U, 11U, 13U, 13U, 12U, 16U}) {
    s.time = frame * 0.02;
    feed(decoder, encodeCigiHost(s, frame, 0), t += 0.02);
  }
  const HostStatistics& st = decoder.statistics();
  EXPECT_EQ(st.states, 4U);
  EXPECT_EQ(st.repeated, 1U);
  EXPECT_EQ(st.reordered, 1U);
  EXPECT_EQ(st.lost, 2U);  // 14 and 15; 12 came late
  EXPECT_EQ(st.restarts, 0U);
  EXPECT_FALSE(feed(decoder, encodeCigiHost(s, 17 | 1U << 20, 0), t += 0.02));
  EXPECT_TRUE(feed(decoder, encodeCigiHost(s, 18, 0), t += 0.02));
  EXPECT_EQ(st.implausible, 1U);
  EXPECT_EQ(st.lost, 3U);
  feed(decoder, encodeCigiHost(s, 1, 0), t + 5);
  EXPECT_EQ(st.restarts, 1U);
  EXPECT_EQ(st.lost, 3U) << "a host that begins to count anew has lost nothing by it";
}

}  // namespace
}  // namespace trimtab::test
