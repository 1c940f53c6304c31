#include <algorithm>
#include <cmath>
#include <cstdio>

#include "trimtab/host/byte_order.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

constexpr std::size_t kFileHeader = 24, kRecordHeader = 16;
constexpr std::uint32_t kLongestRecord = 262144, kRawLink = 101;
constexpr std::uint8_t kUdp = 17;

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
  for (std::size_t i = 0; i < kIpHeader; i += 2) sum += wire::get<std::uint16_t>(ip, i, ByteOrder::big);
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
  wire::put(out, 20, ByteOrder::little, kRawLink);
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
