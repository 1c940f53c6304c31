#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "trimtab/units/range.h"

/// The inputs of a policy: what is known about the flight, the view and the load of recent images.
namespace trimtab {

enum class Signal : std::uint8_t {
  altitude,
  above_ground,
  pitch,
  roll,
  speed,
  climb,
  sight_rate,
  head_rate,
  visibility,
  precipitation,
  load,
  triangles,
  altitude_membership,
  pitch_membership
};

struct SignalRow {
  Signal signal;
  std::string_view key;    ///< as files spell it
  std::string_view label;  ///< as people read it, without the unit
  std::string_view unit;
  Range range;               ///< values beyond it count as its end
  double filterS = 0;        ///< time constant of the low-pass filter, seconds; 0 passes every value on
  std::string_view derived;  ///< from what, and how
  std::string_view unknown;  ///< when nobody knows it
};

inline constexpr std::array kSignalRows{
    SignalRow{Signal::altitude,
              "altitude",
              "Altitude",
              "ft",
              {-2000, 60000},
              0,
              "the aircraft's height above mean sea level",
              "its height is not a number"},
    SignalRow{Signal::above_ground,
              "above_ground",
              "Height above ground",
              "ft",
              {0, 60000},
              0,
              "from the host; else from the terrain below the aircraft",
              "the host does not send it and there is no terrain below"},
    SignalRow{Signal::pitch,
              "pitch",
              "Pitch",
              "deg",
              {-90, 90},
              0,
              "the aircraft's, nose up positive",
              "it is not a number"},
    SignalRow{Signal::roll,
              "roll",
              "Roll",
              "deg",
              {0, 180},
              0,
              "the aircraft's angle of bank to either side",
              "it is not a number"},
    SignalRow{Signal::speed,
              "speed",
              "Speed",
              "kt",
              {0, 1500},
              0.5,
              "the airspeed; else the length of the velocity over the ground",
              "the host sends neither, and fewer than two states are known"},
    SignalRow{Signal::climb,
              "climb",
              "Climb rate",
              "ft/min",
              {-20000, 20000},
              0.5,
              "the upward velocity, from the host or from successive positions",
              "the host does not send it, and fewer than two states are known"},
    SignalRow{Signal::sight_rate,
              "sight_rate",
              "Rate of the line of sight",
              "deg/s",
              {0, 1000},
              0.05,
              "the angle between successive directions in which the pilot looks, over the time between them",
              "fewer than two states are known without a gap of a second between them"},
    SignalRow{Signal::head_rate,
              "head_rate",
              "Rate of the head alone",
              "deg/s",
              {0, 1000},
              0.05,
              "the same relative to the aircraft",
              "as for the line of sight, or there is no head"},
    SignalRow{Signal::visibility,
              "visibility",
              "Visibility",
              "m",
              {0, 500000},
              0,
              "as the weather decision uses it; clear air counts as the end of the range",
              "never"},
    SignalRow{Signal::precipitation,
              "precipitation",
              "Precipitation density",
              "",
              {0, 1},
              0,
              "as the weather decision uses it, 0 where nothing falls",
              "never"},
    SignalRow{Signal::load,
              "load",
              "Load",
              "",
              {0, 10},
              0,
              "the median work time of the last nine images over measure.budget_ms",
              "no image is finished"},
    SignalRow{Signal::triangles,
              "triangles",
              "Triangles in view",
              "",
              {0, 1e8},
              0,
              "of the last image",
              "no image is finished"},
    SignalRow{Signal::altitude_membership,
              "altitude_membership",
              "Altitude membership",
              "",
              {0, 1},
              0,
              "the culling scheme's membership of the altitude: 1 is low",
              "the altitude that the scheme asks for is unknown"},
    SignalRow{Signal::pitch_membership,
              "pitch_membership",
              "Pitch membership",
              "",
              {0, 1},
              0,
              "the culling scheme's membership of the pitch: 1 is nose down",
              "the altitude that the scheme asks for is unknown"},
};
inline constexpr std::size_t kSignals = kSignalRows.size();

constexpr std::size_t indexOf(Signal signal) {
  return static_cast<std::size_t>(signal);
}
/// Returns the row of a signal.
constexpr const SignalRow& rowOf(Signal signal) {
  return kSignalRows[static_cast<std::size_t>(signal)];
}
/// Returns the signal with this key; nothing if there is none.
constexpr std::optional<Signal> signalNamed(std::string_view key) {
  for (const SignalRow& row : kSignalRows)
    if (row.key == key) return row.signal;
  return std::nullopt;
}

/// One value of each signal, in the units of its row. NaN says that nobody knows it.
struct SignalValues {
  std::array<double, kSignals> value;

  constexpr SignalValues() { value.fill(std::numeric_limits<double>::quiet_NaN()); }
  constexpr double& operator[](Signal s) { return value[static_cast<std::size_t>(s)]; }
  constexpr double operator[](Signal s) const { return value[static_cast<std::size_t>(s)]; }
};

namespace detail {
constexpr bool signalRowsAreInOrder() {
  for (std::size_t i = 0; i < kSignals; ++i) {
    const SignalRow& row = kSignalRows[i];
    if (static_cast<std::size_t>(row.signal) != i || row.key.empty() || row.label.empty()) return false;
    if (!(row.range.low < row.range.high) || !(row.filterS >= 0)) return false;
    if (signalNamed(row.key) != row.signal) return false;
  }
  return true;
}
static_assert(signalRowsAreInOrder() && static_cast<std::size_t>(Signal::pitch_membership) + 1 == kSignals);
}  // namespace detail

}  // namespace trimtab
