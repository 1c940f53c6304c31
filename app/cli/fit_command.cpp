#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <iostream>
#include <memory>
#include <thread>

#include "commands.h"
#include "progress.h"
#include "settings.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/stop_request.h"
#include "trimtab/rig/fitted_preset.h"
#include "trimtab/rig/limited_preset.h"

namespace trimtab::cli {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

struct FitOptions {
  std::string profile, preset = "default", flight, output;
  std::vector<std::string> command;
};

/// The image generator while it flies a fit, in an environment that asks libtrimtab for one. It is a group of
/// processes, because a command may be a script that starts it.
class Generator {
 public:
  /// Starts it; `error` is then 0.
  Generator(const std::vector<std::string>& command, const std::string& profile, const fs::path& fit) {
    std::vector<std::string> words = command, settings{"TRIMTAB_PROFILE=" + fs::absolute(profile).string(),
                                                       "TRIMTAB_FIT=" + fs::absolute(fit).string()};
    std::vector<char*> arguments, environment;
    for (std::string& word : words) arguments.push_back(word.data());
    for (std::string& setting : settings) environment.push_back(setting.data());
    for (char** each = environ; *each != nullptr; ++each)
      if (std::strncmp(*each, "TRIMTAB_PROFILE=", 16) != 0 && std::strncmp(*each, "TRIMTAB_FIT=", 12) != 0)
        environment.push_back(*each);
    arguments.push_back(nullptr), environment.push_back(nullptr);
    posix_spawn_file_actions_t actions;  // what it prints is no result of ours
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    error =
        posix_spawnp(&process_, arguments[0], &actions, &attributes, arguments.data(), environment.data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    ended_ = error != 0;
  }
  ~Generator() { end(); }
  Generator(const Generator&) = delete;
  Generator& operator=(const Generator&) = delete;

  /// Reports whether it has ended; `status` is then as waitpid() gives it.
  bool hasEnded() {
    if (!ended_) ended_ = waitpid(process_, &status, WNOHANG) != 0;
    return ended_;
  }
  /// Asks it to end, and ends it after three seconds.
  void end() {
    if (hasEnded()) return;
    ::kill(-process_, SIGTERM);
    for (int i = 0; i < 30 && !hasEnded(); ++i) std::this_thread::sleep_for(100ms);
    if (hasEnded()) return;
    ::kill(-process_, SIGKILL);
    waitpid(process_, &status, 0);
    ended_ = true;
  }
  int error = 0, status = 0;

 private:
  pid_t process_ = -1;
  bool ended_ = false;
};

/// Returns the command with the names of files in place of {preset} and {flight}.
std::vector<std::string> filledIn(std::vector<std::string> command, const std::string& preset,
                                  const std::string& flight) {
  for (std::string& word : command)
    for (const auto& [name, file] : {std::pair{std::string_view("{preset}"), preset}, {"{flight}", flight}})
      for (std::size_t at = 0; (at = word.find(name, at)) != std::string::npos; at += file.size())
        word.replace(at, name.size(), file);
  return command;
}

/// Sees that a file of this name is of a run before, not somebody else's.
template <class Read>
bool mayTakeItsPlace(const fs::path& file, const Read& read) {
  std::error_code ignored;
  if (!fs::exists(file, ignored) || read(file)) return true;
  report({{Severity::error, file.string(), "", "a new folder, or that of a fit before",
           "another file of this name"}});
  return false;
}

/// Flies the fit. Returns false if there is nothing to go on with. A fit of a run before stays until this one
/// has written something.
bool flew(const FitOptions& options, const std::vector<std::string>& command, const fs::path& target) {
  std::error_code ignored;
  const fs::path file = target.parent_path() / "fit.part.json";
  fs::remove(file, ignored);  // left by a run that was killed
  Generator generator(command, options.profile, file);
  if (generator.error != 0) {
    report({{Severity::error, command.front(), "", "a program that can be run",
             std::strerror(generator.error)}});
    return false;
  }
  const auto progress = progressLines();
  while (!generator.hasEnded()) {
    std::this_thread::sleep_for(100ms);
    const Result<IgFit> so = fs::exists(file, ignored) ? loadIgFit(file) : Result<IgFit>(Findings{});
    const std::size_t views = so ? so->views : 0;
    const double share = std::min(1.0, static_cast<double>(views) / kFewestFitViews);
    if (progress(share, std::to_string(views) + " views")) continue;
    generator.end();
    break;
  }
  if (!WIFEXITED(generator.status) || WEXITSTATUS(generator.status) != 0) {
    const std::string how = WIFEXITED(generator.status)
                                ? "exit status " + std::to_string(WEXITSTATUS(generator.status))
                                : "signal " + std::to_string(WTERMSIG(generator.status));
    report(
        {{stopRequested() ? Severity::note : Severity::warning, command.front(), "", "exit status 0", how}});
  }
  // What it wrote until then counts.
  if (!fs::exists(file, ignored)) {
    report({{Severity::error, target.string(), "",
             "a fit of at least " + std::to_string(kFewestFitViews) +
                 " views, written by a program that links libtrimtab: fly longer, or look at its output",
             "none"}});
    return false;
  }
  const auto placed = putInPlace(file, target);
  report(placed.findings());
  return placed.ok();
}

bool wroteExport(const fs::path& file, const Preset& preset, const TuningParameters& parameters) {
  const auto valid = validate(parameters);
  report(valid.findings());
  if (!valid) return false;
  const auto written =
      writeAtomically(file, exportText(*valid, preset.name, provenanceNow(), ExportFormat::json));
  report(written.findings());
  return written.ok();
}

int run(const FitOptions& options) {
  const fs::path folder = options.output, fitFile = folder / "fit.json", flown = folder / "flown.json",
                 fittedFile = folder / "fitted.json";
  const auto may = makeWritable(folder);
  const auto profile = loadIgProfile(options.profile);
  const auto preset = loadPreset(options.preset);
  for (const Findings& findings : {may.findings(), profile.findings(), preset.findings()}) report(findings);
  if (!may || !profile || !preset) return kRefused;
  const auto wantsFlight = [](const std::string& word) { return word.find("{flight}") != std::string::npos; };
  if (options.flight.empty() && std::ranges::any_of(options.command, wantsFlight)) {
    report({{Severity::error, "--flight", "", "the flight that stands in place of {flight}", "none"}});
    return kRefused;
  }
  const auto isPreset = [](const fs::path& file) { return loadPreset(file.string()).ok(); };
  if (!mayTakeItsPlace(fitFile, [](const fs::path& file) { return loadIgFit(file).ok(); }) ||
      !mayTakeItsPlace(flown, isPreset) || !mayTakeItsPlace(fittedFile, isPreset))
    return kRefused;
  if (!options.command.empty()) {
    const auto limited = limitedTo(*profile, preset->parameters, options.preset);
    if (!wroteExport(flown, *preset, *limited) ||
        !flew(options, filledIn(options.command, flown.string(), options.flight), fitFile))
      return kRefused;
  }
  const auto fit = loadIgFit(fitFile);
  report(fit.findings());
  if (!fit) return kRefused;
  const auto fitted = fittedTo(*profile, *fit, preset->parameters, options.preset);
  report(fitted.findings());
  if (!fitted) return kRefused;
  std::cout << report(*fit, *profile);
  if (!wroteExport(fittedFile, *preset, *fitted)) return kRefused;
  std::cout << "The fitted preset is " << fittedFile.string() << ".\n";
  return stopRequested() ? kRefused : kDone;
}

}  // namespace

void addFit(CLI::App& app, int& exitCode) {
  CLI::App* const command =
      app.add_subcommand("fit", "Fit a preset to an image generator that is not ours, by flying it");
  command->footer(
      "COMMAND, after two dashes, starts an image generator that links libtrimtab; {preset} and {flight} in "
      "it "
      "stand for their files: trimtab-cli fit --profile ig.json --preset low-level -o fit -- my_ig {preset}. "
      "Each view is drawn with one lever at a time moved. Without COMMAND, the fit in the folder is "
      "applied.");
  auto options = std::make_shared<FitOptions>();
  command->add_option("--profile", options->profile, "What the image generator has and reports")->required();
  command->add_option("--preset", options->preset, "Preset to fit")->capture_default_str();
  command->add_option("--flight", options->flight, "What stands in place of {flight}");
  command
      ->add_option("-o,--output", options->output,
                   "Folder for fit.json, flown.json (the preset that is flown) and fitted.json")
      ->required();
  command->add_option("command", options->command, "The image generator and its arguments");
  stopWhenAsked(*command);
  command->callback([options, &exitCode] { exitCode = run(*options); });
}

}  // namespace trimtab::cli
