#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "packet_fault.h"
#include "trimtab/frame/frame.h"

/// X-Plane's RPOS and DATA packets, little-endian, without frame number or time. RPOS has doubles and metres;
/// DATA has floats, which place an aircraft to about a metre, in rows that its user ticks.
namespace trimtab::x_plane {

enum Row : std::uint32_t { kAttitudeRow = 17, kPositionRow = 20 };

/// What the rows of DATA have said so far: they may come in several datagrams.
struct Session {
  std::optional<GeodeticPosition> position;
  std::optional<Attitude> attitude;
  std::optional<Metres> aboveGround;
};

/// Compares name and length alone.
bool matches(std::span<const std::byte> bytes);
/// Fills all but time and packet. `complete` is false if an attitude or a position has not come yet, or if
/// this datagram has neither.
std::optional<PacketFault> parse(std::span<const std::byte> bytes, Session& session, AircraftState& state,
                                 bool& complete);

}  // namespace trimtab::x_plane
