#include <gmock/gmock.h>

#include <functional>

#include "host_support.h"
#include "tests/support.h"

/// Datagrams that are undamaged, but not for an image generator that follows a host.
namespace trimtab::test {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::byte>;

/// The datagram of a file of hexadecimal digits.
Bytes shared(const std::string& name) {
  const std::string digits = readFile(sharedDir() / "cases/hosts/udp" / name);
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < digits.size() && std::isxdigit(static_cast<unsigned char>(digits[i])) != 0;
       i += 2)
    bytes.push_back(static_cast<std::byte>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  return bytes;
}

Bytes altered(Bytes bytes, std::size_t offset, auto value, ByteOrder order = ByteOrder::big) {
  wire::put(bytes, offset, order, value);
  return bytes;
}
Bytes entityOnly(std::uint16_t entity) {
  return altered(encodeCigiHost(aState(), 9, 0), 26, entity, ByteOrder::big);
}
Bytes text(const std::string& begin) {
  Bytes bytes(41);
  for (std::size_t i = 0; i < begin.size(); ++i) bytes[i] = static_cast<std::byte>(begin[i]);
  return bytes;
}

struct SomeoneElses {
  const char* name;
  std::function<Bytes()> make;
  const char* reason;
};

void expectForSomeoneElse(const SomeoneElses& c, const Bytes& bytes) {
  SCOPED_TRACE(c.name);
  HostDecoder decoder;
  EXPECT_FALSE(feed(decoder, bytes, 1));
  const HostStatistics& s = decoder.statistics();
  EXPECT_EQ(s.notForUs, 1U);
  EXPECT_EQ(s.bad, 0U);
  EXPECT_EQ(s.states, 0U);
  ASSERT_TRUE(s.newestNotForUs);
  const std::string line = toString(*s.newestNotForUs);
  EXPECT_THAT(line, testing::StartsWith("127.0.0.1:8004: byte "));
  EXPECT_THAT(line, HasSubstr(c.reason));
  EXPECT_THAT(line, HasSubstr("; ")) << "what to do";
}

TEST(OtherProtocol, isCountedApartAndSaysWhatToDo) {
  const SomeoneElses cases[] = {
      {"native-fdm 25", [] { return altered(encodeNativeFdm(aState()), 0, std::uint32_t{25}); },
       "byte 0: FlightGear protocol: expected native-fdm version 24, big-endian, in 408 bytes, found "
       "native-fdm version 25, big-endian, in 408 bytes; let it send native-fdm version 24"},
      {"little-endian",
       [] { return altered(encodeNativeFdm(aState()), 0, std::uint32_t{24}, ByteOrder::little); },
       "found native-fdm version 24, little-endian, in 408 bytes; let it write network byte order"},
      {"native-gui", [] { return altered(Bytes(112), 0, std::uint32_t{8}); },
       "found native-gui version 8, big-endian, in 112 bytes; send native-fdm (--native-fdm=socket"},
      {"native-ctrls", [] { return altered(Bytes(744), 0, std::uint32_t{27}); },
       "found native-ctrls version 27, big-endian, in 744 bytes; send native-fdm"},
      {"CIGI 4 in the layout of 3",
       [] { return altered(encodeCigiHost(aState(), 1, 0), 2, std::uint8_t{4}); },
       "byte 2: CIGI major version: expected 3 or 4, found 4; let the host send CIGI 3.3 or 4.0"},
      {"CIGI 3 without its magic",
       [] { return altered(encodeCigiHost(aState(), 1, 0), 6, std::uint16_t{0}); },
       "byte 6: byte-swap magic of CIGI 3: expected 80 00 or 00 80, found 00 00, a vendor's own layout; let"},
      {"CIGI 3 with its version at byte 3",
       [] {
         return altered(altered(encodeCigiHost(aState(), 1, 0), 6, std::uint16_t{0}), 2,
                        std::uint16_t{0x0103});
       },
       "byte 6: byte-swap magic of CIGI 3"},
      {"Start of Frame of CIGI 2",
       [] {
         return altered(altered(altered(Bytes(16), 0, std::uint8_t{101}), 1, std::uint8_t{16}), 2,
                        std::uint8_t{2});
       },
       "byte 0: CIGI packet id: expected 1 (IG Control: a host), found 101"},
      {"Start of Frame of CIGI 4", [] { return encodeCigi4StartOfFrame(1, 0, 0); },
       "found Start of Frame of CIGI 4; an image generator replies here"},
      {"Start of Frame", [] { return encodeCigiStartOfFrame(1, 0, 0); },
       "byte 0: CIGI packet id: expected 1 (IG Control: a host), found 101"},
      {"DIS", [] { return altered(text(std::string("\x06\x01\x02\x02", 4)), 8, std::uint16_t{41}); },
       "byte 2: type of DIS PDU: expected 1 (Entity State), found 2"},
      {"another entity", [] { return entityOnly(1); },
       "byte 26: entity: expected 0, the own aircraft, found no entity 0; seen: 1; --entity, or host.entity"},
  };
  for (const SomeoneElses& c : cases) expectForSomeoneElse(c, c.make());
}

TEST(OtherProtocol, isToldOfRealPrograms) {
  TRIMTAB_NEEDS_SHARED("cases/hosts/udp");
  const SomeoneElses cases[] = {
      {"cigi22.hex", {}, "CIGI major version: expected 3 or 4, found 2"},
      {"cigi4_be.hex", {}, "byte 30: entity: expected 0, the own aircraft, found no entity 0; seen: 256; --entity"},
      {"cigi4_le.hex", {}, "byte 30: entity: expected 0, the own aircraft, found no entity 0; seen: 1; --entity"},
      {"cigi_trillium_layout.hex", {}, "found 00 00, a vendor's own layout"},
      {"fdm_v25_552.hex", {}, "found native-fdm version 25, big-endian, in 552 bytes"},
      {"fdm_v24_little_endian.hex", {}, "found native-fdm version 24, little-endian, in 408 bytes"},
      {"gui_v8_paparazzi_little_endian.hex", {}, "found native-gui version 8, little-endian, in 112 bytes"},
      {"cigi_entity_1_only_skybolt.hex", {}, "entity: expected 0, the own aircraft, found no entity 0; seen: 1; --entity"},
  };
  for (const SomeoneElses& c : cases) expectForSomeoneElse(c, shared(c.name));
}

TEST(OtherProtocol, isNotSeenInWhatIsDamaged) {
  HostDecoder decoder;
  std::uint64_t sent = 0;
  const auto expectBad = [&](const Bytes& bytes) {
    feed(decoder, bytes, 1);
    EXPECT_EQ(decoder.statistics().bad, ++sent);
  };
  expectBad(text(std::string("\x06\x01\x01\x01", 4)));  // DIS of another length
  expectBad(text("DAT"));
  expectBad(altered(encodeCigiStartOfFrame(1, 0, 0), 1, std::uint8_t{23}));
  expectBad(Bytes(408));
  expectBad(altered(Bytes(96), 0, std::uint32_t{25}));
  EXPECT_EQ(decoder.statistics().notForUs, 0U);
}

TEST(OtherProtocol, isNotAnotherEntityBesideTheOwnship) {
  HostDecoder decoder;
  auto both = encodeCigiHost(aState(), 1, 0);
  const auto entity = entityOnly(7);
  both.insert(both.end(), entity.begin() + 24, entity.begin() + 72);
  EXPECT_TRUE(feed(decoder, both, 1));
  EXPECT_EQ(decoder.statistics().notForUs, 0U);
}

TEST(HostDecoder, saysWhichProtocolCameInPlaceOfTheOneThatWasAskedFor) {
  HostDecoder cigi(HostProtocol::cigi3), native(HostProtocol::native_fdm);
  feed(cigi, encodeNativeFdm(aState()), 1);
  EXPECT_THAT(
      toString(*cigi.statistics().newestBad),
      HasSubstr("protocol: expected CIGI 3, as was asked for, found FlightGear native-fdm 24; ask for"));
  feed(native, encodeCigiHost(aState(), 1, 0), 1);
  EXPECT_THAT(toString(*native.statistics().newestBad), HasSubstr("found CIGI 3; ask for"));
}

TEST(HostDecoder, saysWhyAHostsOwnDatagramsLeadToNoState) {
  const auto why = [](const HostDecoder& decoder) {
    const auto& newest = decoder.statistics().newestUnused;
    return newest ? toString(*newest) : std::string("nothing");
  };
  HostDecoder waiting;
  Bytes control = encodeCigiHost(aState(), 1, 0);
  control.resize(24);
  feed(waiting, control, 1);
  EXPECT_THAT(why(waiting), HasSubstr("Entity Control: expected entity 0, the own aircraft, found none"));
  EXPECT_EQ(waiting.statistics().notForUs, 0U);
  feed(waiting, encodeCigiHost(aState(), 2, 0), 1.02);
  EXPECT_EQ(why(waiting), "nothing") << "a state followed";
  feed(waiting, encodeCigiHost(aState(), 2, 0), 1.04);
  EXPECT_THAT(why(waiting),
              HasSubstr("frame number of IG Control: expected one that rises, above 2, found 2"));

  HostDecoder early;
  AircraftState s = aState();
  s.position.height = Feet{-9999}.as<Metres>();
  feed(early, encodeNativeFdm(s), 1);
  EXPECT_THAT(why(early), HasSubstr("altitude: expected at least -1,000 ft, found -9999 ft"));
}

}  // namespace
}  // namespace trimtab::test
