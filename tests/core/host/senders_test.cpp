#include <gmock/gmock.h>

#include <map>

#include "host_support.h"

/// Several senders at one port: what each sends is counted, timed and decoded apart.
namespace trimtab::test {
namespace {

constexpr const char *kOne = "127.0.0.1:5500", *kTwo = "127.0.0.1:5502";

/// Every sender's health by its name, followed or not.
std::map<std::string, HostStatistics> all(const HostDecoder& decoder) {
  std::map<std::string, HostStatistics> senders;
  for (const HostStatistics& other : decoder.otherSenders()) senders[other.from] = other;
  senders[decoder.statistics().from] = decoder.statistics();
  return senders;
}

AircraftState at(double time, Degrees latitude = Degrees{36.6}) {
  AircraftState s = aState();
  s.time = time;
  s.position.latitude = latitude;
  return s;
}

TEST(HostSenders, ofTwoHostsLoseNothingByEachOther) {
  HostDecoder decoder;
  int states = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const double t = 100 + i * 0.02;
    states += feed(decoder, encodeCigiHost(at(i * 0.02), 1 + i, 0), t, kOne).has_value();
    states += feed(decoder, encodeCigiHost(at(9000 + i * 0.02, Degrees{-20}), 30000 + i, 0), t + 0.01, kTwo)
                  .has_value();
  }
  EXPECT_EQ(states, 600) << "what both say is decided, as ever";
  EXPECT_EQ(decoder.received(), 600U);
  const auto senders = all(decoder);
  ASSERT_EQ(senders.size(), 2U);
  for (const auto& [from, s] : senders) {
    SCOPED_TRACE(from);
    EXPECT_EQ(s.received, 300U);
    EXPECT_EQ(s.states, 300U);
    EXPECT_EQ(s.lost, 0U);
    EXPECT_EQ(s.restarts + s.repeated + s.reordered + s.implausible + s.jumps + s.bad, 0U);
    EXPECT_NEAR(s.rateHz, 50, 1e-6);
    EXPECT_NEAR(s.jitterMs, 0, 1e-6);
  }
  EXPECT_EQ(decoder.statistics().from, kTwo)
      << "the last to appear is followed, and no other takes turns with it";
  EXPECT_EQ(senders.at(kTwo).alongside, 0U);
  EXPECT_EQ(senders.at(kOne).alongside, 299U);
}

TEST(HostSenders, keepTheirOwnHeadsWeatherAndSymbols) {
  HostDecoder decoder;
  for (const std::uint32_t frame : {1U, 2U})
    feed(decoder, encodeCigiHost(aFullState(), frame, 0), frame, kOne);
  const auto other = feed(decoder, encodeCigiHost(aState(), 3, 0), 2.01, kTwo);
  ASSERT_TRUE(other);
  EXPECT_FALSE(other->head || other->visibility || other->weather) << "the other host has said none of that";
  const auto again = feed(decoder, encodeCigiHost(at(12.52), 3, 0), 2.02, kOne);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->head, aFullState().head);
  EXPECT_EQ(again->weather, aFullState().weather);
}

TEST(HostSenders, areFollowedAtOnceWhereAHostRestartsAtAnotherPort) {
  HostDecoder decoder;
  double t = 1;
  for (std::uint32_t i = 0; i < 50; ++i)
    feed(decoder, encodeCigiHost(aFullState(), 7000 + i, 0), t += 0.02, kOne);
  const auto first = feed(decoder, encodeCigiHost(at(0), 1, 0), t += 0.02, kTwo);
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->head) << "a host that was started anew has said nothing yet";
  EXPECT_EQ(decoder.statistics().from, kTwo);
  EXPECT_EQ(decoder.statistics().received, 1U);
  EXPECT_EQ(decoder.statistics().lost, 0U);
  ASSERT_EQ(decoder.otherSenders().size(), 1U);
  EXPECT_EQ(decoder.otherSenders()[0].from, kOne);
  EXPECT_EQ(decoder.otherSenders()[0].received, 50U);
  EXPECT_EQ(decoder.otherSenders()[0].alongside, 0U) << "it was silent from then on";
}

TEST(HostSenders, areFollowedAgainAfterASilenceOfTheOther) {
  HostDecoder decoder;
  feed(decoder, encodeNativeFdm(aState()), 1, kOne);
  feed(decoder, encodeNativeFdm(aState()), 1.5, kTwo);
  feed(decoder, encodeNativeFdm(aState()), 3.4, kOne);
  EXPECT_EQ(decoder.statistics().from, kTwo);
  feed(decoder, encodeNativeFdm(aState()), 3.6, kOne);
  EXPECT_EQ(decoder.statistics().from, kOne);
}

TEST(HostSenders, ofNothingGoodAreNamedAndDisplaceNoHost) {
  HostDecoder decoder;
  const std::vector<std::byte> stray(30, std::byte{7});
  feed(decoder, stray, 1, kTwo);
  EXPECT_EQ(decoder.statistics().from, kTwo) << "nobody else is there";
  feed(decoder, encodeNativeFdm(aState()), 1.1, kOne);
  for (int i = 0; i < 400; ++i) feed(decoder, stray, 1.2 + i * 0.01, kTwo);
  EXPECT_EQ(decoder.statistics().from, kOne);
  EXPECT_EQ(decoder.statistics().bad, 0U);
  EXPECT_FALSE(decoder.understood());
  ASSERT_EQ(decoder.otherSenders().size(), 1U);
  EXPECT_EQ(decoder.otherSenders()[0].bad, 401U);
  EXPECT_THAT(toString(*decoder.otherSenders()[0].newestBad),
              testing::StartsWith("127.0.0.1:5502: byte 0: datagram"));
}

TEST(HostSenders, thatOpenASocketForEachMessageStayOneHost) {
  HostDecoder decoder;
  feed(decoder, encodeCigiHost(aFullState(), 1, 0), 1, "127.0.0.1:40001");
  for (std::uint32_t frame = 2; frame <= 100; ++frame) {
    const auto state = feed(decoder, encodeCigiHost(at(12.5 + frame * 0.02), frame, 0), 1 + frame * 0.02,
                            "127.0.0.1:" + std::to_string(40000 + frame));
    ASSERT_TRUE(state);
    EXPECT_EQ(state->head, aFullState().head);
  }
  EXPECT_EQ(decoder.statistics().received, 100U);
  EXPECT_NEAR(decoder.statistics().rateHz, 50, 1e-6);
  EXPECT_TRUE(decoder.otherSenders().empty());
}

TEST(HostSenders, ofAFloodAreForgottenButTheHostIsNot) {
  HostDecoder decoder;
  feed(decoder, encodeCigiHost(aFullState(), 1, 0), 1, kOne);
  for (int i = 0; i < 1000; ++i)
    feed(decoder, std::vector<std::byte>(9), 1.01, "10.0.0.1:" + std::to_string(i));
  EXPECT_LT(decoder.otherSenders().size(), 10U);
  EXPECT_EQ(decoder.received(), 1001U);
  const auto next = feed(decoder, encodeCigiHost(at(12.52), 2, 0), 1.02, kOne);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->head, aFullState().head);
  EXPECT_EQ(decoder.statistics().received, 2U);
}

TEST(HostSenders, thatRestartHaveLostNothing) {
  HostDecoder decoder;
  double t = 1;
  // The same socket; each time the count begins again, from wherever it had come.
  const std::uint32_t begins[] = {1, 4000000000U, 1, 2000000000U, 0, 50000, 0, 1};
  for (const std::uint32_t begin : begins)
    for (std::uint32_t i = 0; i < 100; ++i)
      feed(decoder, encodeCigiHost(at(i * 0.02), begin + i, 0), t += 0.02);
  const HostStatistics& s = decoder.statistics();
  EXPECT_EQ(s.received, 800U);
  EXPECT_EQ(s.lost, 0U);
  EXPECT_EQ(s.restarts, 7U);
}

}  // namespace
}  // namespace trimtab::test
