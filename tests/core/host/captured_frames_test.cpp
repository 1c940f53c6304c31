#include <gmock/gmock.h>

#include "host_support.h"
#include "tests/support.h"
#include "trimtab/host/flight.h"
#include "wire_writer.h"

/// Captures as tools write them: tags, fragments, cut frames, and pcapng in every form.
namespace trimtab::test {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::byte>;

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Bytes udp(const Bytes& payload) {
  WireWriter w(ByteOrder::big);
  w.begin(8).u16(0, 40123).u16(2, 8004).u16(4, static_cast<unsigned>(8 + payload.size()));
  return joined({w.bytes, payload});
}
Bytes ipv4(const Bytes& part, unsigned id = 0, unsigned fragment = 0, unsigned last = 7) {
  WireWriter w(ByteOrder::big);
  w.begin(20).u8(0, 0x45).u16(2, static_cast<unsigned>(20 + part.size())).u16(4, id).u16(6, fragment);
  w.u8(8, 64).u8(9, 17).u32(12, 0x0a010200 + last).u32(16, 0x0a010209);
  return joined({w.bytes, part});
}
Bytes ethernet(const Bytes& ip, std::initializer_list<unsigned> tags = {}, unsigned type = 0x0800) {
  WireWriter w(ByteOrder::big);
  w.begin(12);
  for (const unsigned tag : tags) w.begin(4).u16(0, tag).u16(2, 100);
  w.begin(2).u16(0, type);
  return joined({w.bytes, ip});
}
/// A classic capture; a frame shows its first `snap` bytes.
std::string classic(const std::vector<Bytes>& frames, std::uint32_t link = 1, std::size_t snap = 65535) {
  WireWriter w(ByteOrder::little);
  w.begin(24).u32(0, 0xa1b2c3d4).u16(4, 2).u16(6, 4).u32(16, 65535).u32(20, link);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto kept = std::min(snap, frames[i].size());
    w.begin(16).u32(0, static_cast<std::uint32_t>(1000 + i)).u32(8, static_cast<std::uint32_t>(kept));
    w.u32(12, static_cast<std::uint32_t>(frames[i].size()));
    w.bytes.insert(w.bytes.end(), frames[i].begin(), frames[i].begin() + static_cast<std::ptrdiff_t>(kept));
  }
  return {reinterpret_cast<const char*>(w.bytes.data()), w.bytes.size()};
}
Bytes numbered(std::size_t size) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 7 + i / 256);
  return bytes;
}
Bytes piece(const Bytes& whole, std::size_t from, std::size_t to) {
  return {whole.begin() + static_cast<std::ptrdiff_t>(from), whole.begin() + static_cast<std::ptrdiff_t>(to)};
}

TEST(CapturedFrames, tagsOfVirtualNetworksAreTakenOff) {
  const Bytes payload = numbered(72);
  const auto got = parsePcap(classic({ethernet(ipv4(udp(payload))), ethernet(ipv4(udp(payload)), {0x8100}),
                                      ethernet(ipv4(udp(payload)), {0x88a8, 0x8100}),
                                      ethernet(ipv4(udp(payload)), {0x9100, 0x8100, 0x8100})}),
                             "x.pcap");
  ASSERT_TRUE(got) << toString(got.findings());
  ASSERT_EQ(got->size(), 4U) << toString(got.findings());
  for (const CapturedDatagram& d : *got) {
    EXPECT_EQ(d.bytes, payload);
    EXPECT_EQ(d.from, "10.1.2.7:40123");
    EXPECT_EQ(d.to, "10.1.2.9:8004");
  }
}

TEST(CapturedFrames, fragmentsArePutTogetherInAnyOrder) {
  const Bytes payload = numbered(3000), whole = udp(payload);
  constexpr unsigned kMore = 0x2000;
  const Bytes a = ipv4(piece(whole, 0, 1480), 77, kMore), b = ipv4(piece(whole, 1480, 2960), 77, kMore | 185),
              c = ipv4(piece(whole, 2960, whole.size()), 77, 370);
  const Bytes other = ipv4(piece(whole, 0, 1480), 77, kMore, 8);
  for (const auto& frames :
       {std::vector{a, b, c}, std::vector{c, a, b}, std::vector{b, other, c, a}, std::vector{a, a, c, b}}) {
    const auto got = parsePcap(classic(frames, 101), "x.pcap");
    ASSERT_TRUE(got);
    ASSERT_EQ(got->size(), 1U);
    EXPECT_EQ(got->front().bytes, payload);
  }
  const auto missing = parsePcap(classic({a, c, ipv4(udp(numbered(8)))}, 101), "x.pcap");
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->size(), 1U);
  EXPECT_THAT(toString(missing.findings()), HasSubstr("2 fragments of IP whose other parts are missing"));
}

TEST(CapturedFrames, fragmentsAndOptionsOfIpv6AreRead) {
  const Bytes payload = numbered(2000), whole = udp(payload);
  const auto ipv6 = [](const Bytes& part, unsigned offset, bool more) {
    WireWriter w(ByteOrder::big);
    w.begin(40).u32(0, 0x60000000).u16(4, static_cast<unsigned>(16 + part.size())).u8(6, 0).u8(7, 64);
    w.u16(8, 0xfe80).u16(22, 1).u16(24, 0xff02).u16(38, 2);
    w.begin(8).u8(0, 44);                                               // hop by hop, empty
    w.begin(8).u8(0, 17).u16(2, offset | (more ? 1U : 0U)).u32(4, 99);  // fragment
    return joined({w.bytes, part});
  };
  const auto got =
      parsePcap(classic({ethernet(ipv6(piece(whole, 1448, whole.size()), 1448, false), {}, 0x86dd),
                         ethernet(ipv6(piece(whole, 0, 1448), 0, true), {}, 0x86dd)}),
                "x.pcap");
  ASSERT_TRUE(got);
  ASSERT_EQ(got->size(), 1U) << toString(got.findings());
  EXPECT_EQ(got->front().bytes, payload);
  EXPECT_EQ(got->front().from, "[fe80:0000:0000:0000:0000:0000:0000:0001]:40123");
}

TEST(CapturedFrames, thoseThatTheCaptureCutAreSaid) {
  const auto got = parsePcap(
      classic({ethernet(ipv4(udp(numbered(400)))), ethernet(ipv4(udp(numbered(10))))}, 1, 96), "x.pcap");
  ASSERT_TRUE(got);
  EXPECT_EQ(got->size(), 1U);
  EXPECT_THAT(
      toString(got.findings()),
      HasSubstr("1 frames were cut by the capture, the longest of 442 bytes to 96, and are passed over; "
                "capture whole frames"));
}

TEST(CapturedFrames, pcapngIsReadInEitherOrderWithItsClocksAndInterfaces) {
  const Bytes payload = numbered(33);
  for (const ByteOrder order : {ByteOrder::big, ByteOrder::little}) {
    WireWriter w(order);
    const auto block = [&w](std::uint32_t type, std::size_t body) -> WireWriter& {
      const auto size = static_cast<std::uint32_t>(body + 12);
      w.begin(size).u32(0, type).u32(4, size).u32(size - 4, size);
      return w;
    };
    const auto packet = [&](std::uint32_t interface, std::uint64_t ticks, const Bytes& frame) {
      const std::size_t room = (frame.size() + 3) / 4 * 4, start = w.bytes.size();
      block(6, 20 + room).u32(8, interface).u32(12, static_cast<std::uint32_t>(ticks >> 32U));
      w.u32(16, static_cast<std::uint32_t>(ticks)).u32(20, static_cast<std::uint32_t>(frame.size()));
      w.u32(24, static_cast<std::uint32_t>(frame.size()));
      std::copy(frame.begin(), frame.end(), w.bytes.begin() + static_cast<std::ptrdiff_t>(start + 28));
    };
    const auto section = [&] {
      block(0x0a0d0d0a, 16).u32(8, 0x1a2b3c4d).u16(12, 1).u32(16, ~0U).u32(20, ~0U);
    };
    section();
    block(1, 8).u16(8, 1);                                                 // microseconds
    block(1, 8 + 8 + 12 + 4).u16(8, 101).u16(16, 9).u16(18, 1).u8(20, 9);  // nanoseconds,
    w.u16(24, 14).u16(26, 8).put(28, std::int64_t{500});                   // from 500 s on
    block(1, 8).u16(8, 147);                                               // of users' own
    block(4, 16);                                                          // names
    packet(0, 1234567890000001ULL, ethernet(ipv4(udp(payload))));
    packet(1, 6000000000ULL, ipv4(udp(payload)));
    packet(2, 1, ipv4(udp(payload)));
    block(3, 4 + 40).u32(8, 40);  // a simple packet
    section();
    block(1, 8 + 8).u16(8, 101).u16(16, 9).u16(18, 1).u8(20, 0x80 | 10);  // 1024ths
    packet(0, 2560, ipv4(udp(payload)));
    const std::string text(reinterpret_cast<const char*>(w.bytes.data()), w.bytes.size());
    const auto got = parsePcap(text, "x.pcapng");
    ASSERT_TRUE(got) << toString(got.findings());
    ASSERT_EQ(got->size(), 3U) << toString(got.findings());
    EXPECT_NEAR((*got)[0].time, 1234567890.000001, 1e-6);
    EXPECT_NEAR((*got)[1].time, 506, 1e-9);
    EXPECT_NEAR((*got)[2].time, 2.5, 1e-12);
    for (const CapturedDatagram& d : *got) EXPECT_EQ(d.bytes, payload);
    EXPECT_THAT(toString(got.findings()), HasSubstr("1 packets without a time"));
    EXPECT_THAT(toString(got.findings()), HasSubstr("1 packets of interfaces with another link type"));
    const auto cut = parsePcap(text.substr(0, text.size() - 10), "x.pcapng");
    ASSERT_TRUE(cut);
    EXPECT_EQ(cut->size(), 2U);
    EXPECT_THAT(toString(cut.findings()), HasSubstr("the file was cut; what precedes is used"));
  }
}

TEST(CapturedFrames, packedFilesSayHowToUnpackThem) {
  ScratchDir dir;
  for (const auto& [begin, tool] : {std::pair{std::string("\x1f\x8b\x08\x00", 4), "gunzip"},
                                    std::pair{std::string("\x28\xb5\x2f\xfd", 4), "unzstd"},
                                    std::pair{std::string("\xfd"
                                                          "7zXZ",
                                                          5),
                                              "unxz"}}) {
    writeFile(dir / "x.pcap.gz", begin + std::string(60, 'x'));
    const auto refused = readFlight(dir / "x.pcap.gz");
    ASSERT_FALSE(refused);
    EXPECT_THAT(toString(refused.findings()), HasSubstr(std::string("unpack it first: ") + tool));
  }
}

}  // namespace
}  // namespace trimtab::test
