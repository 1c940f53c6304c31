#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "trimtab/frame/frame.h"
#include "trimtab/host/byte_order.h"

/// From a host's datagrams to aircraft states. Bytes, addresses and times only: sockets live in app/link.
namespace trimtab {

struct Datagram {
  std::span<const std::byte> bytes;
  double arrival = 0;  ///< seconds, the receiver's clock (kernel time stamp where there is one)
  std::string from;    ///< "127.0.0.1:5500"
};

enum class WireProtocol { none, native_fdm, cigi3 };

/// Link health, as the Host dock shows it. Counters only grow (but for `lost`, which a late packet lowers
/// again); `reset` starts over.
struct HostStatistics {
  WireProtocol protocol = WireProtocol::none;
  std::uint64_t received = 0;   ///< datagrams
  std::uint64_t states = 0;     ///< decoded to a state
  std::uint64_t bad = 0;        ///< refused
  std::uint64_t truncated = 0;  ///< a CIGI message's tail was dropped: a packet of size 0 or past the end
  std::uint64_t notReady = 0;   ///< below -1,000 ft: the simulator has not placed its aircraft yet
  std::uint64_t repeated = 0;   ///< same frame number again
  std::uint64_t reordered = 0;  ///< older frame number than one already seen
  std::uint64_t restarts = 0;   ///< the host, or another one, began to count frames anew
  std::optional<std::uint64_t> lost;  ///< by frame numbers; none where the protocol carries none (native-fdm)
  double rateHz = 0;                  ///< over the last second
  double jitterMs = 0;                ///< RFC 3550, 6.4.1, by the host's timestamps or else by even spacing
  double lastArrival = 0;             ///< of a good one; 0 before the first
  std::string lastFrom;
  std::string firstBadHex;     ///< of the first bad or truncated datagram, at most 256 bytes
  std::string firstBadReason;  ///< byte offset, expected, found
  std::uint64_t jumps =
      0;  ///< position changes too large for any aircraft, or of a kilometre across a silence
  std::uint64_t regionalWeather = 0;  ///< CIGI Weather Control of a region or an entity: passed over
  std::uint64_t otherLayers = 0;  ///< CIGI Weather Control of a layer that is not rain or snow: passed over
  std::uint64_t silences = 0;     ///< gaps of more than two seconds between good datagrams
};

/// One datagram at a time, in order of arrival. Bad ones are counted, never thrown. One thread at a time.
class HostDecoder {
 public:
  explicit HostDecoder(HostProtocol protocol = HostProtocol::automatic);
  ~HostDecoder();
  HostDecoder(HostDecoder&&) noexcept;
  HostDecoder& operator=(HostDecoder&&) noexcept;

  /// The state the datagram carries, or none: it was bad, repeated, reordered, or carries no ownship yet.
  std::optional<AircraftState> accept(const Datagram& datagram);
  /// `rateHz` is as of the last good datagram; see rateAt().
  const HostStatistics& statistics() const;
  /// Good datagrams a second over the last second before `now`: falls to 0 when the host falls silent.
  double rateAt(double now) const;
  /// For a Start of Frame's echo: frame number and byte order of the last CIGI message, if there was one.
  std::optional<std::uint32_t> lastHostFrame() const;
  ByteOrder hostOrder() const;
  void reset();

 private:
  struct Link;
  std::unique_ptr<Link> link_;
};

/// Moves a state along its recent velocity and turn rates to `time`; the pose that `limitS` past the last
/// packet reaches is then held. Only the eye uses it.
class Extrapolator {
 public:
  void push(const AircraftState& state);
  /// The pose at `time` (same clock as the states; map the wall clock by the last packet's arrival). The last
  /// state as it is when `limitS` is 0, `time` is not after it, or nothing is known of its motion: the first
  /// state, after a jump or a silence, or when the host's clock went back.
  AircraftState at(double time, double limitS) const;

 private:
  void start(const AircraftState& state);

  /// The last states, oldest first, all of one continuous motion.
  std::array<AircraftState, 16> states_;
  std::size_t count_ = 0;
};

}  // namespace trimtab
