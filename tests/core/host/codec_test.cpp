#include <cmath>

#include "host_support.h"
#include "tests/support.h"

namespace trimtab::test {
namespace {

void expectNear(const AircraftState& a, const AircraftState& b) {
  constexpr double kAngle = 1e-5;
  EXPECT_NEAR(a.position.latitude.value(), b.position.latitude.value(), 1e-12);
  EXPECT_NEAR(a.position.longitude.value(), b.position.longitude.value(), 1e-12);
  EXPECT_EQ(a.position.height, b.position.height);
  EXPECT_NEAR(a.attitude.heading.value(), b.attitude.heading.value(), 4 * kAngle);
  EXPECT_NEAR(a.attitude.pitch.value(), b.attitude.pitch.value(), kAngle);
  EXPECT_NEAR(a.attitude.roll.value(), b.attitude.roll.value(), kAngle);
}

TEST(NativeFdm, comesBackAsItWasSent) {
  AircraftState sent = aState();
  sent.aboveGround = Metres{321.5};
  sent.visibility = Metres{9000};
  const auto bytes = encodeNativeFdm(sent);
  ASSERT_EQ(bytes.size(), 408U);
  HostDecoder decoder;
  const auto got = feed(decoder, bytes, 100.25);
  ASSERT_TRUE(got);
  expectNear(*got, sent);
  EXPECT_EQ(got->aboveGround, sent.aboveGround);
  EXPECT_EQ(got->visibility, sent.visibility);
  EXPECT_EQ(got->time, 100.25) << "no send time on the wire: the arrival counts";
  EXPECT_EQ(decoder.statistics().protocol, WireProtocol::native_fdm);
  EXPECT_FALSE(decoder.statistics().lost) << "no frame numbers on the wire";
}

TEST(NativeFdm, hasItsFieldsWhereTheLayoutSays) {
  const auto bytes = encodeNativeFdm(aState());
  EXPECT_EQ(wire::get<std::uint32_t>(bytes, 0, ByteOrder::big), 24U);
  EXPECT_DOUBLE_EQ(wire::get<double>(bytes, 8, ByteOrder::big), 128.3555 * M_PI / 180);
  EXPECT_DOUBLE_EQ(wire::get<double>(bytes, 16, ByteOrder::big), 36.6278 * M_PI / 180);
  EXPECT_EQ(wire::get<double>(bytes, 24, ByteOrder::big), 1981.2);
  EXPECT_FLOAT_EQ(wire::get<float>(bytes, 36, ByteOrder::big), static_cast<float>(12.75 * M_PI / 180));
  EXPECT_FLOAT_EQ(wire::get<float>(bytes, 40, ByteOrder::big), static_cast<float>(-4.5 * M_PI / 180));
  EXPECT_FLOAT_EQ(wire::get<float>(bytes, 44, ByteOrder::big), static_cast<float>(280.25 * M_PI / 180));
}

TEST(NativeFdm, takesGroundAndVisibilityOfZeroAsUnknown) {
  HostDecoder decoder;
  const auto got = feed(decoder, encodeNativeFdm(aState()), 1);
  ASSERT_TRUE(got);
  EXPECT_FALSE(got->aboveGround);
  EXPECT_FALSE(got->visibility);
}

class Cigi : public testing::TestWithParam<ByteOrder> {};
INSTANTIATE_TEST_SUITE_P(EitherOrder, Cigi, testing::Values(ByteOrder::big, ByteOrder::little));

TEST_P(Cigi, comesBackAsItWasSent) {
  const AircraftState sent = aFullState();
  HostDecoder decoder;
  const auto got = feed(decoder, encodeCigiHost(sent, 77, 5, GetParam()), 1000);
  ASSERT_TRUE(got);
  expectNear(*got, sent);
  EXPECT_EQ(got->packet, 77U);
  EXPECT_NEAR(got->time, 12.5, 1e-9) << "ticks of 10 microseconds";
  EXPECT_EQ(got->head, sent.head);
  EXPECT_EQ(got->view, sent.view);
  EXPECT_EQ(got->visibility, sent.visibility);
  EXPECT_EQ(got->weather, sent.weather);
  EXPECT_EQ(decoder.statistics().protocol, WireProtocol::cigi3);
  EXPECT_EQ(decoder.hostOrder(), GetParam());
  EXPECT_EQ(decoder.lastHostFrame(), 77U);
}

TEST_P(Cigi, passesOverPacketsItDoesNotKnow) {
  auto bytes = encodeCigiHost(aState(), 1, 0, GetParam());
  std::vector<std::byte> unknown(16);
  unknown[0] = std::byte{200};
  unknown[1] = std::byte{16};
  bytes.insert(bytes.begin() + 24, unknown.begin(), unknown.end());
  HostDecoder decoder;
  const auto got = feed(decoder, bytes, 1);
  ASSERT_TRUE(got);
  expectNear(*got, aState());
}

TEST(CigiSession, keepsWhatIsNotSentAgain) {
  HostDecoder decoder;
  ASSERT_TRUE(feed(decoder, encodeCigiHost(aFullState(), 1, 0), 1));
  AircraftState second = aState();
  second.time = 12.52;
  const auto got = feed(decoder, encodeCigiHost(second, 2, 0), 1.02);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->head, aFullState().head);
  EXPECT_EQ(got->visibility, aFullState().visibility);
  EXPECT_EQ(got->weather, aFullState().weather);
  EXPECT_EQ(got->view, aFullState().view);
}

TEST(CigiSession, givesNoStateBeforeTheOwnshipHasAPlace) {
  HostDecoder decoder;
  auto bytes = encodeCigiHost(aState(), 1, 0);
  bytes.resize(24);
  EXPECT_FALSE(feed(decoder, bytes, 1));
  EXPECT_EQ(decoder.statistics().bad, 0U);
  EXPECT_TRUE(feed(decoder, encodeCigiHost(aState(), 2, 0), 1.02));
}

TEST(CigiSession, ignoresOtherEntitiesAndDisabledAngles) {
  HostDecoder decoder;
  ASSERT_TRUE(feed(decoder, encodeCigiHost(aFullState(), 1, 0), 1));
  AircraftState other = aFullState();
  other.position.latitude = Degrees{-10};
  other.head->heading = Degrees{99};
  other.head->pitch = Degrees{-33};
  auto bytes = encodeCigiHost(other, 2, 0);
  wire::put(bytes, 24 + 2, ByteOrder::big, std::uint16_t{3});  // another entity
  bytes[24 + 48 + 5] = std::byte{0x10};                        // pitch alone is enabled
  const auto got = feed(decoder, bytes, 1.02);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->position, aFullState().position);
  EXPECT_EQ(got->head->heading, aFullState().head->heading);
  EXPECT_EQ(got->head->pitch.value(), -33);
}

TEST(CigiClock, runsOnWhenTheTickCounterWraps) {
  HostDecoder decoder;
  AircraftState s = aState();
  s.time = 4294967290 * 1e-5;
  const auto before = feed(decoder, encodeCigiHost(s, 1, 0), 1);
  s.time += 0.02;
  const auto after = feed(decoder, encodeCigiHost(s, 2, 0), 1.02);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(after->time - before->time, 0.02, 1e-6);
}

TEST(CigiClock, isReplacedByArrivalWhenItStandsStill) {
  HostDecoder decoder;
  std::optional<AircraftState> last;
  for (std::uint32_t i = 0; i < 10; ++i) last = feed(decoder, encodeCigiHost(aState(), i, 0), 500 + i * 0.02);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->time, 500 + 9 * 0.02);
}

TEST(HostDecoder, holdsBackASimulatorThatIsNotReady) {
  HostDecoder decoder;
  AircraftState s = aState();
  s.position.height = Feet{-9999}.as<Metres>();
  EXPECT_FALSE(feed(decoder, encodeNativeFdm(s), 1));
  EXPECT_EQ(decoder.statistics().notReady, 1U);
  EXPECT_EQ(decoder.statistics().bad, 0U);
  EXPECT_TRUE(feed(decoder, encodeNativeFdm(aState()), 1.02));
}

TEST(HostDecoder, measuresRateAndFallsSilent) {
  HostDecoder decoder;
  double t = 100;
  for (int i = 0; i < 200; ++i, t += 0.02) ASSERT_TRUE(feed(decoder, encodeNativeFdm(aState()), t));
  EXPECT_NEAR(decoder.statistics().rateHz, 50, 1e-6);
  EXPECT_NEAR(decoder.statistics().jitterMs, 0, 1e-6);
  EXPECT_NEAR(decoder.rateAt(t + 0.5), 50, 1e-6);
  EXPECT_EQ(decoder.rateAt(t + 1.1), 0);
}

TEST(HostDecoder, estimatesJitterAsRfc3550Does) {
  HostDecoder decoder;
  AircraftState s = aState();
  double expected = 0, arrival = 50, lastTransit = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    s.time = i * 0.02;  // whole ticks
    arrival = 50 + s.time + 0.001 * static_cast<double>(i * 7919 % 5);
    ASSERT_TRUE(feed(decoder, encodeCigiHost(s, i, 0), arrival));
    const double transit = arrival - s.time;
    if (i > 0) expected += (std::abs(transit - lastTransit) - expected) / 16;
    lastTransit = transit;
  }
  EXPECT_NEAR(decoder.statistics().jitterMs, expected * 1e3, 0.05);
  EXPECT_GT(expected, 1e-3);
}

TEST(HostDecoder, countsJumpsAndSilences) {
  HostDecoder decoder;
  AircraftState s = aState();
  feed(decoder, encodeNativeFdm(s), 1);
  s.position.latitude = Degrees{36.63};  // 240 m in 20 ms: a host that stuttered
  feed(decoder, encodeNativeFdm(s), 1.02);
  EXPECT_EQ(decoder.statistics().jumps, 0U);
  s.position.latitude = Degrees{36.7};  // 8 km
  feed(decoder, encodeNativeFdm(s), 1.04);
  EXPECT_EQ(decoder.statistics().jumps, 1U);
  s.position.latitude = Degrees{36.75};  // 5 km in a silence of 20 s
  feed(decoder, encodeNativeFdm(s), 21);
  EXPECT_EQ(decoder.statistics().jumps, 2U);
  EXPECT_EQ(decoder.statistics().silences, 1U);
}

TEST(HostDecoder, startsOverOnReset) {
  HostDecoder decoder(HostProtocol::cigi3);
  feed(decoder, encodeNativeFdm(aState()), 1);
  EXPECT_EQ(decoder.statistics().bad, 1U) << "it was told to expect CIGI";
  decoder.reset();
  EXPECT_EQ(decoder.statistics().received, 0U);
  feed(decoder, encodeNativeFdm(aState()), 1);
  EXPECT_EQ(decoder.statistics().bad, 1U) << "and still is";
}

}  // namespace
}  // namespace trimtab::test
