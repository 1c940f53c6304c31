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

/// Describes what the symbols of a helmet-mounted display (document C) show in one frame.
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

/// The values that the symbols show. If an attitude is not finite, only the host's symbols are drawn. A
/// speed that is unset, and a value that is not finite, show as dashes. Without a velocity, or with one that
/// is not finite or about 0, there is no flight path marker.
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
/// Collects the parameters of the symbols from those of a preset.
SymbologySetup symbologySetup(const TuningParameters& parameters);

/// Holds everything that the symbols of one image depend on, apart from the view.
struct SymbologyRequest {
  SymbologyState state;
  SymbologySetup setup;
  /// The symbols that the host sends; null if there are none. Two requests with equal symbols differ if the
  /// pointers do. So pass a new object for every change, and the same one as long as nothing changes.
  std::shared_ptr<const HostSymbols> host{};
  std::vector<std::uint16_t> dark{};  ///< ids of host symbols in the dark part of their flash, ascending

  friend bool operator==(const SymbologyRequest&, const SymbologyRequest&) = default;
};

}  // namespace trimtab
