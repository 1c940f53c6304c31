#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "packet_fault.h"
#include "trimtab/frame/frame.h"

/// FlightGear's native-fdm, FG_NET_FDM_VERSION 24 (src/Network/net_fdm.hxx): big-endian, no frame number, no
/// send time.
namespace trimtab::native_fdm {

inline constexpr std::size_t kSize = 408;
inline constexpr std::uint32_t kVersion = 24;

/// Compares length and version alone, for automatic detection.
bool matches(std::span<const std::byte> bytes);
/// Fills all but time and packet; `state` is only meant to be used when there is no fault.
std::optional<PacketFault> parse(std::span<const std::byte> bytes, AircraftState& state);

/// Offsets of the fields that carry state; the rest is engines, gear and control surfaces.
enum Offset : std::size_t {
  kVersionAt = 0,
  kLongitude = 8,
  kLatitude = 16,
  kAltitude = 24,
  kAboveGround = 32,
  kRoll = 36,
  kPitch = 40,
  kHeading = 44,
  kAirspeed = 68,  ///< calibrated, knots
  kNorth = 76,     ///< velocities, feet a second
  kEast = 80,
  kDown = 84,
  kUnixTime = 356,
  kVisibility = 364
};

}  // namespace trimtab::native_fdm
