// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "trimtab/host/flight.h"

namespace trimtab::workbench {

/// Plays a flight inside this program, without a network. It yields 60 states per second of flight time, so
/// that decisions do not depend on how fast images are drawn.
class FlightPlayback {
 public:
  static constexpr double kRateHz = 60;

  void load(Flight flight);
  bool loaded() const { return flight_.states.size() > 1; }
  const Flight& flight() const { return flight_; }
  double duration() const;
  /// Seconds into the flight.
  double position() const { return position_; }
  double speed() const { return speed_; }
  bool playing() const { return playing_; }

  /// Starts to play; from the beginning if the flight is at its end. `now` is any clock in seconds.
  void play(double now);
  void pause() { playing_ = false; }
  void setSpeed(double speed) { speed_ = speed; }
  void setLoop(bool loop) { loop_ = loop; }
  void seek(double position);

  /// Appends every state that was passed since the last call. After a stall of more than half a second the
  /// flight continues from where it was. A flight that ends and does not loop stops playing.
  void advance(double now, std::vector<AircraftState>& states);
  /// Returns the state at or before `position`. Packet numbers count from 1 at the start of the flight.
  AircraftState current() const;

 private:
  AircraftState gridState(std::int64_t step) const;

  Flight flight_;
  double position_ = 0, speed_ = 1, lastNow_ = 0;
  std::int64_t nextStep_ = 0;
  bool playing_ = false, loop_ = false;
};

}  // namespace trimtab::workbench
