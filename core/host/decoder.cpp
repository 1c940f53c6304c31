#include "trimtab/host/decoder.h"

#include <algorithm>

#include "cigi3.h"
#include "frame_order.h"
#include "limits.h"
#include "native_fdm.h"
#include "packet_fault.h"
#include "rate_meter.h"
#include "trimtab/host/motion.h"

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

/// What neither protocol claims: why not.
PacketFault neither(std::span<const std::byte> bytes, WireProtocol last) {
  const bool likeNativeFdm = bytes.size() == native_fdm::kSize || last == WireProtocol::native_fdm;
  AircraftState unused;
  cigi3::Session session;
  if (likeNativeFdm)
    if (const auto fault = native_fdm::parse(bytes, unused)) return *fault;
  if (cigi3::byteOrder(bytes) || last == WireProtocol::cigi3)
    if (const auto fault = cigi3::parse(bytes, session).fault) return *fault;
  return {0, "datagram", "FlightGear native-fdm 24 (408 bytes) or a CIGI 3 message from a host",
          std::to_string(bytes.size()) + " bytes of neither"};
}

/// Seconds of a 32-bit tick counter that wraps; useless once it stands still while frames go on.
class HostClock {
 public:
  void restart() { *this = HostClock(); }
  std::optional<double> advance(std::uint32_t ticks) {
    if (!last_) {
      seconds_ = ticks * cigi3::kTickS;
    } else {
      const auto step = static_cast<std::int32_t>(ticks - *last_);
      // Counted in ticks, so that no rounding adds up and two receivers get the same number.
      if (step < 0 && ticks > *last_) --wraps_;
      if (step > 0 && ticks < *last_) ++wraps_;
      seconds_ = (static_cast<double>(wraps_) * 4294967296.0 + ticks) * cigi3::kTickS;
      stuck_ = step > 0 ? 0 : stuck_ + 1;
    }
    last_ = ticks;
    constexpr int kStuck = 3;
    return stuck_ < kStuck ? std::optional(seconds_) : std::nullopt;
  }

 private:
  std::optional<std::uint32_t> last_;
  std::int64_t wraps_ = 0;
  double seconds_ = 0;
  int stuck_ = 0;
};

}  // namespace

struct HostDecoder::Link {
  HostProtocol wanted = HostProtocol::automatic;
  HostStatistics statistics;
  RateMeter meter;
  std::optional<AircraftState> lastState;

  cigi3::Session session;
  FrameOrder order;
  HostClock clock;
  ByteOrder hostOrder = ByteOrder::big;

  void refuse(std::span<const std::byte> bytes, const PacketFault& fault) {
    if (!statistics.firstBadReason.empty()) return;
    statistics.firstBadReason = toString(fault);
    statistics.firstBadHex = hex(bytes);
  }
  WireProtocol detect(std::span<const std::byte> bytes) const;
  /// A good datagram of a protocol: link health that does not depend on what it says.
  void heard(const Datagram& datagram, WireProtocol protocol, bool silence);
  std::optional<AircraftState> acceptNativeFdm(const Datagram& datagram);
  std::optional<AircraftState> acceptCigi(const Datagram& datagram);
  std::optional<AircraftState> finish(const AircraftState& state, double gapS, bool silence);
  double gapTo(const Datagram& datagram) const {
    return statistics.lastArrival > 0 ? datagram.arrival - statistics.lastArrival : 0;
  }
};

WireProtocol HostDecoder::Link::detect(std::span<const std::byte> bytes) const {
  if (wanted == HostProtocol::native_fdm) return WireProtocol::native_fdm;
  if (wanted == HostProtocol::cigi3) return WireProtocol::cigi3;
  if (native_fdm::matches(bytes)) return WireProtocol::native_fdm;
  const bool igControl = cigi3::byteOrder(bytes) && std::to_integer<int>(bytes[0]) == cigi3::kIgControl &&
                         std::to_integer<int>(bytes[2]) == 3;
  return igControl ? WireProtocol::cigi3 : WireProtocol::none;
}

void HostDecoder::Link::heard(const Datagram& datagram, WireProtocol protocol, bool silence) {
  if (silence) {
    ++statistics.silences;
    meter.restart();
  }
  meter.arrived(datagram.arrival);
  statistics.protocol = protocol;
  statistics.lastArrival = datagram.arrival;
  statistics.lastFrom = datagram.from;
  statistics.rateHz = meter.rateAt(datagram.arrival);
  statistics.jitterMs = meter.jitterS() * 1e3;
}

std::optional<AircraftState> HostDecoder::Link::finish(const AircraftState& state, double gapS,
                                                       bool silence) {
  if (state.position.height.value() < limits::kReady) {
    ++statistics.notReady;
    return std::nullopt;
  }
  if (lastState) {
    const double onHostClock = state.time - lastState->time;
    if (isJump(lastState->position, state.position, onHostClock > 0 ? onHostClock : gapS, silence))
      ++statistics.jumps;
  }
  ++statistics.states;
  lastState = state;
  return state;
}

std::optional<AircraftState> HostDecoder::Link::acceptNativeFdm(const Datagram& datagram) {
  AircraftState state;
  if (const auto fault = native_fdm::parse(datagram.bytes, state)) {
    ++statistics.bad;
    refuse(datagram.bytes, *fault);
    return std::nullopt;
  }
  const double gap = gapTo(datagram);
  const bool silence = gap > kSilenceS,
             known = statistics.protocol == WireProtocol::native_fdm && gap > 0 && !silence;
  if (const double even = meter.meanGapS(); known && even > 0) meter.deviated(gap - even);
  statistics.lost.reset();
  heard(datagram, WireProtocol::native_fdm, silence);
  state.time = datagram.arrival;
  state.packet = statistics.states;
  return finish(state, gap, silence);
}

std::optional<AircraftState> HostDecoder::Link::acceptCigi(const Datagram& datagram) {
  // Into a copy: a message that turns out bad at its last packet has changed nothing.
  cigi3::Session candidate = session;
  const cigi3::Message message = cigi3::parse(datagram.bytes, candidate);
  if (message.fault) {
    ++statistics.bad;
    refuse(datagram.bytes, *message.fault);
    return std::nullopt;
  }
  if (message.cutAt) {
    ++statistics.truncated;
    refuse(datagram.bytes, *message.cutAt);
  }
  const double gap = gapTo(datagram);
  const bool silence = gap > kSilenceS;
  const bool otherSender = !statistics.lastFrom.empty() && statistics.lastFrom != datagram.from;
  const auto verdict = order.accept(message.frame, silence || otherSender);
  statistics.lost = order.lost();
  statistics.implausible = order.implausible();
  if (verdict != FrameOrder::Verdict::next && verdict != FrameOrder::Verdict::restarted) {
    statistics.repeated += verdict == FrameOrder::Verdict::repeated;
    statistics.reordered += verdict == FrameOrder::Verdict::reordered;
    heard(datagram, WireProtocol::cigi3, silence);
    return std::nullopt;
  }
  const bool restarted = verdict == FrameOrder::Verdict::restarted;
  if (restarted) {
    ++statistics.restarts;
    clock.restart();
    candidate = {};
    static_cast<void>(cigi3::parse(datagram.bytes, candidate));
  }
  session = candidate;
  statistics.regionalWeather += static_cast<std::uint64_t>(message.regionalWeather);
  statistics.otherLayers += static_cast<std::uint64_t>(message.otherLayers);
  statistics.symbolPackets += static_cast<std::uint64_t>(message.symbolPackets);
  statistics.refusedSymbols += static_cast<std::uint64_t>(message.refusedSymbols);
  if (message.symbolFault && statistics.firstSymbolReason.empty())
    statistics.firstSymbolReason = toString(*message.symbolFault);
  hostOrder = message.order;

  const auto hostTime = message.ticks ? clock.advance(*message.ticks) : std::nullopt;
  const double time = hostTime.value_or(datagram.arrival);
  if (gap > 0 && !silence && !restarted && lastState) {
    const double even = meter.meanGapS() * order.step();
    if (hostTime && time > lastState->time)
      meter.deviated(gap - (time - lastState->time));
    else if (!hostTime && even > 0)
      meter.deviated(gap - even);
  }
  heard(datagram, WireProtocol::cigi3, silence);
  if (!session.position) return std::nullopt;
  AircraftState state;
  state.time = time;
  state.packet = message.frame;
  state.position = *session.position;
  state.attitude = session.attitude;
  state.head = session.head;
  state.visibility = session.visibility;
  state.weather = session.weather();
  state.wind = session.wind();
  state.view = session.view;
  return finish(state, gap, silence);
}

HostDecoder::HostDecoder(HostProtocol protocol) : link_(std::make_unique<Link>()) {
  link_->wanted = protocol;
}
HostDecoder::~HostDecoder() = default;
HostDecoder::HostDecoder(HostDecoder&&) noexcept = default;
HostDecoder& HostDecoder::operator=(HostDecoder&&) noexcept = default;

std::optional<AircraftState> HostDecoder::accept(const Datagram& datagram) {
  ++link_->statistics.received;
  switch (link_->detect(datagram.bytes)) {
    case WireProtocol::native_fdm:
      return link_->acceptNativeFdm(datagram);
    case WireProtocol::cigi3:
      return link_->acceptCigi(datagram);
    case WireProtocol::none:
      break;
  }
  ++link_->statistics.bad;
  if (link_->statistics.firstBadReason.empty())
    link_->refuse(datagram.bytes, neither(datagram.bytes, link_->statistics.protocol));
  return std::nullopt;
}

const HostStatistics& HostDecoder::statistics() const {
  return link_->statistics;
}
double HostDecoder::rateAt(double now) const {
  return link_->meter.rateAt(now);
}
std::shared_ptr<const HostSymbols> HostDecoder::symbols() const {
  return link_->session.symbols;
}
std::optional<std::uint32_t> HostDecoder::lastHostFrame() const {
  return link_->order.last();
}
ByteOrder HostDecoder::hostOrder() const {
  return link_->hostOrder;
}

void HostDecoder::reset() {
  const HostProtocol wanted = link_->wanted;
  link_ = std::make_unique<Link>();
  link_->wanted = wanted;
}

}  // namespace trimtab
