#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/host_symbols.h"
#include "trimtab/preset/parameters.h"

/// What the symbols of a helmet-mounted display (document C) show in one frame.
namespace trimtab {

/// The symbols, in the order in which they are drawn.
enum class Symbol : std::uint8_t {
  pitch_ladder,
  aircraft_reference,
  flight_path,
  line_of_sight,
  heading_tape,
  airspeed,
  altitude,
  host  ///< all symbols that the host sends
};
inline constexpr std::size_t kSymbols = 8;

/// The values that the symbols show. A value that is not finite is not shown.
struct SymbologyState {
  Attitude aircraft;
  Attitude view;    ///< the line of sight in the world: aircraft and head
  Metres altitude;  ///< above mean sea level
  std::optional<Knots> speed;
  bool groundSpeed = false;  ///< if false, the speed is calibrated airspeed
  std::optional<Velocity> velocity;

  friend bool operator==(const SymbologyState&, const SymbologyState&) = default;
};

/// The parameters of all symbols; `element` is indexed by Symbol.
struct SymbologySetup {
  SymbologyParameters general;
  std::array<SymbolElement, kSymbols> element;

  friend bool operator==(const SymbologySetup&, const SymbologySetup&) = default;
};
SymbologySetup symbologySetup(const TuningParameters& parameters);

struct SymbologyRequest {
  SymbologyState state;
  SymbologySetup setup;
  /// The symbols that the host sends; null if there are none. They are compared by the pointer: a host's
  /// store that changes becomes another one.
  std::shared_ptr<const HostSymbols> host{};
  std::vector<std::uint16_t> dark{};  ///< ids of host symbols in the dark part of their flash, ascending

  friend bool operator==(const SymbologyRequest&, const SymbologyRequest&) = default;
};

}  // namespace trimtab
