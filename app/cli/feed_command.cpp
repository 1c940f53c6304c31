#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <thread>

#include "app/link/head_option.h"
#include "app/link/link.h"
#include "commands.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/number.h"

namespace trimtab::cli {
namespace {

using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t interrupted = 0;

void catchInterrupt() {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = 1; };
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

/// When a command ends by itself; without limits only an interrupt ends it.
struct Ending {
  double seconds = 0;         ///< 0: never
  std::uint64_t packets = 0;  ///< 0: never
  Clock::time_point begin = Clock::now();

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin).count(); }
  bool reached(std::uint64_t count) const {
    return interrupted != 0 || (packets > 0 && count >= packets) || (seconds > 0 && elapsed() >= seconds);
  }
};

void nap() {
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

/// Calls a function once a second on a grid from its creation.
class EverySecond {
 public:
  template <class F>
  void operator()(F&& report) {
    if (Clock::now() < due_) return;
    report();
    called_ = true;
    due_ += std::chrono::seconds(1);
  }
  bool justCalled() const { return called_ && due_ - Clock::now() > std::chrono::milliseconds(900); }

 private:
  Clock::time_point due_ = Clock::now() + std::chrono::seconds(1);
  bool called_ = false;
};

struct Options {
  std::string flight, head, to, out, protocol = "cigi3", listenProtocol = "auto", reply, bind = "0.0.0.0";
  double rateHz = 60, speed = 1, startS = 0;
  bool loop = false;
  bool skipBadRows = false;  ///< of the head log
  bool symbols = false;
  int listen = 0;
  Ending ending;
};

int play(const Options& options) {
  const auto to = link::parseEndpoint(options.to);
  if (!to) {
    report(to.findings());
    return kUsage;
  }
  auto flight = readFlight(options.flight);
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
    auto head = link::openHeadOption(options.head, options.skipBadRows);
    report(head.findings());
    if (!head) return kRefused;
    how.head = std::move(*head);
  }
  how.to = *to;
  how.protocol = options.protocol == "native-fdm" ? WireProtocol::native_fdm : WireProtocol::cigi3;
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

Result<std::unique_ptr<link::Receiver>> openReceiver(const Options& options) {
  link::ReceiverOptions how;
  how.port = static_cast<std::uint16_t>(options.listen);
  how.bindAddress = options.bind;
  how.protocol = options.listenProtocol == "native-fdm" ? HostProtocol::native_fdm
                 : options.listenProtocol == "cigi3"    ? HostProtocol::cigi3
                                                        : HostProtocol::automatic;
  if (!options.reply.empty()) {
    const auto reply = link::parseEndpoint(options.reply);
    if (!reply) return reply.findings();
    how.reply = *reply;
  }
  return link::Receiver::open(how);
}

const char* protocolText(WireProtocol protocol) {
  switch (protocol) {
    case WireProtocol::native_fdm:
      return "native-fdm";
    case WireProtocol::cigi3:
      return "cigi3";
    case WireProtocol::none:
      break;
  }
  return "no host";
}

/// Counters worth a word, on one line.
std::string health(const HostStatistics& s) {
  char text[256];
  std::snprintf(text, sizeof text, "%s %.2f Hz jitter %.3f ms lost %s bad %llu", protocolText(s.protocol),
                s.rateHz, s.jitterMs, s.lost ? std::to_string(*s.lost).c_str() : "n/a",
                static_cast<unsigned long long>(s.bad));
  std::string line = text;
  const auto append = [&line](const char* name, std::uint64_t count) {
    if (count > 0) line += std::string(" ") + name + ' ' + std::to_string(count);
  };
  append("truncated", s.truncated);
  append("not-ready", s.notReady);
  append("repeated", s.repeated);
  append("late", s.reordered);
  append("restarts", s.restarts);
  append("silences", s.silences);
  append("jumps", s.jumps);
  append("regional-weather", s.regionalWeather);
  append("other-weather-layers", s.otherLayers);
  append("symbol-packets", s.symbolPackets);
  append("refused-symbols", s.refusedSymbols);
  return line;
}

void printFirstBad(const HostStatistics& s) {
  if (!s.firstSymbolReason.empty())
    std::fprintf(stderr, "first refused symbol packet: %s\n", s.firstSymbolReason.c_str());
  if (s.firstBadReason.empty()) return;
  std::fprintf(stderr, "first bad datagram: %s\n  %s\n", s.firstBadReason.c_str(), s.firstBadHex.c_str());
}

bool isPcap(const std::string& file) {
  return std::filesystem::path(file).extension() == ".pcap";
}

Result<Done> writeRecording(const std::string& file, const std::vector<CapturedDatagram>& datagrams) {
  if (isPcap(file)) return writePcap(file, datagrams);
  auto flight = flightFromDatagrams(datagrams, "recording");
  if (!flight) return flight.findings();
  const auto written = writeAtomically(file, flightCsv(*flight));
  if (!written) return written.findings();
  return {Done{}, flight.findings()};
}

int record(const Options& options) {
  // Before anything is received: an hour of recording must not end at a folder that is not there.
  const std::filesystem::path folder = std::filesystem::absolute(options.out).parent_path();
  if (std::error_code failed; !std::filesystem::is_directory(folder, failed)) {
    report({{Severity::error, options.out, "", "a folder that exists", folder.string()}});
    return kRefused;
  }
  std::mutex mutex;
  std::vector<CapturedDatagram> datagrams;
  auto receiver = openReceiver(options);
  if (!receiver) {
    report(receiver.findings());
    return kRefused;
  }
  const std::string own = "127.0.0.1:" + std::to_string((*receiver)->port());
  (*receiver)->tap([&](const Datagram& d) {
    const std::lock_guard lock(mutex);
    datagrams.push_back({d.arrival, d.from, own, {d.bytes.begin(), d.bytes.end()}});
  });
  std::fprintf(stderr, "listening on port %u\n", static_cast<unsigned>((*receiver)->port()));
  Ending ending = options.ending;
  ending.begin = Clock::now();
  EverySecond everySecond;
  const auto count = [&] {
    const std::lock_guard lock(mutex);
    return datagrams.size();
  };
  while (!ending.reached(count())) {
    nap();
    everySecond([&] {
      std::fprintf(stderr, "%zu datagrams, %s\n", count(), health((*receiver)->statistics()).c_str());
    });
  }
  const HostStatistics statistics = (*receiver)->statistics();
  (*receiver).reset();
  printFirstBad(statistics);
  if (datagrams.empty()) {
    report(
        {{Severity::error, options.out, "", "datagrams of a host on port " + own.substr(own.rfind(':') + 1),
          "none in " + numberText(ending.elapsed(), 3) + " s; nothing written"}});
    return kRefused;
  }
  const auto written = writeRecording(options.out, datagrams);
  report(written.findings());
  if (!written) return kRefused;
  std::fprintf(stderr, "%zu datagrams recorded in %s\n", datagrams.size(), options.out.c_str());
  return kDone;
}

int show(const Options& options) {
  auto receiver = openReceiver(options);
  if (!receiver) {
    report(receiver.findings());
    return kRefused;
  }
  std::fprintf(stderr, "listening on port %u\n", static_cast<unsigned>((*receiver)->port()));
  Ending ending = options.ending;
  ending.begin = Clock::now();
  EverySecond everySecond;
  std::vector<ReceivedState> states;
  std::optional<ReceivedState> last;
  bool badShown = false;
  const auto line = [&] {
    const HostStatistics statistics = (*receiver)->statistics();
    std::string text = health(statistics);
    char more[256];
    if (last) {
      const AircraftState& s = last->state;
      std::snprintf(more, sizeof more,
                    " age %.0f ms latency %.3f ms at %.6f %.6f %.1f ft heading %.1f pitch %.1f roll %.1f",
                    (link::now() - last->kernelTime) * 1e3, (last->decodedTime - last->kernelTime) * 1e3,
                    s.position.latitude.value(), s.position.longitude.value(), s.position.height.in<Feet>(),
                    s.attitude.heading.value(), s.attitude.pitch.value(), s.attitude.roll.value());
      text += more;
    }
    std::puts(text.c_str());
    std::fflush(stdout);
    if (!badShown && !(statistics.firstBadReason.empty() && statistics.firstSymbolReason.empty())) {
      printFirstBad(statistics);
      badShown = true;
    }
  };
  for (;;) {
    (*receiver)->take(states);
    if (!states.empty()) last = states.back();
    if (ending.reached((*receiver)->statistics().received)) break;
    nap();
    everySecond(line);
  }
  if (!everySecond.justCalled()) line();
  return kDone;
}

void addEnding(CLI::App* command, Options& options) {
  command->add_option("--seconds", options.ending.seconds, "End after so long")->check(CLI::PositiveNumber);
  command->add_option("--packets", options.ending.packets, "End after so many packets")
      ->check(CLI::PositiveNumber);
}

void addListening(CLI::App* command, Options& options) {
  command->add_option("--listen", options.listen, "UDP port to receive on")
      ->required()
      ->check(CLI::Range(1, 65535));
  command->add_option("--bind", options.bind, "Own IPv4 address to receive at")->capture_default_str();
  command->add_option("--protocol", options.listenProtocol, "What the host speaks")
      ->check(CLI::IsMember({"auto", "native-fdm", "cigi3"}))
      ->capture_default_str();
  command->add_option("--reply", options.reply, "HOST:PORT that gets a CIGI Start of Frame at 60 Hz");
  addEnding(command, options);
}

}  // namespace

void addFeed(CLI::App& app, int& exitCode) {
  const auto options = std::make_shared<Options>();
  CLI::App* feed = app.add_subcommand("feed", "Play, record and watch a host's feed over UDP");
  feed->require_subcommand(1);
  const auto run = [options, &exitCode](CLI::App* command, int (*work)(const Options&)) {
    command->callback([options, &exitCode, work] {
      catchInterrupt();
      exitCode = work(*options);
    });
  };

  CLI::App* playing = feed->add_subcommand("play", "Send a flight as a host would");
  playing->add_option("flight", options->flight, "Flight CSV, decision trace or .pcap of a host")->required();
  playing->add_option("--head", options->head,
                      "Head log, or sweep:DEG/S[/WAIT] or nod:DEG/S[/WAIT], sent as View Control (cigi3)");
  playing->add_flag("--skip-bad-rows", options->skipBadRows,
                    "Read the head log without the rows that cannot be used");
  playing->add_option("--to", options->to, "HOST:PORT")->required();
  playing->add_option("--protocol", options->protocol, "What to speak")
      ->required()
      ->check(CLI::IsMember({"native-fdm", "cigi3"}));
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
  run(recording, record);

  CLI::App* showing = feed->add_subcommand("show", "One line a second: rate, jitter, loss, age, position");
  addListening(showing, *options);
  run(showing, show);
}

}  // namespace trimtab::cli
