#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/core/terrain/baked_sample.h"
#include "tests/support.h"
#include "trimtab/host/flight.h"
#include "trimtab/measure/trace.h"
#include "trimtab/preset/preset.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/synthetic/sample.h"

/// What tests of trimtab-ig share: a small terrain, presets, a flight over it, and the program as a child
/// process.
namespace trimtab::test {

/// A few kilometres of the sample terrain as a baked database; made once a program.
inline const std::filesystem::path& smallTerrain() {
  static const ScratchDir dir;
  static const bool baked = bakedSample(dir.path(), {3, 12, 60, {}}) != nullptr;
  static const std::filesystem::path database = baked ? dir / "terrain" : std::filesystem::path();
  return database;
}

inline ValidatedParameters edited(const std::function<void(TuningParameters&)>& edit) {
  TuningParameters parameters;
  edit(parameters);
  return validate(parameters).value();
}
inline std::string exported(const ValidatedParameters& parameters) {
  return exportText(parameters, "test", {"", "2026-01-01T00:00:00Z", "test", "", ""}, ExportFormat::json);
}

/// A weaving climb and descent over the middle of the sample, through every band.
inline Flight weavingFlight(int rows, double rateHz = 60) {
  Flight flight;
  for (int i = 0; i < rows; ++i) {
    const double t = i / rateHz, phase = 2 * M_PI * i / rows;
    AircraftState state;
    state.time = t;
    state.packet = static_cast<std::uint64_t>(i);
    state.position = {Degrees{36.63 + 0.02 * std::sin(phase)}, Degrees{128.35 + 0.02 * std::cos(phase)},
                      Feet{6000 - 3000 * std::cos(phase) + 20 * std::sin(i * 1.7)}.as<Metres>()};
    state.attitude = {Degrees{std::fmod(400 - phase * 180 / M_PI, 360)}, Degrees{8 * std::sin(3 * phase)},
                      Degrees{5}};
    flight.states.push_back(state);
  }
  return flight;
}

/// The program as a child, its output in files.
class IgProcess {
 public:
  explicit IgProcess(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{program("trimtab-ig").string()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& argument : all) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const std::string out = (dir_ / "out").string(), err = (dir_ / "err").string();
    std::fflush(nullptr);  // else the child writes it, too
    pid_ = ::fork();
    if (pid_ != 0) return;
    if (!std::freopen(out.c_str(), "w", stdout) || !std::freopen(err.c_str(), "w", stderr)) ::_exit(126);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~IgProcess() {
    if (pid_ > 0 && !ended_) {
      ::kill(pid_, SIGKILL);
      end();
    }
  }
  IgProcess(const IgProcess&) = delete;
  IgProcess& operator=(const IgProcess&) = delete;

  pid_t pid() const { return pid_; }
  std::string out() const { return readFile(dir_ / "out"); }
  std::string err() const { return readFile(dir_ / "err"); }
  void signal(int number) const { ::kill(pid_, number); }

  /// Whether `condition` came true before a generous limit.
  bool until(const std::function<bool()>& condition) const {
    for (int i = 0; i < 3000; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }
  bool says(const std::string& text, std::size_t times = 1) const {
    return until([&] {
      const std::string all = err();
      std::size_t count = 0;
      for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + 1)) ++count;
      return count >= times;
    });
  }
  /// The port that it listens on; 0 when it never says so.
  std::uint16_t port() const {
    const std::string lead = "listening on UDP port ";
    if (!says(lead)) return 0;
    const std::string all = err();
    return static_cast<std::uint16_t>(std::stoi(all.substr(all.find(lead) + lead.size())));
  }
  /// Seconds of processor time that it has used.
  double cpuSeconds() const {
    std::istringstream stat(readFile("/proc/" + std::to_string(pid_) + "/stat"));
    std::string field;
    double ticks = 0;
    for (int i = 1; i <= 15 && stat >> field; ++i)
      if (i >= 14) ticks += std::stod(field);
    return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
  }
  /// The share of a core that it takes when left alone: of three stretches of so many seconds the first one
  /// below `idle`, else the least.
  double share(int seconds, double idle) const {
    double least = 1;
    for (int i = 0; i < 3 && least >= idle; ++i) {
      const double before = cpuSeconds();
      std::this_thread::sleep_for(std::chrono::seconds(seconds));
      least = std::min(least, (cpuSeconds() - before) / seconds);
    }
    return least;
  }
  /// Waits for the end; the exit code, or 128 + signal.
  int end() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    ended_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  nlohmann::json summary() const { return nlohmann::json::parse(out(), nullptr, false); }

 private:
  ScratchDir dir_;
  pid_t pid_ = -1;
  bool ended_ = false;
};

/// Decides the rows' states once more, in order, from nothing but the states.
inline std::vector<FrameDecision> decided(const std::vector<TraceRow>& rows,
                                          const ValidatedParameters& parameters) {
  DecisionMemory memory;
  std::vector<FrameDecision> decisions;
  for (const TraceRow& row : rows)
    decisions.push_back(decide({row.input.state, row.input.aboveGround, {}, {}, {}}, parameters, memory));
  return decisions;
}

}  // namespace trimtab::test
