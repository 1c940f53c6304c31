#include "other_protocol.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "cigi3.h"
#include "cigi4.h"
#include "native_fdm.h"
#include "x_plane.h"

namespace trimtab {
namespace {

constexpr const char* kSendCigi = "let the host send CIGI 3.3 or 4.0";
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
  const bool old = (major == 1 || major == 2) && size == cigi3::kOldIgControlSize;
  if (id == cigi3::kStartOfFrame && (magic || old))
    return PacketFault{0, "CIGI packet id", "1 (IG Control: a host)",
                       "101 (Start of Frame: an image generator)", kNoHost};
  if (id != cigi3::kIgControl) return std::nullopt;
  if (magic ? major != 3 : old)
    return PacketFault{2, "CIGI major version", "3 or 4", std::to_string(major), kSendCigi};
  // Vendors' variants of version 3 leave the magic out, or have the version a byte later: without the magic
  // the byte order is anybody's guess.
  const bool unmarked = (major == 3 || byteAt(bytes, 3) == 3) && size == cigi3::kIgControlSize &&
                        byteAt(bytes, 6) == 0 && byteAt(bytes, 7) == 0;
  if (unmarked)
    return PacketFault{6, "byte-swap magic of CIGI 3", "80 00 or 00 80", "00 00, a vendor's own layout",
                       "let the host send CIGI 3.3 as published: version 3 at byte 2, magic 8000 "
                       "(hexadecimal) at byte 6"};
  return std::nullopt;
}

std::optional<PacketFault> cigi4Reply(std::span<const std::byte> bytes) {
  if (!cigi4::byteOrder(bytes, cigi4::kStartOfFrame)) return std::nullopt;
  return PacketFault{2, "CIGI packet id", "IG Control of a host", "Start of Frame of CIGI 4", kNoHost};
}

/// FlightGear's native-fdm, native-gui and native-ctrls begin with a version below 64, and programs that
/// imitate them write it in either byte order.
std::optional<PacketFault> flightGear(std::span<const std::byte> bytes) {
  constexpr std::size_t kShortest = 100, kGuiAtMost = 128, kControlsAtLeast = 700;
  constexpr std::uint32_t kVersions = 64, kGui = 8;
  if (bytes.size() < kShortest || bytes.size() % 4 != 0) return std::nullopt;
  const auto big = wire::get<std::uint32_t>(bytes, 0, ByteOrder::big),
             little = wire::get<std::uint32_t>(bytes, 0, ByteOrder::little);
  const bool isBig = big > 0 && big<kVersions, isLittle = little> 0 && little < kVersions;
  if (!isBig && !isLittle) return std::nullopt;
  const std::uint32_t version = isBig ? big : little;
  const bool gui = version == kGui && bytes.size() <= kGuiAtMost, controls = bytes.size() >= kControlsAtLeast;
  if (isBig && version == native_fdm::kVersion && !controls) return std::nullopt;  // damaged
  const std::string name = gui ? "native-gui" : controls ? "native-ctrls" : "native-fdm";
  const char* remedy = "let it send native-fdm version 24, as FlightGear 2020.3 does";
  if (gui || controls)
    remedy = "send native-fdm (--native-fdm=socket,out,60,ADDRESS,PORT,udp), whatever else is sent";
  else if (version == native_fdm::kVersion)
    remedy = "let it write network byte order (big-endian), as FlightGear does";
  return PacketFault{0, "FlightGear protocol", "native-fdm version 24, big-endian, in 408 bytes",
                     name + " version " + std::to_string(version) + (isBig ? ", big" : ", little") +
                         "-endian, in " + std::to_string(bytes.size()) + " bytes",
                     remedy};
}

std::optional<PacketFault> xPlane(std::span<const std::byte> bytes) {
  constexpr std::array<std::string_view, 5> kBegins{"DATA", "RREF", "RPOS", "BECN", "DREF"};
  const auto begins = [bytes](std::string_view magic) {
    return std::equal(magic.begin(), magic.end(), bytes.begin(),
                      [](char c, std::byte b) { return std::to_integer<char>(b) == c; });
  };
  const auto* const found = std::find_if(kBegins.begin(), kBegins.end(), begins);
  if (found == kBegins.end() || x_plane::matches(bytes)) return std::nullopt;
  return PacketFault{0, "X-Plane packet", "RPOS of 69 bytes, or DATA of 5 bytes and 36 a row",
                     std::string(*found) + " of " + std::to_string(bytes.size()) + " bytes",
                     "tick rows 17 and 20 in X-Plane's Data Output, or ask it for RPOS"};
}

}  // namespace

std::optional<PacketFault> otherProtocol(std::span<const std::byte> bytes) {
  if (bytes.size() < 8) return std::nullopt;
  for (const auto recognised : {cigiOfBytes, cigi4Reply, flightGear, xPlane})
    if (auto fault = recognised(bytes)) return fault;
  return std::nullopt;
}

}  // namespace trimtab
