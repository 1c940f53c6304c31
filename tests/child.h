#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/support.h"

/// Programs that run beside a test.
namespace trimtab::test {

/// Waits until a condition holds, for a limit that only a test that fails reaches.
inline bool until(const std::function<bool()>& condition) {
  for (int i = 0; i < 3000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// Runs a check in a process of its own, because what it changes is the process's: limits, signals, the user.
inline bool holdsInChild(const std::function<bool()>& check) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(check() ? 0 : 1);
  int status = -1;
  return ::waitpid(child, &status, 0) == child && status == 0;
}

/// Returns what Linux says of a process after one of its words, such as "State:"; empty if it is gone.
inline std::string statusOf(pid_t process, const std::string& word) {
  const std::string status = readFile("/proc/" + std::to_string(process) + "/status");
  const std::size_t at = status.find(word);
  return at == std::string::npos ? "" : status.substr(at + word.size());
}
/// Reports whether a signal is in a set of the process, such as "SigBlk:", those that it holds.
inline bool hasSignal(pid_t process, const std::string& set, int signal) {
  const std::string bits = statusOf(process, set);
  return !bits.empty() && (std::stoull(bits, nullptr, 16) >> (signal - 1) & 1) != 0;
}
/// Reports whether a process has a handler for a signal.
inline bool catches(pid_t process, int signal) {
  return hasSignal(process, "SigCgt:", signal);
}
inline pid_t parentOf(pid_t process) {
  const std::string parent = statusOf(process, "PPid:");
  return parent.empty() ? -1 : std::stoi(parent);
}
inline bool isStopped(pid_t process) {
  return statusOf(process, "State:").starts_with("\tT");
}

/// Returns the command line of a process; empty if it is gone.
inline std::string commandOf(pid_t process) {
  std::string line = readFile("/proc/" + std::to_string(process) + "/cmdline");
  std::replace(line.begin(), line.end(), '\0', ' ');
  return line;
}
/// Returns the processes whose command line holds all of these.
inline std::vector<pid_t> processesWith(const std::vector<std::string>& words) {
  std::vector<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string line = commandOf(std::stoi(name));
    if (std::all_of(words.begin(), words.end(),
                    [&](const std::string& word) { return line.find(word) != std::string::npos; }))
      found.push_back(std::stoi(name));
  }
  return found;
}

/// A program in the background, its standard error in a file.
class Background {
 public:
  /// With a group of its own, as a shell starts a job, it can be paused.
  Background(std::vector<std::string> arguments, std::filesystem::path err, bool ownGroup = false)
      : err_(std::move(err)), pid_(::fork()) {
    if (pid_ != 0) return;
    if (ownGroup) ::setpgid(0, 0);
    if (!std::freopen(err_.c_str(), "w", stderr)) ::_exit(126);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ~Background() {
    if (pid_ > 0) end(SIGKILL);
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  pid_t pid() const { return pid_; }
  std::string err() const { return readFile(err_); }
  bool says(const std::string& text) const {
    return until([&] { return err().find(text) != std::string::npos; });
  }
  /// Waits for the end, after a signal if there is one; the exit code, or 128 + signal.
  int end(int signal = 0) {
    if (signal != 0) ::kill(pid_, signal);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  std::filesystem::path err_;
  pid_t pid_;
};

}  // namespace trimtab::test
