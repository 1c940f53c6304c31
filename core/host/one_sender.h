#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "cigi3.h"
#include "dis.h"
#include "frame_order.h"
#include "rate_meter.h"
#include "trimtab/host/decoder.h"
#include "x_plane.h"

namespace trimtab {

/// Seconds of a 32-bit tick counter that wraps; useless once it stands still while frames go on.
class HostClock {
 public:
  explicit HostClock(double tickS) : tickS_(tickS) {}
  void restart() { *this = HostClock(tickS_); }
  std::optional<double> advance(std::uint32_t ticks);

 private:
  double tickS_;
  std::optional<std::uint32_t> last_;
  std::int64_t wraps_ = 0;
  double seconds_ = 0;
  int stuck_ = 0;
};

/// Decodes what one sender sends: what its datagrams add up to, and the health of its link.
class OneSender {
 public:
  OneSender(std::string from, const HostChoice& choice) : choice_(choice), ownEntity_(choice.ofDis()) {
    statistics_.from = std::move(from);
  }

  /// Does what HostDecoder::accept does, for the datagrams of this sender.
  std::optional<AircraftState> accept(const Datagram& datagram);
  const HostStatistics& statistics() const { return statistics_; }
  const RateMeter& meter() const { return meter_; }
  const std::shared_ptr<const HostSymbols>& symbols() const { return session_.symbols; }
  /// Moves the requests of the last datagram to the end of `queries`.
  void takeQueries(std::vector<TerrainQuery>& queries);
  std::optional<std::uint32_t> lastFrame() const { return order_.last(); }
  ByteOrder byteOrder() const { return hostOrder_; }

  /// Reports whether the last datagram was a host's, which is neither bad nor of another protocol.
  bool understood() const { return understood_; }
  /// Reports whether any of its datagrams was.
  bool isHost() const { return understoodCount_ > 0; }
  /// Reports whether the last datagram is the first one of a host, or the first of one that is none so far.
  bool isNew() const { return isHost() ? understood_ && understoodCount_ == 1 : statistics_.received == 1; }
  double lastHeard() const { return lastHeard_; }

  /// Reports whether a datagram from another port of the same address is this host's next one: some hosts
  /// open a socket for each message, and so none of their ports is heard twice.
  bool goesOnWith(const Datagram& datagram) const;
  void moveTo(const std::string& from) {
    statistics_.from = from;
    ofThisPort_ = 0;
  }
  void noteAlongside() { ++statistics_.alongside; }

 private:
  WireProtocol detect(std::span<const std::byte> bytes) const;
  void refuse(const Datagram& datagram, const PacketFault& fault);
  /// Says that a datagram is another protocol's, where one was asked for.
  std::optional<PacketFault> otherThanWanted(std::span<const std::byte> bytes) const;
  void keepFirstBad(std::span<const std::byte> bytes, const PacketFault& fault);
  /// Counts a host's datagram: link health that does not depend on what it says.
  void heard(const Datagram& datagram, WireProtocol protocol, bool silence);
  std::optional<AircraftState> acceptNativeFdm(const Datagram& datagram);
  std::optional<AircraftState> acceptCigi(const Datagram& datagram, WireProtocol protocol);
  std::optional<AircraftState> acceptDis(const Datagram& datagram);
  std::optional<AircraftState> acceptXPlane(const Datagram& datagram);
  /// Counts and finishes a state of a protocol without numbers whose clock is that of arrivals.
  std::optional<AircraftState> arrived(const Datagram& datagram, WireProtocol protocol, AircraftState state);
  std::optional<AircraftState> withoutOwnEntity(const Datagram& datagram, int entities);
  std::optional<AircraftState> finish(const AircraftState& state, double gapS, bool silence);
  std::optional<AircraftState> withoutOwnship(const cigi3::Message& message);
  void notePackets(const cigi3::Message& message);
  /// Says why a host's datagram leads to no state; returns none.
  std::optional<AircraftState> unused(std::string what, std::string expected, std::string found);
  double gapTo(const Datagram& datagram) const {
    return statistics_.lastArrival > 0 ? datagram.arrival - statistics_.lastArrival : 0;
  }

  HostChoice choice_;
  HostStatistics statistics_;
  RateMeter meter_;
  std::optional<AircraftState> lastState_;
  std::uint64_t understoodCount_ = 0;
  std::uint64_t ofThisPort_ = 0;  ///< datagrams
  bool understood_ = false;
  double lastHeard_ = 0;  ///< arrival of the last datagram, good or bad

  cigi3::Session session_;
  std::vector<TerrainQuery> queries_;  ///< of the last datagram
  FrameOrder order_;
  HostClock clock_{cigi3::kTickS};
  ByteOrder hostOrder_ = ByteOrder::big;

  dis::OwnEntity ownEntity_;
  HostClock disClock_{dis::kTickS};
  std::optional<std::uint32_t> lastTicks_;  ///< time stamp of the own entity

  x_plane::Session xPlane_;
};

}  // namespace trimtab
