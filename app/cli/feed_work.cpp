#include "feed_work.h"

#include <cstdio>
#include <thread>

#include "trimtab/host/protocol_names.h"

namespace trimtab::cli {
void nap() {
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

Result<std::unique_ptr<link::Receiver>> openReceiver(const FeedOptions& options) {
  link::ReceiverOptions how;
  how.port = static_cast<std::uint16_t>(options.listen);
  how.bindAddress = options.bind;
  how.sender = options.from;
  how.group = options.group;
  if (const ProtocolName* name = nameOf(options.listenProtocol)) how.choice.protocol = name->wanted;
  how.choice.chooseEntity(options.entity);
  if (options.view) how.choice.view = static_cast<std::uint16_t>(*options.view);
  if (!options.reply.empty()) {
    const auto reply = link::parseEndpoint(options.reply);
    if (!reply) return reply.findings();
    how.reply = *reply;
  }
  return link::Receiver::open(how);
}

void sayListening(const FeedOptions& options, const link::Receiver& receiver) {
  std::fprintf(stderr, "listening on port %u of %s, sender: %s\n", static_cast<unsigned>(receiver.port()),
               options.bind.c_str(), receiver.senders().allowed.c_str());
}

void sayWhyNothing(const link::Receiver& receiver, link::LinkWatch& watch) {
  if (const auto line = watch.look(receiver, link::now()))
    std::fprintf(stderr, "warning: %s\n", line->c_str());
}

std::string health(const HostStatistics& s, const link::Senders& senders) {
  char text[256];
  const ProtocolName* const protocol = nameOf(s.protocol);
  std::snprintf(text, sizeof text, "%s %.2f Hz jitter %.3f ms lost %s bad %llu",
                protocol ? protocol->option : "no host", s.rateHz, s.jitterMs,
                s.lost ? std::to_string(*s.lost).c_str() : "n/a", static_cast<unsigned long long>(s.bad));
  std::string line = text;
  const auto append = [&line](const char* name, std::uint64_t count) {
    if (count > 0) line += std::string(" ") + name + ' ' + std::to_string(count);
  };
  append("for-someone-else", s.notForUs);
  append("truncated", s.truncated);
  append("not-ready", s.notReady);
  append("repeated", s.repeated);
  append("late", s.reordered);
  append("implausible", s.implausible);
  append("restarts", s.restarts);
  append("silences", s.silences);
  append("jumps", s.jumps);
  append("regional-weather", s.regionalWeather);
  append("other-weather-layers", s.otherLayers);
  append("symbol-packets", s.symbolPackets);
  if (!s.ownEntity.empty()) line += " entity " + s.ownEntity;
  if (!s.otherEntityNames.empty()) line += " beside " + s.otherEntityNames;
  append("refused-packets", s.refusedPackets);
  append("uncounted", s.uncounted);
  for (const IgnoredPackets& each : s.ignored)
    append(("ignored " + cigiPacketName(each.id)).c_str(), each.count);
  append("of-refused-senders", senders.refused);
  if (senders.refused > 0) line += " last " + senders.lastRefused;
  for (const HostStatistics& other : senders.others) append(("of-" + other.from).c_str(), other.received);
  return line;
}

void printFirstBad(const HostStatistics& s) {
  if (!s.firstRefusedReason.empty())
    std::fprintf(stderr, "first refused packet: %s\n", s.firstRefusedReason.c_str());
  if (s.firstBadReason.empty()) return;
  std::fprintf(stderr, "first bad datagram: %s\n  %s\n", s.firstBadReason.c_str(), s.firstBadHex.c_str());
}

}  // namespace trimtab::cli
