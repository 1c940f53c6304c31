#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "trimtab/frame/host_symbols.h"
#include "trimtab/host/decoder.h"
#include "trimtab/host/host_clock_offset.h"
#include "trimtab/units/quantity.h"

namespace trimtab {

enum class LinkState {
  never,  ///< no packet yet
  live,
  silent,  ///< no packet for host.silence_after_ms, so the eye stays where it is
  jumped   ///< live, and within the last second the aircraft was moved farther than it can fly
};
std::string_view toText(LinkState state);

/// Follows the link to a host: its clock, silences, jumps and symbols. Times of ours are seconds of
/// CLOCK_REALTIME.
class HostLink {
 public:
  /// Adds a state that arrived. `before` is the state of the packet before it; null if there is none.
  void follow(const AircraftState& state, double arrival, const AircraftState* before);
  void setSymbols(std::shared_ptr<const HostSymbols> symbols) { symbols_ = std::move(symbols); }
  /// States no longer come from the host.
  void leave();
  /// Reports whether states come from the host, so that the eye may move on between them.
  bool connected() const { return connected_; }

  LinkState state(double now, Milliseconds silenceAfter) const;
  /// Returns the seconds since the last packet arrived; NaN before the first.
  double packetAge(double now) const;
  std::uint64_t jumps() const { return jumps_; }
  /// Returns the host's time at `now` of our clock, seconds.
  double hostTime(double now) const { return clock_.hostTime(now); }
  /// Returns when the last packet arrived; 0 before the first.
  double lastArrival() const { return lastArrival_; }
  /// Returns the aircraft at `now`, moved on along its recent velocity for at most `silenceAfter`. Call it
  /// only while connected.
  AircraftState aircraftAt(double now, Milliseconds silenceAfter) const;
  /// Returns the symbols that the host sent last; null if there are none, or if states come from elsewhere.
  const std::shared_ptr<const HostSymbols>& symbols() const { return symbols_; }

 private:
  bool connected_ = false;
  HostClockOffset clock_;
  Extrapolator extrapolator_;
  double lastArrival_ = 0, lastJump_ = 0;
  double promisedS_ = 0;  ///< how long the host may stay silent, if it promised a dead reckoning
  std::uint64_t jumps_ = 0;
  std::shared_ptr<const HostSymbols> symbols_;
};

}  // namespace trimtab
