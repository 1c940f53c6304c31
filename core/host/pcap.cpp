#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "trimtab/host/byte_order.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

constexpr std::size_t kFileHeader = 24, kRecordHeader = 16;
constexpr std::uint32_t kLongestRecord = 262144;
constexpr std::uint8_t kUdp = 17;

enum LinkType : std::uint32_t {
  kNull = 0,
  kEthernet = 1,
  kRawBsd = 12,
  kRaw = 101,
  kLoop = 108,
  kCooked = 113,
  kIpv4 = 228,
  kIpv6 = 229,
  kCooked2 = 276
};

using Bytes = std::span<const std::byte>;

std::uint8_t u8(Bytes b, std::size_t at) {
  return std::to_integer<std::uint8_t>(b[at]);
}
std::uint16_t u16(Bytes b, std::size_t at) {
  return wire::get<std::uint16_t>(b, at, ByteOrder::big);
}

/// Returns the IP packet in a frame; empty if it holds none.
Bytes ipPacket(Bytes frame, std::uint32_t linkType) {
  const auto after = [frame](std::size_t n) { return frame.size() > n ? frame.subspan(n) : Bytes{}; };
  constexpr std::size_t kEthernetHeader = 14, kVlanTag = 4;
  std::size_t header = 0;
  switch (linkType) {
    case kNull:
    case kLoop:
      return after(4);
    case kEthernet:
      for (header = kEthernetHeader; frame.size() > header && u16(frame, header - 2) == 0x8100;)
        header += kVlanTag;
      return after(header);
    case kCooked:
      return after(16);
    case kCooked2:
      return after(20);
    default:
      return frame;
  }
}

std::string ipv4Text(Bytes b, std::size_t at) {
  std::string text;
  for (std::size_t i = 0; i < 4; ++i) text += (i > 0 ? "." : "") + std::to_string(u8(b, at + i));
  return text;
}

std::string ipv6Text(Bytes b, std::size_t at) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "[";
  for (std::size_t i = 0; i < 8; ++i) {
    if (i > 0) text += ':';
    const unsigned group = u16(b, at + 2 * i);
    for (int shift = 12; shift >= 0; shift -= 4) text += kDigits[(group >> shift) & 15U];
  }
  return text + ']';
}

/// Fills addresses and payload; false for what is not a whole UDP datagram.
bool udpPayload(Bytes ip, CapturedDatagram& datagram) {
  constexpr std::size_t kUdpHeader = 8, kIpv6Header = 40;
  if (ip.size() < 20) return false;
  const unsigned version = u8(ip, 0) >> 4U;
  std::size_t header = 0;
  if (version == 4) {
    header = (u8(ip, 0) & 15U) * 4U;
    const bool fragment = (u16(ip, 6) & 0x3fffU) != 0;
    if (header < 20 || fragment || u8(ip, 9) != kUdp) return false;
    datagram.from = ipv4Text(ip, 12);
    datagram.to = ipv4Text(ip, 16);
  } else if (version == 6 && ip.size() >= kIpv6Header && u8(ip, 6) == kUdp) {
    header = kIpv6Header;
    datagram.from = ipv6Text(ip, 8);
    datagram.to = ipv6Text(ip, 24);
  } else {
    return false;
  }
  if (ip.size() < header + kUdpHeader) return false;
  const std::size_t length = u16(ip, header + 4);
  if (length < kUdpHeader || header + length > ip.size()) return false;
  datagram.from += ':' + std::to_string(u16(ip, header));
  datagram.to += ':' + std::to_string(u16(ip, header + 2));
  const Bytes payload = ip.subspan(header + kUdpHeader, length - kUdpHeader);
  datagram.bytes.assign(payload.begin(), payload.end());
  return true;
}

bool knownLink(std::uint32_t type) {
  for (const std::uint32_t known : {kNull, kEthernet, kRawBsd, kRaw, kLoop, kCooked, kIpv4, kIpv6, kCooked2})
    if (type == known) return true;
  return false;
}

}  // namespace

Result<std::vector<CapturedDatagram>> parsePcap(std::string_view text, const std::string& where) {
  const Bytes bytes = std::as_bytes(std::span(text));
  if (bytes.size() < kFileHeader)
    return Finding{Severity::error, where, "", "a pcap file header of 24 bytes",
                   std::to_string(bytes.size()) + " bytes"};
  const auto magic = wire::get<std::uint32_t>(bytes, 0, ByteOrder::big);
  constexpr std::uint32_t kMicro = 0xa1b2c3d4, kMicroSwapped = 0xd4c3b2a1, kNano = 0xa1b23c4d,
                          kNanoSwapped = 0x4d3cb2a1, kNewFormat = 0x0a0d0d0a;
  if (magic == kNewFormat)
    return Finding{Severity::error, where, "",
                   "a classic pcap file (convert it with: editcap -F pcap IN OUT)", "pcapng"};
  if (magic != kMicro && magic != kMicroSwapped && magic != kNano && magic != kNanoSwapped)
    return Finding{Severity::error, where + ":byte 0", "magic", "a1b2c3d4 or a1b23c4d in either order",
                   "something else"};
  const ByteOrder order = magic == kMicro || magic == kNano ? ByteOrder::big : ByteOrder::little;
  const double fraction = magic == kNano || magic == kNanoSwapped ? 1e-9 : 1e-6;
  const std::uint32_t linkType = wire::get<std::uint32_t>(bytes, 20, order) & 0xffffU;
  if (!knownLink(linkType))
    return Finding{Severity::error, where + ":byte 20", "link type",
                   "Ethernet (1), raw IP (101), Linux cooked (113, 276) or BSD loopback (0)",
                   std::to_string(linkType)};

  std::vector<CapturedDatagram> datagrams;
  Findings notes;
  std::size_t others = 0;
  for (std::size_t at = kFileHeader; at < bytes.size();) {
    const std::string place = where + ":byte " + std::to_string(at);
    const std::size_t left = bytes.size() - at;
    const std::uint32_t length = left >= kRecordHeader ? wire::get<std::uint32_t>(bytes, at + 8, order) : 0;
    if (left >= kRecordHeader && length > kLongestRecord)
      return Finding{Severity::error, place, "record length", "at most 262144 bytes", std::to_string(length)};
    if (left < kRecordHeader + length) {
      notes.push_back({Severity::warning, place, "last record",
                       std::to_string(kRecordHeader + length) + " bytes",
                       std::to_string(left) + ": the file was cut; what precedes is used"});
      break;
    }
    CapturedDatagram datagram;
    datagram.time = wire::get<std::uint32_t>(bytes, at, order) +
                    wire::get<std::uint32_t>(bytes, at + 4, order) * fraction;
    if (udpPayload(ipPacket(bytes.subspan(at + kRecordHeader, length), linkType), datagram))
      datagrams.push_back(std::move(datagram));
    else
      ++others;
    at += kRecordHeader + length;
  }
  if (others > 0)
    notes.push_back({Severity::note, where, "", "",
                     std::to_string(others) + " frames that are no whole UDP datagram, passed over"});
  return {std::move(datagrams), std::move(notes)};
}

Result<std::vector<CapturedDatagram>> readPcap(const std::filesystem::path& file) {
  return withinMemory(file, [&]() -> Result<std::vector<CapturedDatagram>> {
    const Result<std::string> bytes = readWhole(file, kLargestRecording);
    if (!bytes) return bytes.findings();
    return parsePcap(*bytes, file.string());
  });
}

namespace {

struct Ipv4Endpoint {
  std::uint8_t address[4] = {127, 0, 0, 1};
  std::uint16_t port = 0;
};

/// "a.b.c.d:port"; what is not of this form becomes the loopback address.
Ipv4Endpoint endpoint(const std::string& text) {
  unsigned a = 127, b = 0, c = 0, d = 1, port = 0;
  if (std::sscanf(text.c_str(), "%3u.%3u.%3u.%3u:%5u", &a, &b, &c, &d, &port) != 5 || (a | b | c | d) > 255) {
    a = 127, b = 0, c = 0, d = 1;
  }
  const auto octet = [](unsigned v) { return static_cast<std::uint8_t>(v); };
  return {{octet(a), octet(b), octet(c), octet(d)}, static_cast<std::uint16_t>(port)};
}

std::string asText(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void appendRecord(std::vector<std::byte>& out, const CapturedDatagram& datagram) {
  constexpr std::size_t kIpHeader = 20, kUdpHeader = 8;
  const std::size_t length = kIpHeader + kUdpHeader + datagram.bytes.size();
  const std::size_t at = out.size();
  out.resize(at + kRecordHeader + length);
  const std::span<std::byte> record = std::span(out).subspan(at);
  const auto micros = static_cast<std::uint64_t>(std::llround(std::max(datagram.time, 0.0) * 1e6));
  const auto little = [&](std::size_t offset, std::uint64_t v) {
    wire::put(record, offset, ByteOrder::little, static_cast<std::uint32_t>(v));
  };
  little(0, micros / 1000000);
  little(4, micros % 1000000);
  little(8, length);
  little(12, length);

  const std::span<std::byte> ip = record.subspan(kRecordHeader);
  const auto put16 = [&](std::size_t offset, std::size_t v) {
    wire::put(ip, offset, ByteOrder::big, static_cast<std::uint16_t>(v));
  };
  const auto put8 = [&](std::size_t offset, std::uint8_t v) { ip[offset] = std::byte{v}; };
  const Ipv4Endpoint from = endpoint(datagram.from), to = endpoint(datagram.to);
  constexpr std::uint8_t kVersionAndLength = 0x45, kTimeToLive = 64;
  put8(0, kVersionAndLength);
  put16(2, length);
  put16(6, 0x4000);  // do not fragment
  put8(8, kTimeToLive);
  put8(9, kUdp);
  for (std::size_t i = 0; i < 4; ++i) {
    put8(12 + i, from.address[i]);
    put8(16 + i, to.address[i]);
  }
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < kIpHeader; i += 2) sum += u16(ip, i);
  while (sum > 0xffff) sum = (sum & 0xffffU) + (sum >> 16U);
  put16(10, ~sum & 0xffffU);
  put16(20, from.port);
  put16(22, to.port);
  put16(24, kUdpHeader + datagram.bytes.size());  // checksum 0: none, as IPv4 allows
  std::copy(datagram.bytes.begin(), datagram.bytes.end(), ip.begin() + kIpHeader + kUdpHeader);
}

}  // namespace

std::string pcapHeader() {
  constexpr std::uint32_t kMagic = 0xa1b2c3d4;
  std::vector<std::byte> out(kFileHeader);
  wire::put(out, 0, ByteOrder::little, kMagic);
  wire::put(out, 4, ByteOrder::little, std::uint16_t{2});
  wire::put(out, 6, ByteOrder::little, std::uint16_t{4});
  wire::put(out, 16, ByteOrder::little, kLongestRecord);
  wire::put(out, 20, ByteOrder::little, std::uint32_t{kRaw});
  return asText(out);
}

Result<std::string> pcapRecords(std::span<const CapturedDatagram> datagrams, const std::string& where) {
  constexpr std::size_t kLongestPayload = 65507;
  std::vector<std::byte> out;
  for (const CapturedDatagram& datagram : datagrams) {
    if (datagram.bytes.size() > kLongestPayload)
      return Finding{Severity::error, where, "datagram", "at most 65507 bytes",
                     std::to_string(datagram.bytes.size())};
    appendRecord(out, datagram);
  }
  return asText(out);
}

Result<Done> writePcap(const std::filesystem::path& file, std::span<const CapturedDatagram> datagrams) {
  const Result<std::string> records = pcapRecords(datagrams, file.string());
  if (!records) return records.findings();
  return writeAtomically(file, pcapHeader() + *records);
}

}  // namespace trimtab
