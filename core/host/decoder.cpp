#include "trimtab/host/decoder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "one_sender.h"
#include "trimtab/host/motion.h"
#include "trimtab/host/protocol_names.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

/// More senders than that are no hosts, but a flood: the one that was silent for longest is forgotten.
constexpr std::size_t kMostSenders = 8;

}  // namespace

HostChoice::HostChoice(const HostParameters& parameters)
    : protocol(parameters.protocol), entity(static_cast<std::uint16_t>(parameters.entity.value())) {
  if (parameters.view.value() >= 0) view = static_cast<std::uint16_t>(parameters.view.value());
}

void HostChoice::chooseEntity(const std::string& name) {
  if (name.empty()) return;
  disEntity = name;
  const std::optional<double> number = readNumber(name);
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  if (number && *number >= 0 && *number <= kMost && *number == std::floor(*number))
    entity = static_cast<std::uint16_t>(*number);
}

std::string HostChoice::ofDis() const {
  return disEntity.empty() && entity != 0 ? std::to_string(entity) : disEntity;
}

struct HostDecoder::Link {
  HostChoice choice;
  std::vector<std::unique_ptr<OneSender>> senders;
  OneSender* followed = nullptr;  ///< whose health is shown
  OneSender* newest = nullptr;    ///< the last one that was understood
  std::uint64_t received = 0;
  std::uint64_t unnumbered = 0;  ///< states of a protocol without frame numbers
  bool understood = false;
  HostStatistics none;

  OneSender& senderOf(const Datagram& datagram);
  void forgetOne();
  void follow(OneSender& sender);
};

OneSender& HostDecoder::Link::senderOf(const Datagram& datagram) {
  for (const auto& sender : senders)
    if (sender->statistics().from == datagram.from) return *sender;
  if (followed && followed->goesOnWith(datagram)) {
    followed->moveTo(datagram.from);
    return *followed;
  }
  if (senders.size() == kMostSenders) forgetOne();
  senders.push_back(std::make_unique<OneSender>(datagram.from, choice));
  return *senders.back();
}

void HostDecoder::Link::forgetOne() {
  const auto least = std::min_element(senders.begin(), senders.end(), [this](const auto& a, const auto& b) {
    if ((a.get() == followed) != (b.get() == followed)) return b.get() == followed;
    return a->lastHeard() < b->lastHeard();
  });
  if (least->get() == newest) newest = followed;
  senders.erase(least);
}

/// A host that appears is followed at once, because that is what a restarted one looks like. The one before
/// it is followed again only after a silence, so that two hosts do not take turns.
void HostDecoder::Link::follow(OneSender& sender) {
  if (&sender == followed) return;
  const auto takesOver = [&] {
    if (!followed) return true;
    if (sender.isHost() != followed->isHost()) return sender.isHost();
    if (sender.isHost() && !sender.understood()) return false;
    return sender.isNew() || sender.lastHeard() - followed->lastHeard() > kSilenceS;
  };
  if (takesOver())
    followed = &sender;
  else
    sender.noteAlongside();
}

HostDecoder::HostDecoder(const HostChoice& choice) : link_(std::make_unique<Link>()) {
  link_->choice = choice;
}
HostDecoder::~HostDecoder() = default;
HostDecoder::HostDecoder(HostDecoder&&) noexcept = default;
HostDecoder& HostDecoder::operator=(HostDecoder&&) noexcept = default;

std::optional<AircraftState> HostDecoder::accept(const Datagram& datagram) {
  ++link_->received;
  OneSender& sender = link_->senderOf(datagram);
  std::optional<AircraftState> state = sender.accept(datagram);
  link_->understood = sender.understood();
  if (sender.understood()) link_->newest = &sender;
  link_->follow(sender);
  if (state && !isCigi(sender.statistics().protocol)) state->packet = link_->unnumbered++;
  return state;
}

const HostStatistics& HostDecoder::statistics() const {
  return link_->followed ? link_->followed->statistics() : link_->none;
}
std::vector<HostStatistics> HostDecoder::otherSenders() const {
  std::vector<HostStatistics> others;
  for (const auto& sender : link_->senders)
    if (sender.get() != link_->followed) others.push_back(sender->statistics());
  return others;
}
std::uint64_t HostDecoder::received() const {
  return link_->received;
}
bool HostDecoder::understood() const {
  return link_->understood;
}
double HostDecoder::rateAt(double now) const {
  return link_->followed ? link_->followed->meter().rateAt(now) : 0;
}
std::shared_ptr<const HostSymbols> HostDecoder::symbols() const {
  return link_->newest ? link_->newest->symbols() : nullptr;
}
void HostDecoder::takeQueries(std::vector<TerrainQuery>& queries) {
  if (link_->newest) link_->newest->takeQueries(queries);
}
std::optional<std::uint32_t> HostDecoder::lastHostFrame() const {
  return link_->newest ? link_->newest->lastFrame() : std::nullopt;
}
WireProtocol HostDecoder::hostProtocol() const {
  return link_->newest ? link_->newest->statistics().protocol : WireProtocol::none;
}
ByteOrder HostDecoder::hostOrder() const {
  return link_->newest ? link_->newest->byteOrder() : ByteOrder::big;
}

void HostDecoder::reset() {
  const HostChoice choice = link_->choice;
  link_ = std::make_unique<Link>();
  link_->choice = choice;
}

}  // namespace trimtab
