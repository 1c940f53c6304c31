#include <cmath>
#include <functional>
#include <random>

#include "host_support.h"
#include "tests/support.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::test {
namespace {

using Bytes = std::vector<std::byte>;

struct BadPacket {
  const char* name;
  std::function<Bytes()> make;
  const char* reason;  ///< how the reason begins
};

Bytes native(std::size_t offset, auto value) {
  Bytes bytes = encodeNativeFdm(aState());
  wire::put(bytes, offset, ByteOrder::big, value);
  return bytes;
}
Bytes cigi(std::size_t offset, auto value, ByteOrder order = ByteOrder::little) {
  Bytes bytes = encodeCigiHost(aFullState(), 9, 0, order);
  wire::put(bytes, offset, order, value);
  return bytes;
}
Bytes cut(Bytes bytes, std::size_t length) {
  bytes.resize(length);
  return bytes;
}

const std::vector<BadPacket>& badPackets() {
  static const std::vector<BadPacket> table{
      {"version 0", [] { return native(0, std::uint32_t{0}); },
       "byte 0: native-fdm version: expected 24, found 0"},
      {"packed native-fdm", [] { return cut(encodeNativeFdm(aState()), 404); },
       "byte 404: native-fdm length: expected 408 bytes, found 404 bytes"},
      {"latitude beyond the pole", [] { return native(16, 1.6); }, "byte 16: latitude: expected -90"},
      {"latitude no number", [] { return native(16, kNan); }, "byte 16: latitude: expected -90"},
      {"longitude infinite", [] { return native(8, kInfinity); }, "byte 8: longitude"},
      {"longitude in degrees", [] { return native(8, 128.0); }, "byte 8: longitude"},
      {"altitude no number", [] { return native(24, kNan); }, "byte 24: altitude"},
      {"altitude beyond space", [] { return native(24, 1e9); }, "byte 24: altitude"},
      {"roll infinite", [] { return native(36, static_cast<float>(-kInfinity)); }, "byte 36: phi"},
      {"pitch beyond vertical", [] { return native(40, 1.7F); }, "byte 40: theta"},
      {"heading no number", [] { return native(44, static_cast<float>(kNan)); }, "byte 44: psi"},
      {"visibility negative", [] { return native(364, -1.0F); }, "byte 364: visibility"},
      {"agl no number", [] { return native(32, static_cast<float>(kNan)); }, "byte 32: agl"},
      {"entity first", [] { return cigi(0, std::uint8_t{2}); }, "byte 0: CIGI packet id"},
      {"IG Control size", [] { return cigi(1, std::uint8_t{32}); }, "byte 1: size of IG Control"},
      {"IG Control cut", [] { return cut(cigi(0, std::uint8_t{1}), 20); }, "byte 20: length"},
      {"nothing", [] { return Bytes{}; }, "byte 0: datagram"},
      {"one byte", [] { return Bytes(1, std::byte{1}); }, "byte 0: datagram"},
      {"X-Plane", [] { return Bytes(41, std::byte{0x44}); }, "byte 0: datagram"},
      {"408 zeros", [] { return Bytes(408); }, "byte 0: native-fdm version"},
  };
  return table;
}

TEST(BadPackets, areCountedWithPlaceAndReasonAndChangeNothingElse) {
  for (const BadPacket& bad : badPackets()) {
    SCOPED_TRACE(bad.name);
    const Bytes bytes = bad.make();
    HostDecoder decoder;
    EXPECT_FALSE(feed(decoder, bytes, 1));
    EXPECT_EQ(decoder.statistics().bad, 1U);
    EXPECT_EQ(decoder.statistics().notForUs, 0U);
    EXPECT_EQ(decoder.statistics().states, 0U);
    ASSERT_TRUE(decoder.statistics().newestBad);
    EXPECT_EQ(
        toString(*decoder.statistics().newestBad).rfind(std::string("127.0.0.1:8004: ") + bad.reason, 0), 0U)
        << toString(*decoder.statistics().newestBad);
    EXPECT_EQ(decoder.statistics().firstBadReason.rfind(bad.reason, 0), 0U)
        << decoder.statistics().firstBadReason;
    EXPECT_EQ(decoder.statistics().firstBadHex.empty(), bytes.empty());

    // In the middle of a session: whatever came before, the next good message decodes as if it had not been
    // there.
    HostDecoder undisturbed, disturbed;
    const auto first = encodeCigiHost(aFullState(), 1, 0);
    AircraftState later = aState();
    later.time += 0.02;
    const auto second = encodeCigiHost(later, 2, 0);
    feed(undisturbed, first, 1);
    feed(disturbed, first, 1);
    EXPECT_FALSE(feed(disturbed, bytes, 1.01));
    EXPECT_EQ(feed(undisturbed, second, 1.02), feed(disturbed, second, 1.02));
    EXPECT_EQ(disturbed.statistics().lost, undisturbed.statistics().lost);
    EXPECT_EQ(disturbed.statistics().jitterMs, undisturbed.statistics().jitterMs);
    EXPECT_EQ(disturbed.statistics().jumps, 0U);
  }
}

TEST(BadPackets, keepTheNewestReason) {
  HostDecoder decoder;
  feed(decoder, native(16, 1.6), 1);
  feed(decoder, native(8, kInfinity), 2);
  EXPECT_EQ(decoder.statistics().firstBadReason.rfind("byte 16", 0), 0U);
  EXPECT_EQ(decoder.statistics().newestBad->key, "byte 8: longitude");
}

TEST(BadPackets, keepTheFirstInHex) {
  HostDecoder decoder;
  feed(decoder, Bytes{std::byte{0xde}, std::byte{0xad}, std::byte{0x01}}, 1);
  feed(decoder, Bytes(2000, std::byte{0xff}), 2);
  EXPECT_EQ(decoder.statistics().firstBadHex, "de ad 01");
  decoder.reset();
  feed(decoder, Bytes(2000, std::byte{0xff}), 2);
  EXPECT_EQ(decoder.statistics().firstBadHex.size(), 256U * 3 - 1);
}

TEST(BadPackets, withABrokenTailCountForWhatPrecedesIt) {
  for (const std::uint8_t size : std::initializer_list<std::uint8_t>{0, 8 + 4, 200}) {
    Bytes bytes = encodeCigiHost(aState(), 3, 0);
    bytes.resize(bytes.size() + 16);
    bytes[72] = std::byte{77};
    bytes[73] = std::byte{size};
    HostDecoder decoder;
    EXPECT_TRUE(feed(decoder, bytes, 1)) << int{size};
    EXPECT_EQ(decoder.statistics().truncated, 1U);
    EXPECT_EQ(decoder.statistics().bad, 0U);
    EXPECT_EQ(decoder.statistics().firstBadReason.rfind("byte 73: packet size", 0), 0U);
  }
}

TEST(BadPackets, thatSayWhereTheLimitsAreAreFineAtTheLimits) {
  for (const double latitude : {-90.0, 90.0}) {
    for (const double longitude : {-180.0, 180.0}) {
      AircraftState s = aState();
      s.position.latitude = Degrees{latitude};
      s.position.longitude = Degrees{longitude};
      s.attitude = {Degrees{360}, Degrees{latitude}, Degrees{longitude}};
      HostDecoder native, cigi;
      const auto a = feed(native, encodeNativeFdm(s), 1), b = feed(cigi, encodeCigiHost(s, 1, 0), 1);
      ASSERT_TRUE(a && b);
      for (const auto& got : {*a, *b}) {
        EXPECT_EQ(got.position.latitude.value(), latitude);
        EXPECT_EQ(std::abs(got.position.longitude.value()), 180);
        EXPECT_EQ(got.attitude.pitch.value(), latitude);
        EXPECT_NEAR(std::remainder(got.attitude.heading.value(), 360), 0, 1e-4);
      }
    }
  }
}

TEST(BadPackets, ofRandomBytesChangeNothingButACounter) {
  std::mt19937 random(7);
  HostDecoder decoder;
  ASSERT_TRUE(feed(decoder, encodeCigiHost(aFullState(), 1, 0), 1));
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes(random() % 600);
    for (std::byte& b : bytes) b = static_cast<std::byte>(random());
    if (i % 4 == 0 && bytes.size() > 8) {  // far enough to be taken for CIGI
      bytes[0] = std::byte{1};
      if (bytes[1] == std::byte{16} || bytes[1] == std::byte{24}) bytes[1] = std::byte{23};
      bytes[2] = std::byte{3};
      bytes[6] = std::byte{0x80};
      bytes[7] = std::byte{0};
    }
    EXPECT_FALSE(feed(decoder, bytes, 1 + i * 1e-6));
  }
  const HostStatistics& s = decoder.statistics();
  EXPECT_EQ(s.bad, 20000U);
  EXPECT_EQ(s.received, 20001U);
  EXPECT_EQ(s.states, 1U);
  EXPECT_EQ(s.lost, 0U);
  AircraftState next = aState();
  next.time += 0.04;
  const auto got = feed(decoder, encodeCigiHost(next, 2, 0), 1.04);
  ASSERT_TRUE(got);
  EXPECT_EQ(got->head, aFullState().head);
}

}  // namespace
}  // namespace trimtab::test
