#include "one_sender.h"

#include <algorithm>

#include "cigi4.h"
#include "dis.h"
#include "limits.h"
#include "native_fdm.h"
#include "other_protocol.h"
#include "packet_fault.h"
#include "trimtab/host/motion.h"
#include "trimtab/host/protocol_names.h"
#include "x_plane.h"

namespace trimtab {
namespace {

std::string hex(std::span<const std::byte> bytes) {
  constexpr std::size_t kMost = 256;
  constexpr char kDigits[] = "0123456789abcdef";
  const std::size_t count = std::min(bytes.size(), kMost);
  std::string text(count * 3, ' ');
  for (std::size_t i = 0; i < count; ++i) {
    const auto b = std::to_integer<unsigned>(bytes[i]);
    text[i * 3] = kDigits[b >> 4U];
    text[i * 3 + 1] = kDigits[b & 15U];
  }
  if (count > 0) text.pop_back();
  return text;
}

bool isIgControl(std::span<const std::byte> bytes) {
  return cigi3::byteOrder(bytes) && std::to_integer<int>(bytes[0]) == cigi3::kIgControl &&
         std::to_integer<int>(bytes[2]) == 3;
}

/// Says by content what a host speaks.
WireProtocol recognised(std::span<const std::byte> bytes) {
  if (native_fdm::matches(bytes)) return WireProtocol::native_fdm;
  if (isIgControl(bytes)) return WireProtocol::cigi3;
  if (cigi4::byteOrder(bytes, cigi4::kIgControl)) return WireProtocol::cigi4;
  if (x_plane::matches(bytes)) return WireProtocol::x_plane;
  return dis::matches(bytes) ? WireProtocol::dis : WireProtocol::none;
}

/// Says why no protocol claims a datagram.
PacketFault noneOf(std::span<const std::byte> bytes, WireProtocol last) {
  const bool version =
      bytes.size() >= 4 && wire::get<std::uint32_t>(bytes, 0, ByteOrder::big) == native_fdm::kVersion;
  const bool likeNativeFdm = version || bytes.size() == native_fdm::kSize || last == WireProtocol::native_fdm;
  AircraftState unused;
  cigi3::Session session;
  if (likeNativeFdm)
    if (const auto fault = native_fdm::parse(bytes, unused)) return *fault;
  if (cigi3::byteOrder(bytes) || last == WireProtocol::cigi3)
    if (const auto fault = cigi3::parse(bytes, session).fault) return *fault;
  return {0, "datagram", "CIGI 3 or 4, FlightGear native-fdm 24 (408 bytes), DIS or X-Plane from a host",
          std::to_string(bytes.size()) + " bytes of none of them"};
}

std::string_view addressOf(std::string_view from) {
  return from.substr(0, from.rfind(':'));
}

}  // namespace

std::optional<double> HostClock::advance(std::uint32_t ticks) {
  if (!last_) {
    seconds_ = ticks * tickS_;
  } else {
    const auto step = static_cast<std::int32_t>(ticks - *last_);
    // Counted in ticks, so that no rounding adds up and two receivers get the same number.
    if (step < 0 && ticks > *last_) --wraps_;
    if (step > 0 && ticks < *last_) ++wraps_;
    seconds_ = (static_cast<double>(wraps_) * 4294967296.0 + ticks) * tickS_;
    stuck_ = step > 0 ? 0 : stuck_ + 1;
  }
  last_ = ticks;
  constexpr int kStuck = 3;
  return stuck_ < kStuck ? std::optional(seconds_) : std::nullopt;
}

WireProtocol OneSender::detect(std::span<const std::byte> bytes) const {
  const ProtocolName* wanted = nameOf(choice_.protocol);
  return wanted ? wanted->wire : recognised(bytes);
}

std::optional<AircraftState> OneSender::accept(const Datagram& datagram) {
  ++statistics_.received;
  ++ofThisPort_;
  lastHeard_ = datagram.arrival;
  understood_ = false;
  switch (detect(datagram.bytes)) {
    case WireProtocol::native_fdm:
      return acceptNativeFdm(datagram);
    case WireProtocol::cigi3:
      return acceptCigi(datagram, WireProtocol::cigi3);
    case WireProtocol::cigi4:
      return acceptCigi(datagram, WireProtocol::cigi4);
    case WireProtocol::dis:
      return acceptDis(datagram);
    case WireProtocol::x_plane:
      return acceptXPlane(datagram);
    case WireProtocol::none:
      break;
  }
  refuse(datagram, noneOf(datagram.bytes, statistics_.protocol));
  return std::nullopt;
}

bool OneSender::goesOnWith(const Datagram& datagram) const {
  constexpr std::size_t kFrame = 8, kAfterFrame = 12;
  if (ofThisPort_ != 1 || addressOf(datagram.from) != addressOf(statistics_.from) || !order_.last())
    return false;
  if (datagram.bytes.size() < kAfterFrame) return false;
  const auto order = isIgControl(datagram.bytes) ? cigi3::byteOrder(datagram.bytes)
                                                 : cigi4::byteOrder(datagram.bytes, cigi4::kIgControl);
  return order && wire::get<std::uint32_t>(datagram.bytes, kFrame, *order) == *order_.last() + 1;
}

void OneSender::keepFirstBad(std::span<const std::byte> bytes, const PacketFault& fault) {
  if (!statistics_.firstBadReason.empty()) return;
  statistics_.firstBadReason = toString(fault);
  statistics_.firstBadHex = hex(bytes);
}

void OneSender::refuse(const Datagram& datagram, const PacketFault& fault) {
  if (const auto other = otherProtocol(datagram.bytes)) {
    ++statistics_.notForUs;
    statistics_.newestNotForUs = toFinding(*other, statistics_.from);
    return;
  }
  ++statistics_.bad;
  const PacketFault told = otherThanWanted(datagram.bytes).value_or(fault);
  keepFirstBad(datagram.bytes, told);
  statistics_.newestBad = toFinding(told, statistics_.from);
}

std::optional<PacketFault> OneSender::otherThanWanted(std::span<const std::byte> bytes) const {
  const ProtocolName *wanted = nameOf(choice_.protocol), *found = nameOf(recognised(bytes));
  if (!wanted || !found || wanted == found) return std::nullopt;
  return PacketFault{0, "protocol", std::string(wanted->label) + ", as was asked for", found->label,
                     "ask for the protocol that the host speaks, or for auto"};
}

void OneSender::heard(const Datagram& datagram, WireProtocol protocol, bool silence) {
  if (silence) {
    ++statistics_.silences;
    meter_.restart();
  }
  understood_ = true;
  ++understoodCount_;
  meter_.arrived(datagram.arrival);
  statistics_.protocol = protocol;
  statistics_.lastArrival = datagram.arrival;
  statistics_.lastFrom = datagram.from;
  statistics_.rateHz = meter_.rateAt(datagram.arrival);
  statistics_.jitterMs = meter_.jitterS() * 1e3;
}

std::optional<AircraftState> OneSender::unused(std::string what, std::string expected, std::string found) {
  statistics_.newestUnused =
      Finding{Severity::warning, statistics_.from, std::move(what), std::move(expected), std::move(found)};
  return std::nullopt;
}

std::optional<AircraftState> OneSender::finish(const AircraftState& state, double gapS, bool silence) {
  if (state.position.height.value() < limits::kReady) {
    ++statistics_.notReady;
    return unused("altitude", "at least -1,000 ft",
                  std::to_string(static_cast<long>(state.position.height.in<Feet>())) +
                      " ft: the simulator has not placed its aircraft yet");
  }
  if (lastState_) {
    const double onHostClock = state.time - lastState_->time;
    if (isJump(lastState_->position, state.position, onHostClock > 0 ? onHostClock : gapS, silence))
      ++statistics_.jumps;
  }
  ++statistics_.states;
  statistics_.newestUnused.reset();
  lastState_ = state;
  return state;
}

std::optional<AircraftState> OneSender::acceptCigi(const Datagram& datagram, WireProtocol protocol) {
  const auto parse = protocol == WireProtocol::cigi4 ? cigi4::parse : cigi3::parse;
  // Into a copy: a message that comes late has changed nothing.
  const cigi3::Follow follow{choice_.entity, choice_.view};
  cigi3::Session candidate = session_;
  cigi3::Message message = parse(datagram.bytes, candidate, follow);
  if (message.fault) {
    refuse(datagram, *message.fault);
    return std::nullopt;
  }
  if (message.cutAt) {
    ++statistics_.truncated;
    keepFirstBad(datagram.bytes, *message.cutAt);
  }
  const double gap = gapTo(datagram);
  const bool silence = gap > kSilenceS;
  using Verdict = FrameOrder::Verdict;
  const Verdict verdict = order_.accept(message.frame, silence);
  statistics_.lost = verdict == Verdict::uncounted ? std::nullopt : std::optional(order_.lost());
  statistics_.implausible = order_.implausible();
  if (verdict == Verdict::repeated || verdict == Verdict::reordered || verdict == Verdict::implausible) {
    statistics_.repeated += verdict == Verdict::repeated;
    statistics_.reordered += verdict == Verdict::reordered;
    heard(datagram, protocol, silence);
    return unused("frame number of IG Control",
                  "one that rises, above " + std::to_string(order_.last().value_or(0)),
                  std::to_string(message.frame));
  }
  statistics_.uncounted += verdict == Verdict::uncounted;
  const bool restarted = verdict == Verdict::restarted;
  if (restarted) {
    ++statistics_.restarts;
    clock_.restart();
    candidate = {};
    static_cast<void>(parse(datagram.bytes, candidate, follow));
  }
  session_ = candidate;
  notePackets(message);
  queries_ = std::move(message.queries);
  hostOrder_ = message.order;

  const auto hostTime = message.ticks ? clock_.advance(*message.ticks) : std::nullopt;
  const double time = hostTime.value_or(datagram.arrival);
  if (gap > 0 && !silence && !restarted && lastState_) {
    const double even = meter_.meanGapS() * order_.step();
    if (hostTime && time > lastState_->time)
      meter_.deviated(gap - (time - lastState_->time));
    else if (!hostTime && even > 0)
      meter_.deviated(gap - even);
  }
  heard(datagram, protocol, silence);
  if (message.ownship) {
    statistics_.newestUnused = toFinding(*message.ownship, statistics_.from);
    return std::nullopt;
  }
  if (!session_.position) return withoutOwnship(message);
  AircraftState state;
  state.time = time;
  state.packet = message.frame + statistics_.uncounted;
  state.position = *session_.position;
  state.attitude = session_.attitude;
  state.clamp = session_.clamp;
  state.head = session_.head;
  state.visibility = session_.visibility;
  state.weather = session_.weather();
  state.wind = session_.wind();
  state.view = session_.view;
  return finish(state, gap, silence);
}

/// Adds a message's packets to the counters and lists of the statistics.
void OneSender::notePackets(const cigi3::Message& message) {
  statistics_.regionalWeather += static_cast<std::uint64_t>(message.regionalWeather);
  statistics_.otherLayers += static_cast<std::uint64_t>(message.otherLayers);
  statistics_.symbolPackets += static_cast<std::uint64_t>(message.symbolPackets);
  statistics_.refusedPackets += static_cast<std::uint64_t>(message.refusedPackets);
  if (message.refused) {
    if (statistics_.firstRefusedReason.empty()) statistics_.firstRefusedReason = toString(*message.refused);
    statistics_.newestRefused = toFinding(*message.refused, statistics_.from);
  }
  const auto addNew = [](std::vector<std::uint16_t>& list, const std::vector<std::uint16_t>& seen) {
    for (const std::uint16_t number : seen)
      if (list.size() < cigi3::kMostNamed && std::find(list.begin(), list.end(), number) == list.end())
        list.push_back(number);
  };
  addNew(statistics_.otherEntities, message.otherEntities);
  addNew(statistics_.views, message.views);
  statistics_.view = choice_.view        ? choice_.view
                     : session_.headView ? session_.headView
                                         : session_.definedView;
  for (const IgnoredPackets& each : message.ignored) {
    const auto known = std::find_if(statistics_.ignored.begin(), statistics_.ignored.end(),
                                    [&each](const IgnoredPackets& i) { return i.id == each.id; });
    if (known == statistics_.ignored.end())
      statistics_.ignored.push_back(each);
    else
      known->count += each.count;
  }
}

void OneSender::takeQueries(std::vector<TerrainQuery>& queries) {
  queries.insert(queries.end(), queries_.begin(), queries_.end());
  queries_.clear();
}

std::optional<AircraftState> OneSender::withoutOwnship(const cigi3::Message& message) {
  const std::string own = std::to_string(choice_.entity);
  if (!message.otherEntityAt)
    return unused("Entity Control", "entity " + own + ", the own aircraft",
                  "none so far, or it was destroyed");
  ++statistics_.notForUs;
  std::string seen;
  for (const std::uint16_t entity : statistics_.otherEntities)
    seen += (seen.empty() ? "" : ", ") + std::to_string(entity);
  statistics_.newestNotForUs =
      toFinding(PacketFault{*message.otherEntityAt, "entity", own + ", the own aircraft",
                            "no entity " + own + "; seen: " + seen,
                            "--entity, or host.entity of the preset, says which one is the own aircraft"},
                statistics_.from);
  return std::nullopt;
}

}  // namespace trimtab
