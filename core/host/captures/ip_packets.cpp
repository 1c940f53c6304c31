#include "ip_packets.h"

#include <algorithm>

#include "trimtab/host/byte_order.h"

namespace trimtab::capture {
namespace {

constexpr std::uint8_t kUdp = 17;
constexpr std::size_t kIpv6Header = 40;

using Bytes = std::span<const std::byte>;

std::uint8_t u8(Bytes b, std::size_t at) {
  return std::to_integer<std::uint8_t>(b[at]);
}
std::uint16_t u16(Bytes b, std::size_t at) {
  return wire::get<std::uint16_t>(b, at, ByteOrder::big);
}

/// IEEE 802.1Q and 802.1ad (QinQ), and the types that were used before the latter.
bool isVlanTag(std::uint16_t type) {
  return type == 0x8100 || type == 0x88a8 || type == 0x9100 || type == 0x9200;
}

/// Returns the IP packet in a frame; empty if it holds none.
Bytes ipPacket(Bytes frame, std::uint32_t linkType) {
  const auto after = [frame](std::size_t n) { return frame.size() > n ? frame.subspan(n) : Bytes{}; };
  constexpr std::size_t kEthernetHeader = 14, kVlanTag = 4;
  std::size_t header = kEthernetHeader;
  switch (linkType) {
    case kNull:
    case kLoop:
      return after(4);
    case kEthernet:
      while (frame.size() > header && isVlanTag(u16(frame, header - 2))) header += kVlanTag;
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

}  // namespace

std::optional<IpPackets::Packet> IpPackets::ipv4(Bytes ip) {
  constexpr std::size_t kSmallest = 20;
  const std::size_t header = (u8(ip, 0) & 15U) * 4U, length = u16(ip, 2);
  if (header < kSmallest || ip.size() < header) return std::nullopt;
  // Network cards that split packets themselves show them with a length of 0.
  const std::size_t end = length >= header && length <= ip.size() ? length : ip.size();
  const unsigned fragment = u16(ip, 6);
  return Packet{ipv4Text(ip, 12),
                ipv4Text(ip, 16),
                u16(ip, 4),
                (fragment & 0x1fffU) * 8,
                (fragment & 0x2000U) != 0,
                u8(ip, 9) == kUdp,
                ip.subspan(header, end - header)};
}

std::optional<IpPackets::Packet> IpPackets::ipv6(Bytes ip) {
  constexpr unsigned kHopByHop = 0, kRouting = 43, kFragment = 44, kOptions = 60;
  if (ip.size() < kIpv6Header) return std::nullopt;
  Packet packet{.from = ipv6Text(ip, 8), .to = ipv6Text(ip, 24)};
  const std::size_t end = std::min(ip.size(), kIpv6Header + u16(ip, 4));
  unsigned next = u8(ip, 6);
  std::size_t at = kIpv6Header;
  while (at + 8 <= end && (next == kHopByHop || next == kRouting || next == kOptions || next == kFragment)) {
    if (next == kFragment) {
      const unsigned fragment = u16(ip, at + 2);
      packet.offset = fragment & 0xfff8U;
      packet.more = (fragment & 1U) != 0;
      packet.id = wire::get<std::uint32_t>(ip, at + 4, ByteOrder::big);
    }
    const std::size_t header = next == kFragment ? 8 : (u8(ip, at + 1) + 1U) * 8U;
    next = u8(ip, at);
    at += header;
  }
  if (at > end) return std::nullopt;
  packet.isUdp = next == kUdp;
  packet.payload = ip.subspan(at, end - at);
  return packet;
}

bool IpPackets::Gathered::isComplete() const {
  if (!length) return false;
  std::size_t reached = 0;
  for (const auto& [begin, size] : pieces) {
    if (begin > reached) return false;
    reached = std::max(reached, begin + size);
  }
  return reached >= *length;
}

std::optional<std::vector<std::byte>> IpPackets::gather(const Packet& packet) {
  constexpr std::size_t kLongest = 65535, kMostAtOnce = 64;
  if (packet.offset + packet.payload.size() > kLongest) {
    ++dropped_;
    return std::nullopt;
  }
  const Key key{packet.from, packet.to, packet.id};
  if (gathered_.size() >= kMostAtOnce && !gathered_.contains(key)) {
    dropped_ += gathered_.begin()->second.frames;
    gathered_.erase(gathered_.begin());
  }
  Gathered& whole = gathered_[key];
  ++whole.frames;
  const std::size_t end = packet.offset + packet.payload.size();
  if (whole.bytes.size() < end) whole.bytes.resize(end);
  std::copy(packet.payload.begin(), packet.payload.end(),
            whole.bytes.begin() + static_cast<std::ptrdiff_t>(packet.offset));
  whole.pieces[packet.offset] = packet.payload.size();
  if (!packet.more) whole.length = end;
  if (!whole.isComplete()) return std::nullopt;
  std::vector<std::byte> bytes = std::move(whole.bytes);
  bytes.resize(*whole.length);
  gathered_.erase(key);
  return bytes;
}

std::size_t IpPackets::fragmentsLeft() const {
  std::size_t left = dropped_;
  for (const auto& [key, whole] : gathered_) left += whole.frames;
  return left;
}

std::optional<CapturedDatagram> IpPackets::add(const Record& record) {
  constexpr std::size_t kUdpHeader = 8, kSmallest = 20;
  const auto other = [](std::size_t& count) {
    ++count;
    return std::nullopt;
  };
  std::size_t& reason = record.length > record.frame.size() ? cut_ : others_;
  const Bytes ip = ipPacket(record.frame, record.linkType);
  if (ip.size() < kSmallest) return other(reason);
  const unsigned version = u8(ip, 0) >> 4U;
  const auto packet = version == 4 ? ipv4(ip) : version == 6 ? ipv6(ip) : std::nullopt;
  if (!packet) return other(reason);
  if (!packet->isUdp) return other(others_);
  std::vector<std::byte> whole;
  Bytes udp = packet->payload;
  if (packet->isFragment()) {
    if (&reason == &cut_) return other(cut_);
    auto gathered = gather(*packet);
    if (!gathered) return std::nullopt;
    whole = std::move(*gathered);
    udp = whole;
  }
  if (udp.size() < kUdpHeader) return other(reason);
  const std::size_t length = u16(udp, 4);
  if (length < kUdpHeader || length > udp.size()) return other(reason);
  CapturedDatagram datagram;
  datagram.time = record.time;
  datagram.from = packet->from + ':' + std::to_string(u16(udp, 0));
  datagram.to = packet->to + ':' + std::to_string(u16(udp, 2));
  datagram.bytes.assign(udp.begin() + kUdpHeader, udp.begin() + static_cast<std::ptrdiff_t>(length));
  return datagram;
}

}  // namespace trimtab::capture
