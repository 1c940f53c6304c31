#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/units/result.h"

/// From a host's datagrams to aircraft states. Bytes, addresses and times only: sockets live in app/link.
namespace trimtab {

struct Datagram {
  std::span<const std::byte> bytes;
  double arrival = 0;  ///< seconds, the receiver's clock (kernel time stamp where there is one)
  std::string from;    ///< "127.0.0.1:5500"
};

enum class WireProtocol { none, native_fdm, cigi3 };

/// Link health, as the Host dock shows it. Counters only grow; `reset` starts over.
struct HostStatistics {
  WireProtocol protocol = WireProtocol::none;
  std::uint64_t received = 0;         ///< datagrams
  std::uint64_t states = 0;           ///< decoded to a state
  std::uint64_t bad = 0;              ///< refused
  std::uint64_t repeated = 0;         ///< same frame number again
  std::uint64_t reordered = 0;        ///< older frame number than one already seen
  std::optional<std::uint64_t> lost;  ///< by frame numbers; none where the protocol carries none (native-fdm)
  double rateHz = 0;                  ///< over the last second
  double jitterMs = 0;                ///< smoothed deviation of gaps (RFC 3550's estimator, on arrival times)
  double lastArrival = 0;             ///< 0 before the first
  std::string lastFrom;
  std::string firstBadHex;     ///< of the first bad datagram, at most 256 bytes
  std::string firstBadReason;  ///< byte offset, expected, found
  std::uint64_t jumps = 0;     ///< position changes too large for any aircraft
};

/// One datagram at a time, in order of arrival. Bad ones are counted, never thrown. One thread at a time.
class HostDecoder {
 public:
  explicit HostDecoder(HostProtocol protocol = HostProtocol::automatic) : protocol_(protocol) {}

  /// The state the datagram carries, or none: it was bad, repeated, reordered, or carries no ownship yet.
  std::optional<AircraftState> accept(const Datagram& datagram);
  const HostStatistics& statistics() const { return statistics_; }
  void reset();

 private:
  struct Cigi;  // accumulated packets of a CIGI session
  HostProtocol protocol_;
  HostStatistics statistics_;
  // The implementer adds private members as needed.
};

/// Moves a state along its recent velocity to `time`; never more than `limitS` past the last packet. Only the
/// eye uses it.
class Extrapolator {
 public:
  void push(const AircraftState& state);
  /// The pose at `time` (same clock as the states), or the last one when `limitS` is passed, extrapolation is
  /// off, or the last two states are a jump apart.
  AircraftState at(double time, double limitS) const;

 private:
  std::optional<AircraftState> previous_, last_;
};

}  // namespace trimtab
