#include "other_protocol.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "cigi3.h"
#include "native_fdm.h"

namespace trimtab {
namespace {

constexpr const char* kSendCigi = "let the host send CIGI 3.3";
constexpr const char* kNoHost = "an image generator replies here: give it the port of its host";

std::uint8_t byteAt(std::span<const std::byte> bytes, std::size_t offset) {
  return std::to_integer<std::uint8_t>(bytes[offset]);
}

/// CIGI 3 and before: `u8 id, u8 size, u8 major`. The magic of the byte order is there since version 3.
std::optional<PacketFault> cigiOfBytes(std::span<const std::byte> bytes) {
  const unsigned id = byteAt(bytes, 0), size = byteAt(bytes, 1), major = byteAt(bytes, 2);
  const bool sized = size == cigi3::kOldIgControlSize || size == cigi3::kIgControlSize;
  if (!sized || size > bytes.size()) return std::nullopt;
  const bool magic = cigi3::byteOrder(bytes).has_value();
  if (id == cigi3::kStartOfFrame && magic)
    return PacketFault{0, "CIGI packet id", "1 (IG Control: a host)",
                       "101 (Start of Frame: an image generator)", kNoHost};
  const bool version = magic ? major != 3 : (major == 1 || major == 2) && size == cigi3::kOldIgControlSize;
  if (id == cigi3::kIgControl && version)
    return PacketFault{2, "CIGI major version", "3", std::to_string(major), kSendCigi};
  return std::nullopt;
}

/// CIGI 4: `u16 size, u16 id, u8 major` in the sender's byte order.
std::optional<PacketFault> cigi4(std::span<const std::byte> bytes) {
  constexpr std::uint16_t kIgControl = 0, kStartOfFrame = 0xffff;
  if (byteAt(bytes, 4) != 4) return std::nullopt;
  for (const ByteOrder order : {ByteOrder::big, ByteOrder::little}) {
    const auto size = wire::get<std::uint16_t>(bytes, 0, order),
               id = wire::get<std::uint16_t>(bytes, 2, order);
    if (size != cigi3::kIgControlSize || size > bytes.size()) continue;
    if (id == kIgControl) return PacketFault{4, "CIGI major version", "3", "4", kSendCigi};
    if (id == kStartOfFrame)
      return PacketFault{2, "CIGI packet id", "IG Control of a host", "Start of Frame of CIGI 4", kNoHost};
  }
  return std::nullopt;
}

/// FlightGear's native-fdm, native-gui and native-ctrls begin with a version below 64, and programs that
/// imitate them write it in either byte order.
std::optional<PacketFault> flightGear(std::span<const std::byte> bytes) {
  constexpr std::size_t kShortest = 100;
  constexpr std::uint32_t kVersions = 64;
  if (bytes.size() < kShortest || bytes.size() % 4 != 0) return std::nullopt;
  const auto big = wire::get<std::uint32_t>(bytes, 0, ByteOrder::big),
             little = wire::get<std::uint32_t>(bytes, 0, ByteOrder::little);
  const bool isBig = big > 0 && big < kVersions && big != native_fdm::kVersion;
  const bool isLittle = little > 0 && little < kVersions;
  if (!isBig && !isLittle) return std::nullopt;
  return PacketFault{0, "native-fdm version", "24, big-endian, in 408 bytes",
                     std::to_string(isBig ? big : little) + (isBig ? ", big" : ", little") + "-endian, in " +
                         std::to_string(bytes.size()) + " bytes",
                     "let the host send native-fdm 24, as FlightGear 2020.3 does, in network byte order"};
}

std::optional<PacketFault> named(const char* name) {
  return PacketFault{0, "protocol", "native-fdm 24 or CIGI 3", name,
                     "let the host, or a bridge, send one of these"};
}

std::optional<PacketFault> xPlane(std::span<const std::byte> bytes) {
  constexpr std::array<std::string_view, 3> kBegins{"DATA", "RREF", "RPOS"};
  const auto begins = [bytes](std::string_view magic) {
    return std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](char c, std::byte b) { return std::to_integer<char>(b) == c; });
  };
  return std::any_of(kBegins.begin(), kBegins.end(), begins) ? named("X-Plane") : std::nullopt;
}

/// DIS: version 4 to 7, exercise, type, family, time stamp, and the length of the whole.
std::optional<PacketFault> dis(std::span<const std::byte> bytes) {
  constexpr std::size_t kHeader = 12;
  const unsigned version = byteAt(bytes, 0);
  if (bytes.size() < kHeader || version < 4 || version > 7 || byteAt(bytes, 3) == 0) return std::nullopt;
  const bool fits = wire::get<std::uint16_t>(bytes, 8, ByteOrder::big) == bytes.size();
  return fits ? named("DIS") : std::nullopt;
}

}  // namespace

std::optional<PacketFault> otherProtocol(std::span<const std::byte> bytes) {
  if (bytes.size() < 8) return std::nullopt;
  for (const auto recognised : {cigiOfBytes, cigi4, flightGear, xPlane, dis})
    if (auto fault = recognised(bytes)) return fault;
  return std::nullopt;
}

}  // namespace trimtab
