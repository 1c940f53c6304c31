#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "packet_fault.h"

namespace trimtab {

/// Recognises what other programs of a simulator send, undamaged, but not as a host to us: another version of
/// CIGI or of FlightGear's native protocols, an image generator's own messages, other packets of X-Plane.
/// Returns what it is, what was expected in its place and what to do; nothing for a host's packet that is
/// good or damaged, and for all that is not known.
std::optional<PacketFault> otherProtocol(std::span<const std::byte> bytes);

}  // namespace trimtab
