#include "options.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <map>

#include "app/link/log_options.h"
#include "app/manual/cli11_command.h"
#include "trimtab/host/protocol_names.h"
#include "trimtab/scene/osg_database.h"

namespace trimtab::ig {
namespace {

constexpr int kLargestSide = 16384;

/// "1280x720" to its two numbers; a message when it is not that.
std::string parseSize(const std::string& text, Options& options) {
  const std::size_t cross = text.find('x');
  const auto side = [](const std::string& part, int& value) {
    return CLI::detail::lexical_cast(part, value) && value >= 1 && value <= kLargestSide;
  };
  if (cross != std::string::npos && side(text.substr(0, cross), options.width) &&
      side(text.substr(cross + 1), options.height))
    return {};
  return "expected WxH with sides of 1 to " + std::to_string(kLargestSide) + " px, found " + text;
}

}  // namespace

std::optional<Options> parseOptions(int argc, char** argv, int& exitCode) {
  Options options;
  CLI::App app{
      "Trimtab's reference image generator: draws what a host or a flight asks for, as an exported preset "
      "says"};
  app.set_version_flag("--version", TRIMTAB_VERSION);
  manual::addManualOption(app, "trimtab-ig");
  app.add_option("--preset", options.preset, "exported preset, edited preset, or a shipped one's name")
      ->required();
  app.add_option("--terrain", options.terrain,
                 "baked terrain database ('trimtab-cli terrain bake' makes one) or a scene of OpenSceneGraph")
      ->required();
  app.add_option("--origin", options.origin, scene::kOriginHelp);
  std::map<std::string, HostProtocol> protocols{{"auto", HostProtocol::automatic}};
  for (const ProtocolName& name : kProtocols) protocols.emplace(name.option, name.wanted);
  auto* listen =
      app.add_option("--listen", options.listen, "UDP port of the host's packets; 0: any free one");
  app.add_option(
         "--bind", options.bindAddress,
         "address of the interface to listen on; without it only this machine can send; 0.0.0.0: every one; "
         "::: every one, also of IPv6")
      ->needs(listen)
      ->capture_default_str();
  app.add_option("--group", options.group, "multicast group to join on that interface")->needs(listen);
  app.add_option("--from", options.sender,
                 "who may send: any, first (the first one to send a good packet, from then on), or an "
                 "address, with a "
                 "port if one of several hosts there is meant")
      ->needs(listen)
      ->capture_default_str();
  app.add_option(
         "--reply", options.reply,
         "HOST:PORT that gets a Start of Frame for each frame's time, with the answers to requests of "
         "heights and lines of sight")
      ->needs(listen);
  app.add_option("--protocol", options.protocol, "what the host speaks, if it is not to be recognised")
      ->needs(listen)
      ->transform(CLI::CheckedTransformer(protocols));
  app.add_option("--entity", options.entity, link::kEntityHelp)->needs(listen);
  app.add_option("--view", options.view,
                 "the view that is drawn, of those the host controls, in place of the preset's host.view")
      ->needs(listen);
  auto* flight =
      app.add_option("--flight", options.flight, "flight (CSV, pcap) or decision trace: one frame a row");
  app.add_option("--columns", options.columns, link::kColumnsHelp)->needs(flight);
  app.add_flag("--realtime", options.realtime, "play the flight on its own clock")->needs(flight);
  app.add_option(
      "--head", options.head,
      "head log, or sweep:DEG/S[/WAIT] or nod:DEG/S[/WAIT], in place of the heads of host or flight");
  app.add_option("--head-columns", options.headColumns, link::kHeadColumnsHelp);
  app.add_flag("--skip-bad-rows", options.skipBadRows,
               "read the head log without the rows that cannot be used");
  app.add_flag("--headless", options.headless, "draw without a window");
  app.add_option("--size", "size of the picture, WxH")->check([&options](const std::string& text) {
    return parseSize(text, options);
  });
  app.add_option("--frames", options.frames, "end after so many frames; 0: no end");
  app.add_option("--trace", options.trace, "write every decided packet to this CSV file");
  app.add_option("--screenshot", options.screenshot, "write the last frame to this PNG file");
  app.add_option("--health", options.health,
                 "write memory, handles, threads, GL objects and latency to this CSV file every ten seconds");
  app.add_flag(
      "--watch", options.watch,
      "load the preset again whenever its file changes, and the terrain whenever another one is there");
  app.add_flag("--json", options.json, "print the summary as JSON");
  listen->excludes(flight);
  try {
    app.parse(argc, argv);
    if (!options.listen && options.flight.empty()) throw CLI::RequiredError("--listen or --flight");
  } catch (const CLI::ParseError& error) {
    exitCode = app.exit(error) == 0 ? kDone : kUsage;
    // Help or version that a full disk took.
    if (exitCode == kDone && (std::fflush(stdout) != 0 || !std::cout.flush())) {
      std::cerr << "error: standard output: expected to be written, found " << std::strerror(errno) << '\n';
      exitCode = kRefused;
    }
    return std::nullopt;
  }
  return options;
}

}  // namespace trimtab::ig
