#include <gmock/gmock.h>

#include "host_support.h"
#include "tests/support.h"
#include "wire_writer.h"

/// Messages of CIGI 4.0, written after the tables of its class library (the Pack() of each packet).
namespace trimtab::test {
namespace {

using testing::HasSubstr;

class Cigi4 : public testing::TestWithParam<ByteOrder> {
 protected:
  WireWriter message(std::uint32_t frame, std::uint32_t ticks = 0) const {
    WireWriter w(GetParam());
    w.begin(24).u16(0, 24).u16(2, 0).u8(4, 4).u8(5, 7).u8(7, 0x05).u32(8, frame).u32(12, 77).u32(16, ticks);
    return w;
  }
  static void position(WireWriter& w, unsigned entity, double latitude = -33.25) {
    w.begin(48).u16(0, 48).u16(2, 1).u16(6, entity).u16(8, 9).f32(12, -17.5).f32(16, 4.25).f32(20, 211.75);
    w.f64(24, latitude).f64(32, 151.5).f64(40, 987.5);
  }
};
INSTANTIATE_TEST_SUITE_P(EitherOrder, Cigi4, testing::Values(ByteOrder::big, ByteOrder::little));

TEST_P(Cigi4, isReadFieldByField) {
  WireWriter w = message(41, 250000);
  position(w, 0);
  w.begin(40).u16(0, 40).u16(2, 0x0f).u8(5, 0x38).u16(6, 3).u16(8, 0);  // View Control
  w.f32(24, 1.5).f32(28, -20.25).f32(32, 65.5);
  w.begin(40).u16(0, 40).u16(2, 0x14).u16(4, 3).u8(7, 0x3d);  // View Definition
  w.f32(12, 0.75).f32(16, 9e4).f32(20, -31).f32(24, 32).f32(28, 17).f32(32, -18);
  w.begin(32)
      .u16(0, 32)
      .u16(2, 9)
      .u8(4, 0x80 | 55)
      .f32(8, 3)
      .f32(12, 6250)
      .f32(16, 12)
      .f32(20, -1.5)
      .f32(24, 135);
  w.begin(72).u16(0, 72).u16(2, 0x0b).u8(4, 5).u8(6, 1).u8(7,
                                                           4U << 2U | 0x20U);  // snow, severity 4, top scud
  w.f32(16, 850).f32(40, 8).f32(44, 0.5).f32(48, 300);
  HostDecoder decoder;
  const auto state = feed(decoder, w.bytes, 1);
  ASSERT_TRUE(state) << decoder.statistics().firstBadReason;
  EXPECT_EQ(decoder.statistics().protocol, WireProtocol::cigi4);
  EXPECT_EQ(decoder.hostProtocol(), WireProtocol::cigi4);
  EXPECT_EQ(decoder.hostOrder(), GetParam());
  EXPECT_EQ(decoder.lastHostFrame(), 41U);
  EXPECT_EQ(state->packet, 41U);
  EXPECT_DOUBLE_EQ(state->time, 2.5);
  EXPECT_EQ(state->position, (GeodeticPosition{Degrees{-33.25}, Degrees{151.5}, Metres{987.5}}));
  EXPECT_EQ(state->attitude, (Attitude{Degrees{211.75}, Degrees{4.25}, Degrees{-17.5}}));
  EXPECT_EQ(state->head, (Attitude{Degrees{65.5}, Degrees{-20.25}, Degrees{1.5}}));
  EXPECT_EQ(state->view, (HostView{Metres{0.75}, Degrees{-31}, Degrees{32}, Degrees{-18}, Degrees{17}}));
  EXPECT_EQ(state->visibility, Metres{6250});
  EXPECT_EQ(state->weather, (HostWeather{Precipitation::snow, 4, Metres{850}}));
  EXPECT_EQ(state->wind, (Wind{MetresPerSecond{8}, Degrees{300}, MetresPerSecond{0.5}}));
}

TEST_P(Cigi4, windOfTheAtmosphereCountsWithoutPrecipitation) {
  WireWriter w = message(1);
  position(w, 0);
  w.begin(32).u16(0, 32).u16(2, 9).f32(12, 100).f32(16, 12).f32(20, -1.5).f32(24, 135);
  HostDecoder decoder;
  const auto state = feed(decoder, w.bytes, 1);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->wind, (Wind{MetresPerSecond{12}, Degrees{135}, MetresPerSecond{-1.5}}));
}

TEST_P(Cigi4, regionsAndUnknownPacketsArePassedOver) {
  WireWriter w = message(1);
  w.begin(48).u16(0, 48).u16(2, 0x0a).u8(4, 1).u16(6, 2).f64(8, 1).f64(16, 2);  // Environmental Region
  w.begin(72).u16(0, 72).u16(2, 0x0b).u8(4, 4).u8(6, 1).u8(7, 1 | 3U << 2U).u16(8, 2);  // rain of the region
  w.begin(264).u16(0, 264).u16(2, 0x1234);     // longer than any of CIGI 3
  w.begin(24).u16(0, 24).u16(2, 8).u8(6, 12);  // Celestial Sphere
  position(w, 0);
  HostDecoder decoder;
  const auto state = feed(decoder, w.bytes, 1);
  ASSERT_TRUE(state);
  EXPECT_FALSE(state->weather);
  EXPECT_EQ(decoder.statistics().regionalWeather, 1U);
}

TEST_P(Cigi4, entityControlDestroysTheAircraftAndElseMovesNothing) {
  HostDecoder decoder;
  WireWriter first = message(1);
  position(first, 0);
  first.begin(16).u16(0, 16).u16(2, 0x25).u8(4, 1).u8(5, 200).u16(6, 0);
  EXPECT_TRUE(feed(decoder, first.bytes, 1));
  WireWriter other = message(2);
  other.begin(16).u16(0, 16).u16(2, 0x25).u8(4, 2).u16(6, 5);
  EXPECT_TRUE(feed(decoder, other.bytes, 1.1)) << "another entity is destroyed";
  WireWriter last = message(3);
  last.begin(16).u16(0, 16).u16(2, 0x25).u8(4, 2).u16(6, 0);
  EXPECT_FALSE(feed(decoder, last.bytes, 1.2));
}

TEST_P(Cigi4, faultsNameTheByteOfTheDatagramThatCame) {
  WireWriter w = message(1);
  w.begin(16).u16(0, 16).u16(2, 0x25).u8(4, 1);
  position(w, 0, 95);
  HostDecoder decoder;
  EXPECT_FALSE(feed(decoder, w.bytes, 1));
  EXPECT_THAT(decoder.statistics().firstRefusedReason, HasSubstr("byte 64: latitude: expected -90"));

  WireWriter entity = message(1);
  position(entity, 6);
  HostDecoder waiting;
  EXPECT_FALSE(feed(waiting, entity.bytes, 1));
  ASSERT_TRUE(waiting.statistics().newestNotForUs);
  EXPECT_THAT(toString(*waiting.statistics().newestNotForUs), HasSubstr("byte 30: entity"));

  WireWriter cut = message(1);
  position(cut, 0);
  cut.bytes.resize(cut.bytes.size() - 8);
  HostDecoder third;
  EXPECT_FALSE(feed(third, cut.bytes, 1));
  EXPECT_EQ(third.statistics().truncated, 1U);
  EXPECT_THAT(third.statistics().firstBadReason,
              HasSubstr("byte 24: packet size: expected a multiple of 8 within"));
}

TEST_P(Cigi4, aPacketOfAnotherSizeCostsItselfAlone) {
  WireWriter w = message(1);
  w.begin(24).u16(0, 24).u16(2, 1);  // Entity Position has 48 bytes
  position(w, 0);
  HostDecoder decoder;
  EXPECT_TRUE(feed(decoder, w.bytes, 1));
  EXPECT_EQ(decoder.statistics().refusedPackets, 1U);
  EXPECT_EQ(decoder.statistics().bad, 0U);
  EXPECT_THAT(decoder.statistics().firstRefusedReason,
              HasSubstr("byte 24: size of packet 1: expected 48, found 24"));
}

TEST_P(Cigi4, whatIsSentIsWhatTheTablesSay) {
  const AircraftState s = aFullState();
  const auto sent = encodeCigi4Host(s, 1234, 77, GetParam());
  WireWriter w(GetParam());
  w.begin(24).u16(0, 24).u8(4, 4).u8(7, 0x05).u32(8, 1234).u32(12, 77).u32(16, 1250000);
  w.begin(48).u16(0, 48).u16(2, 1).f32(12, 12.75).f32(16, -4.5).f32(20, 280.25);
  w.f64(24, 36.6278).f64(32, 128.3555).f64(40, 1981.2);
  ASSERT_GE(sent.size(), w.bytes.size());
  EXPECT_EQ(std::vector<std::byte>(sent.begin(), sent.begin() + 72), w.bytes);
  HostDecoder decoder, of3;
  const auto state = feed(decoder, sent, 1);
  ASSERT_TRUE(state);
  EXPECT_EQ(state, feed(of3, encodeCigiHost(s, 1234, 77, GetParam()), 1));

  WireWriter sof(GetParam());
  sof.begin(24).u16(0, 24).u16(2, 0xffff).u8(4, 4).u8(7, 0x05).u32(8, 5).u32(12, 3000000).u32(16, 1234);
  EXPECT_EQ(encodeCigi4StartOfFrame(5, 1234, 30, GetParam()), sof.bytes);
}

}  // namespace
}  // namespace trimtab::test
