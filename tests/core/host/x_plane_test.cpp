#include <gmock/gmock.h>

#include "host_support.h"
#include "tests/support.h"
#include "wire_writer.h"

/// X-Plane's packets after its published descriptions, and one that it sent.
namespace trimtab::test {
namespace {

using testing::HasSubstr;

std::vector<std::byte> position(std::size_t header, double latitude = 47.4375) {
  WireWriter w(ByteOrder::little);
  w.begin(header + 64).text(0, header == 5 ? "RPOS4" : "RPOS");
  w.f64(header, 8.5625).f64(header + 8, latitude).f64(header + 16, 1432.5).f32(header + 24, 210.25);
  w.f32(header + 28, 3.5).f32(header + 32, 275.25).f32(header + 36, -22.5);
  w.f32(header + 40, -60).f32(header + 44, 2.5).f32(header + 48, -8);  // east, up, south
  return w.bytes;
}

void row(WireWriter& w, std::uint32_t number, const std::vector<double>& cells) {
  w.begin(36).u32(0, number);
  for (std::size_t i = 0; i < 8; ++i) w.f32(4 + 4 * i, i < cells.size() ? cells[i] : -999);
}
WireWriter data(char fifth = '*') {
  WireWriter w(ByteOrder::little);
  w.begin(5).text(0, "DATA").u8(4, static_cast<unsigned char>(fifth));
  return w;
}

TEST(XPlane, positionIsReadWithAHeaderOfFiveOrFourBytes) {
  for (const std::size_t header : {5U, 4U}) {
    HostDecoder decoder;
    const auto state = feed(decoder, position(header), 3.5);
    ASSERT_TRUE(state) << decoder.statistics().firstBadReason;
    EXPECT_EQ(decoder.statistics().protocol, WireProtocol::x_plane);
    EXPECT_FALSE(decoder.statistics().lost);
    EXPECT_EQ(state->time, 3.5);
    EXPECT_EQ(state->position, (GeodeticPosition{Degrees{47.4375}, Degrees{8.5625}, Metres{1432.5}}));
    EXPECT_EQ(state->attitude, (Attitude{Degrees{275.25}, Degrees{3.5}, Degrees{-22.5}}));
    EXPECT_EQ(state->aboveGround, Metres{210.25});
    EXPECT_EQ(state->velocity, (Velocity{MetresPerSecond{8}, MetresPerSecond{-60}, MetresPerSecond{-2.5}}));
  }
}

TEST(XPlane, rowsOfDataAddUpOverDatagrams) {
  HostDecoder decoder;
  WireWriter attitude = data('@');
  row(attitude, 17, {-4.5, 12.25, 301.5, 299});
  row(attitude, 3, {140, 141, 150, 151});
  EXPECT_FALSE(feed(decoder, attitude.bytes, 1));
  EXPECT_THAT(
      toString(*decoder.statistics().newestUnused),
      HasSubstr("expected row 17 (attitude) and row 20 (position): tick both in Data Output, found so "
                "far row 17: yes, row 20: no"));
  WireWriter place = data();
  row(place, 20, {-12.5, -77.25, 3280.84, 1000, 0});
  const auto state = feed(decoder, place.bytes, 1.1);
  ASSERT_TRUE(state);
  EXPECT_DOUBLE_EQ(state->position.latitude.value(), -12.5);
  EXPECT_DOUBLE_EQ(state->position.longitude.value(), -77.25);
  EXPECT_NEAR(state->position.height.value(), 1000, 1e-3);
  EXPECT_NEAR(state->aboveGround->value(), 304.8, 1e-3);
  EXPECT_EQ(state->attitude, (Attitude{Degrees{301.5}, Degrees{-4.5}, Degrees{12.25}}));
  const auto next = feed(decoder, place.bytes, 1.2);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->packet, state->packet + 1);
}

/// alex-leung.blogspot.com shows this packet of a running X-Plane, and reads it as pitch 0.9936, roll
/// -0.2415, heading 25.484.
TEST(XPlane, aPacketThatItSentIsRead) {
  WireWriter w(ByteOrder::big);
  w.begin(41).u32(0, 0x44415441).u8(4, 0x2a).u32(5, 0x11000000).u32(9, 0xDC5C7E3F).u32(13, 0x285277BE);
  w.u32(17, 0xD1DFCB41).u32(21, 0x5862E341);
  for (std::size_t at = 25; at < 41; at += 4) w.u32(at, 0x00C079C4);
  HostDecoder decoder;
  EXPECT_FALSE(feed(decoder, w.bytes, 1));
  WireWriter place = data();
  row(place, 20, {10, 20, 500, 400});
  const auto state = feed(decoder, place.bytes, 1.1);
  ASSERT_TRUE(state);
  EXPECT_NEAR(state->attitude.pitch.value(), 0.9936, 5e-5);
  EXPECT_NEAR(state->attitude.roll.value(), -0.2415, 5e-5);
  EXPECT_NEAR(state->attitude.heading.value(), 25.484, 5e-4);
}

TEST(XPlane, unusedCellsAndImpossibleOnesAreNotFlown) {
  HostDecoder decoder;
  WireWriter unused = data();
  row(unused, 17, {});
  row(unused, 20, {1, 2, 300, 300});
  EXPECT_FALSE(feed(decoder, unused.bytes, 1));
  EXPECT_EQ(decoder.statistics().bad, 0U);
  EXPECT_FALSE(feed(decoder, position(5, 91), 1.1));
  EXPECT_THAT(decoder.statistics().firstBadReason, HasSubstr("byte 13: latitude: expected -90"));
  WireWriter bad = data();
  row(bad, 17, {95, 0, 0});
  EXPECT_FALSE(feed(decoder, bad.bytes, 1.2));
  EXPECT_THAT(toString(*decoder.statistics().newestBad), HasSubstr("byte 9: pitch"));
}

TEST(XPlane, otherPacketsAreNamed) {
  for (const char* name : {"RREF,", "BECN", "DREF+", "RPOS4"}) {
    HostDecoder decoder;
    WireWriter w(ByteOrder::little);
    w.begin(29).text(0, name);
    EXPECT_FALSE(feed(decoder, w.bytes, 1));
    EXPECT_EQ(decoder.statistics().notForUs, 1U) << name;
    EXPECT_THAT(toString(*decoder.statistics().newestNotForUs),
                HasSubstr("found " + std::string(name).substr(0, 4) + " of 29 bytes; tick rows 17 and 20"));
  }
}

}  // namespace
}  // namespace trimtab::test
