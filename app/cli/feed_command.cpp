#include <cstdio>
#include <memory>

#include "app/link/link.h"
#include "app/link/log_options.h"
#include "commands.h"
#include "feed_work.h"
#include "progress.h"
#include "trimtab/host/protocol_names.h"

namespace trimtab::cli {
namespace {

int play(const FeedOptions& options) {
  const auto to = link::parseEndpoint(options.to);
  if (!to) {
    report(to.findings());
    return kUsage;
  }
  auto flight = link::openFlightOption(options.flight, options.columns);
  report(flight.findings());
  if (!flight) return kRefused;
  const double durationS = flight->durationS();
  if (options.startS > durationS) {
    char most[64], found[32];
    std::snprintf(most, sizeof most, "at most %.1f s, the flight's end", durationS);
    std::snprintf(found, sizeof found, "%g", options.startS);
    report({{Severity::error, options.flight, "--start-s", most, found}});
    return kRefused;
  }
  link::PlayOptions how;
  if (!options.head.empty()) {
    auto head = link::openHeadOption(options.head, options.skipBadRows, options.headColumns);
    report(head.findings());
    if (!head) return kRefused;
    how.head = std::move(*head);
  }
  how.to = *to;
  if (const ProtocolName* name = nameOf(options.protocol)) how.protocol = name->wire;
  how.rateHz = options.rateHz;
  how.speed = options.speed;
  how.loop = options.loop;
  how.symbols = options.symbols;
  how.startS = options.startS;
  auto player = link::FeedPlayer::start(std::move(*flight), how);
  if (!player) {
    report(player.findings());
    return kRefused;
  }
  Ending ending = options.ending;
  ending.begin = Clock::now();
  EverySecond everySecond;
  const auto progress = [&] {
    std::fprintf(stderr, "%.1f of %.1f s, %llu packets sent\n", (*player)->position(), durationS,
                 static_cast<unsigned long long>((*player)->sent()));
  };
  while (!(*player)->finished() && !ending.reached((*player)->sent())) {
    nap();
    everySecond(progress);
  }
  progress();
  return kDone;
}

int show(const FeedOptions& options) {
  auto receiver = openReceiver(options);
  if (!receiver) {
    report(receiver.findings());
    return kRefused;
  }
  sayListening(options, **receiver);
  link::LinkWatch watch((*receiver)->port(), options.bind);
  Ending ending = options.ending;
  ending.begin = Clock::now();
  EverySecond everySecond;
  std::vector<ReceivedState> states;
  std::optional<ReceivedState> last;
  bool badShown = false;
  const auto line = [&] {
    const HostStatistics statistics = (*receiver)->statistics();
    std::string text = health(statistics, (*receiver)->senders());
    char more[256];
    if (last) {
      const AircraftState& s = last->state;
      std::snprintf(more, sizeof more,
                    " age %.0f ms latency %.3f ms at %.6f %.6f %.1f ft%s heading %.1f pitch %.1f roll %.1f",
                    (link::now() - last->kernelTime) * 1e3, (last->decodedTime - last->kernelTime) * 1e3,
                    s.position.latitude.value(), s.position.longitude.value(), s.position.height.in<Feet>(),
                    s.clamp == GroundClamp::none ? "" : " above the ground", s.attitude.heading.value(),
                    s.attitude.pitch.value(), s.attitude.roll.value());
      text += more;
    }
    std::puts(text.c_str());
    std::fflush(stdout);
    if (!badShown && !(statistics.firstBadReason.empty() && statistics.firstRefusedReason.empty())) {
      printFirstBad(statistics);
      badShown = true;
    }
  };
  for (;;) {
    (*receiver)->take(states);
    if (!states.empty()) last = states.back();
    sayWhyNothing(**receiver, watch);
    if (ending.reached((*receiver)->senders().received)) break;
    nap();
    everySecond(line);
    // Nobody reads it; main() says so.
    if (std::ferror(stdout)) return kRefused;
  }
  sayWhyNothing(**receiver, watch);
  if (!everySecond.justCalled()) line();
  return kDone;
}

void addEnding(CLI::App* command, FeedOptions& options) {
  command->add_option("--seconds", options.ending.seconds, "End after so long")->check(CLI::PositiveNumber);
  command->add_option("--packets", options.ending.packets, "End after so many packets")
      ->check(CLI::PositiveNumber);
}

void addListening(CLI::App* command, FeedOptions& options) {
  command->add_option("--listen", options.listen, "UDP port to receive on")
      ->required()
      ->check(CLI::Range(1, 65535));
  command
      ->add_option("--bind", options.bind,
                   "Own address to receive at; without it only this machine can send; 0.0.0.0: every one; "
                   "::: every one, also of IPv6")
      ->capture_default_str();
  command->add_option("--group", options.group, "Multicast group to join on that interface");
  command
      ->add_option(
          "--from", options.from,
          "Who may send: any, first (the first one to send a good packet, from then on), or an address, with "
          "a port if one of several hosts there is meant")
      ->capture_default_str();
  command->add_option("--protocol", options.listenProtocol, "What the host speaks")
      ->check(CLI::IsMember(link::protocolOptions(true)))
      ->capture_default_str();
  command->add_option("--entity", options.entity, link::kEntityHelp);
  command
      ->add_option("--view", options.view,
                   "The view that is followed, of those a CIGI host controls; without it the first one")
      ->check(CLI::Range(0, 65535));
  command->add_option("--reply", options.reply, "HOST:PORT that gets a CIGI Start of Frame at 60 Hz");
  addEnding(command, options);
}

}  // namespace

void addFeed(CLI::App& app, int& exitCode) {
  const auto options = std::make_shared<FeedOptions>();
  CLI::App* feed = app.add_subcommand("feed", "Play, record and watch a host's feed over UDP");
  feed->require_subcommand(1);
  const auto run = [options, &exitCode](CLI::App* command, int (*work)(const FeedOptions&)) {
    stopWhenAsked(*command);
    command->callback([options, &exitCode, work] { exitCode = work(*options); });
  };

  CLI::App* playing = feed->add_subcommand("play", "Send a flight as a host would");
  playing->add_option("flight", options->flight, "Flight CSV, decision trace or .pcap of a host")->required();
  playing->add_option("--head", options->head,
                      "Head log, or sweep:DEG/S[/WAIT] or nod:DEG/S[/WAIT], sent as View Control (cigi3)");
  playing->add_option("--columns", options->columns, link::kColumnsHelp);
  playing->add_option("--head-columns", options->headColumns, link::kHeadColumnsHelp);
  playing->add_flag("--skip-bad-rows", options->skipBadRows,
                    "Read the head log without the rows that cannot be used");
  playing->add_option("--to", options->to, "HOST:PORT")->required();
  playing->add_option("--protocol", options->protocol, "What to speak")
      ->required()
      ->check(CLI::IsMember(link::protocolOptions(false)));
  playing->add_option("--rate-hz", options->rateHz, "Packets a second; 0 sends the flight's rows as they are")
      ->check(CLI::Range(0.0, 10000.0))
      ->capture_default_str();
  playing->add_option("--speed", options->speed, "Flight seconds in a second")
      ->check(CLI::Range(1e-3, 1000.0))
      ->capture_default_str();
  playing->add_option("--start-s", options->startS, "Seconds into the flight to begin at")
      ->check(CLI::NonNegativeNumber);
  playing->add_flag("--loop", options->loop, "Begin again at the end");
  playing->add_flag("--symbols", options->symbols,
                    "Send a small set of radar, weapon and navigation symbols, too (cigi3)");
  addEnding(playing, *options);
  run(playing, play);

  CLI::App* recording = feed->add_subcommand("record", "Record a host, so that it plays again");
  recording->add_option("-o,--output", options->out, "OUT.pcap: the datagrams; any other name: a flight CSV")
      ->required();
  addListening(recording, *options);
  run(recording, recordFeed);

  CLI::App* showing = feed->add_subcommand("show", "One line a second: rate, jitter, loss, age, position");
  addListening(showing, *options);
  run(showing, show);
}

}  // namespace trimtab::cli
