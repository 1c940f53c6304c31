#include "native_fdm.h"
#include "one_sender.h"
#include "packet_fault.h"
#include "trimtab/host/motion.h"

/// The protocols of OneSender whose packets have no numbers: nobody can tell what was lost.
namespace trimtab {

std::optional<AircraftState> OneSender::arrived(const Datagram& datagram, WireProtocol protocol,
                                                AircraftState state) {
  const double gap = gapTo(datagram);
  const bool silence = gap > kSilenceS, known = statistics_.protocol == protocol && gap > 0 && !silence;
  if (const double even = meter_.meanGapS(); known && even > 0) meter_.deviated(gap - even);
  statistics_.lost.reset();
  heard(datagram, protocol, silence);
  state.time = datagram.arrival;
  return finish(state, gap, silence);
}

std::optional<AircraftState> OneSender::acceptNativeFdm(const Datagram& datagram) {
  AircraftState state;
  if (const auto fault = native_fdm::parse(datagram.bytes, state)) {
    refuse(datagram, *fault);
    return std::nullopt;
  }
  return arrived(datagram, WireProtocol::native_fdm, state);
}

std::optional<AircraftState> OneSender::acceptXPlane(const Datagram& datagram) {
  AircraftState state;
  bool complete = false;
  if (const auto fault = x_plane::parse(datagram.bytes, xPlane_, state, complete)) {
    refuse(datagram, *fault);
    return std::nullopt;
  }
  if (complete) return arrived(datagram, WireProtocol::x_plane, state);
  statistics_.lost.reset();
  heard(datagram, WireProtocol::x_plane, gapTo(datagram) > kSilenceS);
  const auto have = [](bool known) { return known ? "yes" : "no"; };
  return unused("X-Plane DATA", "row 17 (attitude) and row 20 (position): tick both in Data Output",
                std::string("so far row 17: ") + have(xPlane_.attitude.has_value()) +
                    ", row 20: " + have(xPlane_.position.has_value()));
}

std::optional<AircraftState> OneSender::acceptDis(const Datagram& datagram) {
  if (!dis::matches(datagram.bytes)) {
    refuse(datagram, {0, "DIS header", "version 4 to 7, a family, and the length of the datagram",
                      "something else in " + std::to_string(datagram.bytes.size()) + " bytes"});
    return std::nullopt;
  }
  std::optional<dis::Entity> own;
  std::optional<PacketFault> fault;
  int entities = 0;
  for (std::size_t at = 0; at < datagram.bytes.size();
       at += wire::get<std::uint16_t>(datagram.bytes, at + 8, ByteOrder::big)) {
    if (std::to_integer<std::uint8_t>(datagram.bytes[at + 2]) != dis::kEntityStateType) continue;
    dis::Entity entity;
    if (auto bad = dis::parse(datagram.bytes, at, entity)) {
      if (!fault) fault = std::move(bad);
      continue;
    }
    ++entities;
    if (ownEntity_.isOwn(entity)) own = std::move(entity);
  }
  if (fault && !own) {
    refuse(datagram, *fault);
    return std::nullopt;
  }
  if (!own) return withoutOwnEntity(datagram, entities);

  statistics_.ownEntity = dis::toString(*own);
  const double gap = gapTo(datagram), atMost = lastState_ ? longestGapS(*lastState_) : kSilenceS;
  const bool silence = gap > atMost;
  statistics_.lost.reset();
  heard(datagram, WireProtocol::dis, silence);
  if (own->isGone) return unused("Entity State", "the own aircraft", "that it was taken out of the exercise");
  // A time stamp a little before the last one is that of a late packet; one far before it is another count.
  constexpr double kLateS = 5;
  if (lastTicks_ && !silence) {
    const double step = static_cast<std::int32_t>(own->ticks - *lastTicks_) * dis::kTickS;
    if (step < 0 && step > -kLateS) {
      ++statistics_.reordered;
      return unused("time stamp of Entity State", "one that rises",
                    std::to_string(-step) + " s before the last");
    }
  }
  lastTicks_ = own->ticks;
  own->state.time = disClock_.advance(own->ticks).value_or(datagram.arrival);
  return finish(own->state, gap, silence);
}

std::optional<AircraftState> OneSender::withoutOwnEntity(const Datagram& datagram, int entities) {
  understood_ = true;
  ++understoodCount_;
  statistics_.protocol = WireProtocol::dis;
  statistics_.otherEntityNames = ownEntity_.others();
  if (entities > 0 && lastState_) return std::nullopt;
  ++statistics_.notForUs;
  PacketFault fault{2, "type of DIS PDU", "1 (Entity State)",
                    std::to_string(std::to_integer<int>(datagram.bytes[2])),
                    "let the host send Entity State of its own aircraft"};
  if (entities > 0)
    fault = {12, "entity", ownEntity_.wanted().empty() ? std::string("a platform") : ownEntity_.wanted(),
             statistics_.otherEntityNames + " only", "choose one of them by its id or marking"};
  statistics_.newestNotForUs = toFinding(fault, statistics_.from);
  return std::nullopt;
}

}  // namespace trimtab
