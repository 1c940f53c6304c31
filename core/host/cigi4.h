#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cigi3.h"

/// CIGI 4.0: messages of packets `u16 size, u16 id, ...` in the sender's byte order. What an image generator
/// needs of it are the fields of CIGI 3.3 in other places, so that a message is rewritten as one of 3.3 and
/// read by the rules of cigi3.h. Layouts: CIGI Class Library 4.0, the Pack() of each packet.
namespace trimtab::cigi4 {

inline constexpr std::size_t kIgControlSize = 24;
inline constexpr std::uint16_t kIgControl = 0, kStartOfFrame = 0xffff;

/// Returns the byte order of a message that begins with a packet `id` of CIGI 4; nothing if it does not.
std::optional<ByteOrder> byteOrder(std::span<const std::byte> bytes, std::uint16_t id);
/// Reads a host's message as cigi3::parse does; byte offsets of faults are those of `bytes`.
cigi3::Message parse(std::span<const std::byte> bytes, cigi3::Session& session,
                     const cigi3::Follow& follow = {});
/// Returns a host's CIGI 3.3 message as one of CIGI 4.0. Packets without a counterpart here are left out.
std::vector<std::byte> fromCigi3(std::span<const std::byte> message);

}  // namespace trimtab::cigi4
