#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/host_symbols.h"
#include "trimtab/host/byte_order.h"
#include "trimtab/host/terrain_query.h"
#include "trimtab/units/result.h"

/// Decodes a host's datagrams to aircraft states. It sees bytes, addresses and times only; sockets are in
/// app/link.
namespace trimtab {

struct Datagram {
  std::span<const std::byte> bytes;
  double arrival = 0;  ///< seconds on the receiver's clock (the kernel's time stamp if there is one)
  std::string from;    ///< "127.0.0.1:5500"
};

enum class WireProtocol { none, native_fdm, cigi3, cigi4, dis, x_plane };

/// Chooses which protocol, which aircraft and which view of a host are used; the rest is passed over.
struct HostChoice {
  HostProtocol protocol = HostProtocol::automatic;
  std::uint16_t entity = 0;  ///< the own aircraft of a CIGI host
  /// The own aircraft of a DIS host: its id as "17:2:5", the last number of it, or its marking.
  std::string disEntity;
  std::optional<std::uint16_t> view;  ///< the view that is drawn; if unset, the first that the host controls

  HostChoice(HostProtocol p = HostProtocol::automatic) : protocol(p) {}
  /// As a preset says.
  explicit HostChoice(const HostParameters& parameters);
  /// Chooses the own aircraft as a person named it: by a number, or for a DIS host also by id or marking. An
  /// empty name changes nothing.
  void chooseEntity(const std::string& name);
  /// Returns the own aircraft of a DIS host as `disEntity` does, or else the number of that of a CIGI host.
  /// If it is empty, the first platform that comes is followed.
  std::string ofDis() const;
};

/// CIGI packets of a type that is not read.
struct IgnoredPackets {
  std::uint8_t id = 0;
  std::uint64_t count = 0;
};
/// Returns "Rate Control (8)" for a packet of CIGI 3, or "user-defined (210)".
std::string cigiPacketName(std::uint8_t id);

/// The health of one sender's link, as the Host dock shows it. Counters only grow, except `lost`, which a
/// late packet lowers again, and `implausible`, which the second packet of a new count lowers.
struct HostStatistics {
  std::string from;  ///< the sender that all this is of, "127.0.0.1:5500"; empty before the first datagram
  WireProtocol protocol = WireProtocol::none;
  std::uint64_t received = 0;  ///< datagrams
  std::uint64_t states = 0;    ///< decoded to a state
  std::uint64_t bad = 0;       ///< refused: damaged, or nothing that is known
  /// Undamaged, but for someone else: another protocol or version, an image generator's own message, or a
  /// message of other entities while the own aircraft has not come.
  std::uint64_t notForUs = 0;
  std::uint64_t alongside = 0;  ///< datagrams that came while another sender was followed
  std::uint64_t truncated =
      0;                       ///< CIGI messages whose tail was dropped at a packet of size 0 or past the end
  std::uint64_t notReady = 0;  ///< states below -1,000 ft: the simulator has not placed its aircraft yet
  std::uint64_t repeated = 0;  ///< with the same frame number again
  /// Used although the frame number stood still: the host does not count, so that nobody can tell what is
  /// lost.
  std::uint64_t uncounted = 0;
  std::uint64_t reordered = 0;        ///< late: with an older frame number than one already seen; not decided
  std::uint64_t implausible = 0;      ///< with a frame number far from all others; not decided
  std::uint64_t restarts = 0;         ///< how often the host began to count frames anew
  std::optional<std::uint64_t> lost;  ///< by frame numbers; unset if the host does not count (native-fdm)
  double rateHz = 0;                  ///< over the last second
  double jitterMs = 0;     ///< RFC 3550, 6.4.1, from the host's time stamps, else from even spacing
  double lastArrival = 0;  ///< of a good datagram; 0 before the first
  std::string lastFrom;
  std::string firstBadHex;     ///< of the first bad or truncated datagram, at most 256 bytes
  std::string firstBadReason;  ///< byte offset, expected, found
  /// Reason why the newest of `bad`, of `notForUs`, and of the host's own datagrams led to no state: the
  /// sender, the byte or field, what was expected, what was found, and after a semicolon what to do.
  /// toString() makes one line of it. It is unset if there was none; `newestUnused` also once a state has
  /// followed. That one names a missing ownship, an aircraft that is not ready, or a frame number that is
  /// repeated, late or implausible.
  std::optional<Finding> newestBad, newestNotForUs, newestUnused;
  std::uint64_t jumps =
      0;  ///< position changes too large for any aircraft, or of more than a kilometre across a silence
  std::uint64_t regionalWeather = 0;  ///< CIGI Weather Control of a region or an entity, which is ignored
  std::uint64_t otherLayers =
      0;  ///< CIGI Weather Control of a layer other than rain and snow, which is ignored
  std::uint64_t symbolPackets = 0;   ///< CIGI packets that defined or controlled symbols
  std::uint64_t refusedPackets = 0;  ///< CIGI packets that were left out; the rest of their message counts
  std::string firstRefusedReason;    ///< of the first one: byte offset, expected, found
  std::optional<Finding> newestRefused;      ///< of the last one
  std::vector<IgnoredPackets> ignored;       ///< CIGI packets that are not read, each type once
  std::vector<std::uint16_t> otherEntities;  ///< the first few that the host moves beside the own aircraft
  std::vector<std::uint16_t> views;          ///< the first few that the host controls
  std::optional<std::uint16_t> view;         ///< the one that is followed; unset before any
  /// The aircraft of a DIS host that is followed, as "17:2:5 VIPER1", and the first few others that it sends.
  std::string ownEntity, otherEntityNames;
  std::uint64_t silences = 0;  ///< gaps of more than two seconds between good datagrams
};

/// Decodes datagrams in order of arrival. Bad ones are counted and never thrown. Use it on one thread at a
/// time.
class HostDecoder {
 public:
  explicit HostDecoder(const HostChoice& choice = {});
  ~HostDecoder();
  HostDecoder(HostDecoder&&) noexcept;
  HostDecoder& operator=(HostDecoder&&) noexcept;

  /// Returns a datagram's state; nothing if it is bad, repeated, late, implausible, not ready, or carries no
  /// ownship yet.
  std::optional<AircraftState> accept(const Datagram& datagram);
  /// Returns the health of the sender that is followed, valid until the next accept(). `rateHz` is as of its
  /// last good datagram. Every sender (an address with its port) has counters, a clock and a memory of its
  /// own, and states of all of them are returned by accept(). A host is followed from its first good datagram
  /// on, because that is what a restarted one looks like, and one that was heard before is followed again
  /// when the followed one has been silent for two seconds. Senders of nothing good are followed only where
  /// there is no host.
  const HostStatistics& statistics() const;
  /// Returns the health of the senders that are not followed, in no order. Of more than a few, those that
  /// were not heard for longest are forgotten.
  std::vector<HostStatistics> otherSenders() const;
  /// Returns how many datagrams came, of all senders.
  std::uint64_t received() const;
  /// Reports whether the last datagram was a host's: neither bad nor of another protocol.
  bool understood() const;
  /// Returns the rate of the good datagrams in the second before `now`, Hz. It is 0 a second after the last.
  double rateAt(double now) const;
  /// Returns the symbols that the host of the newest good datagram has defined so far; null if none. A change
  /// makes another object, so equal pointers mean equal symbols. A symbol lasts until the host destroys it or
  /// restarts.
  std::shared_ptr<const HostSymbols> symbols() const;
  /// Moves what the last datagram asked about the terrain to the end of `queries`.
  void takeQueries(std::vector<TerrainQuery>& queries);
  /// These return the frame number and byte order of the newest good datagram for a Start of Frame; nothing
  /// and big if it is not CIGI.
  std::optional<std::uint32_t> lastHostFrame() const;
  ByteOrder hostOrder() const;
  /// Returns the protocol of the newest good datagram; none before any.
  WireProtocol hostProtocol() const;
  /// Forgets everything but the choice.
  void reset();

 private:
  struct Link;
  std::unique_ptr<Link> link_;
};

/// Moves a state on along its recent velocity and turn rates. Only the eye is extrapolated; decisions never
/// are.
class Extrapolator {
 public:
  /// Adds a state; one with the time of the last one replaces it.
  void push(const AircraftState& state);
  /// Returns the state moved on to `time`, on the clock of the states (HostClockOffset maps the
  /// wall clock to it), but by `limitS` seconds at most. Returns the last state unchanged if `limitS` is 0,
  /// if `time` is not after it, or if its motion is unknown: at the first state, after a jump or a silence,
  /// and when the host's clock went back. A host that promises a dead reckoning is believed instead, for as
  /// long as it may stay silent (longestGapS), if `limitS` is not 0.
  AircraftState at(double time, double limitS) const;

 private:
  void start(const AircraftState& state);

  /// The last states, oldest first, all from one continuous motion.
  std::array<AircraftState, 16> states_;
  std::size_t count_ = 0;
};

}  // namespace trimtab
