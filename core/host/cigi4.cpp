#include "cigi4.h"

#include <algorithm>
#include <string>

#include "trimtab/host/encoder.h"

namespace trimtab::cigi4 {
namespace {

/// A field of CIGI 4 at byte `at`, and where 3.3 has it. Whole bytes keep their order; `bits` of a byte are
/// moved from bit `bitAt` to `bitIn3`.
struct Field {
  std::uint8_t at, in3, bytes;
  std::uint8_t bitAt = 0, bitIn3 = 0, bits = 8;
};

struct Layout {
  std::uint16_t id, size;
  std::uint8_t idIn3, sizeIn3;
  std::array<Field, 7> fields;  ///< those of no bytes are none
};

constexpr std::uint16_t kEntityPosition = 0x0001, kEntityControl = 0x0025;
/// The first is IG Control. Entity Control has no place of its own in 3.3 and is used only to destroy.
constexpr Layout kLayouts[] = {
    {kIgControl,
     kIgControlSize,
     cigi3::kIgControl,
     cigi3::kIgControlSize,
     {{{5, 3, 1}, {7, 4, 1}, {8, 8, 4}, {12, 16, 4}, {16, 12, 4}}}},
    {kEntityPosition,
     48,
     cigi3::kEntityControl,
     cigi3::kEntityControlSize,
     {{{4, 4, 1, 0, 2, 1}, {4, 4, 1, 1, 5, 2}, {6, 2, 2}, {8, 10, 2}, {12, 12, 36}}}},
    {kEntityControl,
     16,
     cigi3::kEntityControl,
     cigi3::kEntityControlSize,
     {{{4, 4, 1, 0, 0, 2}, {5, 6, 1}, {6, 2, 2}}}},
    {0x0008, 24, 9, 16, {{{4, 4, 1}, {6, 2, 1}, {7, 3, 1}, {12, 8, 4}, {16, 12, 4}}}},  // celestial sphere
    {0x0009,
     32,
     cigi3::kAtmosphereControl,
     cigi3::kAtmosphereControlSize,
     {{{4, 2, 1, 7, 0, 1}, {4, 3, 1, 0, 0, 7}, {8, 4, 24}}}},
    {0x000a, 48, 11, 48, {{{4, 4, 1}, {6, 2, 2}, {8, 8, 36}}}},  // environmental region
    {0x000b,
     72,
     cigi3::kWeatherControl,
     cigi3::kWeatherControlSize,
     {{{4, 4, 1}, {5, 5, 1}, {6, 6, 1}, {7, 7, 1, 0, 0, 5}, {8, 2, 2}, {12, 8, 48}}}},
    {0x000f,
     40,
     cigi3::kViewControl,
     cigi3::kViewControlSize,
     {{{4, 4, 1}, {5, 5, 1}, {6, 2, 2}, {8, 6, 2}, {12, 8, 24}}}},
    {0x0014,
     40,
     cigi3::kViewDefinition,
     cigi3::kViewDefinitionSize,
     {{{4, 2, 2}, {6, 4, 1}, {7, 5, 1}, {8, 6, 1}, {12, 8, 24}}}}};

enum class Direction { to3, from3 };

/// Copies the fields of one packet into the other's, which must be zeroed.
void copy(const Layout& layout, std::span<const std::byte> from, std::span<std::byte> to, Direction way) {
  for (const Field& f : layout.fields) {
    const std::size_t source = way == Direction::to3 ? f.at : f.in3,
                      target = way == Direction::to3 ? f.in3 : f.at;
    if (f.bits == 8) {
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(source), f.bytes,
                  to.begin() + static_cast<std::ptrdiff_t>(target));
    } else {
      const unsigned shift = way == Direction::to3 ? f.bitAt : f.bitIn3,
                     back = way == Direction::to3 ? f.bitIn3 : f.bitAt, mask = (1U << f.bits) - 1;
      to[target] |=
          static_cast<std::byte>(((std::to_integer<unsigned>(from[source]) >> shift) & mask) << back);
    }
  }
}

/// A message of 3.3 that grows, and where each of its packets stood in that of 4.0.
class Rewritten {
 public:
  Rewritten(std::span<const std::byte> bytes, ByteOrder order) : bytes_(bytes), order_(order) {}

  void add(const Layout& layout, std::size_t at) {
    constexpr std::uint8_t kMajor = 3;
    const std::size_t start = message_.size();
    packets_.push_back({&layout, at, start});
    message_.resize(start + layout.sizeIn3);
    const std::span<std::byte> packet = std::span(message_).subspan(start);
    packet[0] = std::byte{layout.idIn3};
    packet[1] = std::byte{layout.sizeIn3};
    copy(layout, bytes_.subspan(at, layout.size), packet, Direction::to3);
    if (layout.id == kEntityPosition) packet[4] |= std::byte{1};  // active
    if (layout.id != kIgControl) return;
    packet[2] = std::byte{kMajor};
    wire::put(packet, 6, order_, cigi3::kByteSwapMagic);
  }
  std::span<const std::byte> message() const { return message_; }

  /// Returns where a byte of the message of 3.3 is in that of 4.0.
  std::size_t placeOf(std::size_t offset) const {
    const auto after = std::upper_bound(packets_.begin(), packets_.end(), offset,
                                        [](std::size_t at, const Packet& p) { return at < p.start; });
    if (after == packets_.begin()) return offset;
    const Packet& packet = *(after - 1);
    const std::size_t inside = offset - packet.start;
    std::size_t place = packet.at;
    for (const Field& f : packet.layout->fields)
      if (inside >= f.in3 && inside < std::size_t{f.in3} + f.bytes)
        place = packet.at + f.at + (inside - f.in3);
    return place;
  }

 private:
  struct Packet {
    const Layout* layout;
    std::size_t at, start;
  };
  std::span<const std::byte> bytes_;
  ByteOrder order_;
  std::vector<std::byte> message_;
  std::vector<Packet> packets_;
};

cigi3::Message refused(PacketFault fault) {
  cigi3::Message message;
  message.fault = std::move(fault);
  return message;
}

}  // namespace

std::optional<ByteOrder> byteOrder(std::span<const std::byte> bytes, std::uint16_t id) {
  constexpr std::size_t kSeen = 5;
  constexpr std::byte kMajor{4};
  if (bytes.size() < kSeen || bytes[4] != kMajor) return std::nullopt;
  for (const ByteOrder order : {ByteOrder::big, ByteOrder::little})
    if (wire::get<std::uint16_t>(bytes, 0, order) == kIgControlSize &&
        wire::get<std::uint16_t>(bytes, 2, order) == id)
      return order;
  return std::nullopt;
}

cigi3::Message parse(std::span<const std::byte> bytes, cigi3::Session& session, const cigi3::Follow& follow) {
  const auto order = byteOrder(bytes, kIgControl);
  if (!order)
    return refused(
        {0, "CIGI 4 message", "IG Control of a host: size 24, id 0, major version 4",
         "something else in its first " + std::to_string(std::min<std::size_t>(bytes.size(), 5)) + " bytes"});
  Rewritten rewritten(bytes, *order);
  std::optional<PacketFault> cutAt, wrongSize;
  int wrongSizes = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    constexpr std::size_t kHeader = 4;
    const std::size_t left = bytes.size() - at;
    const std::size_t size = left >= kHeader ? wire::get<std::uint16_t>(bytes, at, *order) : 0;
    if (size < kHeader || size % 8 != 0 || size > left) {
      cutAt =
          PacketFault{at, "packet size", "a multiple of 8 within the " + std::to_string(left) + " bytes left",
                      left >= kHeader ? std::to_string(size) : "the end"};
      break;
    }
    const auto id = wire::get<std::uint16_t>(bytes, at + 2, *order);
    const auto layout = std::find_if(std::begin(kLayouts), std::end(kLayouts),
                                     [id](const Layout& known) { return known.id == id; });
    if (layout != std::end(kLayouts)) {
      if (size != layout->size) {
        PacketFault fault{at, "size of packet " + std::to_string(id), std::to_string(layout->size),
                          std::to_string(size)};
        if (id == kIgControl) return refused(std::move(fault));
        ++wrongSizes;
        if (!wrongSize) wrongSize = std::move(fault);
        at += size;
        continue;
      }
      constexpr unsigned kState = 3, kDestroyed = 2;
      const bool used =
          id != kEntityControl || (std::to_integer<unsigned>(bytes[at + 4]) & kState) == kDestroyed;
      if (used && (id != kIgControl || at == 0)) rewritten.add(*layout, at);
    }
    at += size;
  }
  if (rewritten.message().empty()) return refused(*cutAt);
  cigi3::Message message = cigi3::parse(rewritten.message(), session, follow);
  for (auto* fault : {&message.fault, &message.refused, &message.ownship})
    if (*fault) (*fault)->offset = rewritten.placeOf((*fault)->offset);
  if (message.otherEntityAt) message.otherEntityAt = rewritten.placeOf(*message.otherEntityAt);
  message.refusedPackets += wrongSizes;
  if (wrongSize && !message.refused) message.refused = std::move(wrongSize);
  message.cutAt = std::move(cutAt);
  return message;
}

std::vector<std::byte> fromCigi3(std::span<const std::byte> message) {
  constexpr std::uint8_t kMajor = 4;
  constexpr unsigned kMinor = 0xf0;
  std::vector<std::byte> out;
  const auto order = cigi3::byteOrder(message).value_or(ByteOrder::big);
  for (std::size_t at = 0; at + 2 <= message.size();) {
    const auto id = std::to_integer<unsigned>(message[at]), size = std::to_integer<unsigned>(message[at + 1]);
    if (size == 0 || size > message.size() - at) break;
    const auto layout = std::find_if(std::begin(kLayouts), std::end(kLayouts), [&](const Layout& known) {
      return known.idIn3 == id && known.sizeIn3 == size;
    });
    if (layout != std::end(kLayouts)) {
      const std::size_t start = out.size();
      out.resize(start + layout->size);
      const std::span<std::byte> packet = std::span(out).subspan(start);
      wire::put(packet, 0, order, layout->size);
      wire::put(packet, 2, order, layout->id);
      copy(*layout, message.subspan(at, size), packet, Direction::from3);
      if (layout->id == kIgControl) {
        packet[4] = std::byte{kMajor};
        packet[7] &= ~std::byte{kMinor};
      }
    }
    at += size;
  }
  return out;
}

}  // namespace trimtab::cigi4

namespace trimtab {

std::vector<std::byte> encodeCigi4Host(const AircraftState& state, std::uint32_t frame,
                                       std::uint32_t lastIgFrame, ByteOrder order) {
  return cigi4::fromCigi3(encodeCigiHost(state, frame, lastIgFrame, order));
}

/// The layout is that of IG Control but for the order of the two last numbers.
std::vector<std::byte> encodeCigi4StartOfFrame(std::uint32_t igFrame, std::uint32_t lastHostFrame,
                                               double timeS, ByteOrder order) {
  const auto of3 = encodeCigiStartOfFrame(igFrame, lastHostFrame, timeS, order);
  std::vector<std::byte> bytes(cigi4::kIgControlSize);
  wire::put(std::span(bytes), 0, order, static_cast<std::uint16_t>(cigi4::kIgControlSize));
  wire::put(std::span(bytes), 2, order, cigi4::kStartOfFrame);
  bytes[4] = std::byte{4};
  bytes[7] = of3[5] & std::byte{0x0f};
  std::copy(of3.begin() + 8, of3.begin() + 20, bytes.begin() + 8);  // both have frame, time, host's frame
  return bytes;
}

}  // namespace trimtab
