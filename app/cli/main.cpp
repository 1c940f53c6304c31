#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

#include "app/link/stop_signals.h"
#include "app/manual/cli11_command.h"
#include "commands.h"
#include "progress.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/labelled.h"

namespace trimtab::cli {

void report(const Findings& findings) {
  std::cerr << labelled(findings);
}

int writeOut(const std::string& output, const std::string& text) {
  if (output.empty() || output == "-") {
    std::cout << text << std::flush;
    return std::cout ? kDone : kRefused;
  }
  const auto written = writeAtomically(output, text);
  report(written.findings());
  return written ? kDone : kRefused;
}

namespace {

/// Returns failure if the output could not be written, because a program that reads it must not mistake half
/// of it for all; else `exitCode`, which is that of the command.
int finished(int exitCode) {
  std::cout.flush();
  const int error = std::fflush(stdout) != 0 ? errno : 0;
  if (std::cout && error == 0 && std::ferror(stdout) == 0) return exitCode;
  report({{Severity::error, "standard output", "", "to be written to the end",
           error != 0 ? std::strerror(error) : "a write that failed"}});
  return exitCode == kDone ? kRefused : exitCode;
}

}  // namespace
}  // namespace trimtab::cli

int main(int argc, char** argv) {
  trimtab::handleStopSignals();
  trimtab::failLargeWrites();
  CLI::App app{"Trimtab: tune culling and level of detail of image generators"};
  app.set_version_flag("--version", TRIMTAB_VERSION);
  app.require_subcommand(1);
  trimtab::manual::addManualOption(app, "trimtab-cli");
  int exitCode = trimtab::cli::kDone;
  trimtab::cli::addPreset(app, exitCode);
  trimtab::cli::addDecide(app, exitCode);
  trimtab::cli::addTerrain(app, exitCode);
  trimtab::cli::addFeed(app, exitCode);
  trimtab::cli::addBench(app, exitCode);
  trimtab::cli::addResults(app, exitCode);
  trimtab::cli::addExperiment(app, exitCode);
  trimtab::cli::addLeverage(app, exitCode);
  trimtab::cli::addFit(app, exitCode);
  trimtab::cli::addTune(app, exitCode);
  trimtab::cli::addWeather(app, exitCode);
  app.parse_complete_callback([&app] {
    if (!trimtab::cli::stopsWhenAsked(app)) trimtab::endAtStopSignals();
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return trimtab::cli::finished(app.exit(error) == 0 ? trimtab::cli::kDone : trimtab::cli::kUsage);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return trimtab::cli::finished(trimtab::cli::kRefused);
  }
  return trimtab::cli::finished(exitCode);
}
