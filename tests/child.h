#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
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

/// Reports whether a process has a handler for a signal, as Linux says of it.
inline bool catches(pid_t process, int signal) {
  const std::string status = readFile("/proc/" + std::to_string(process) + "/status");
  const std::size_t at = status.find("SigCgt:");
  return at != std::string::npos &&
         (std::stoull(status.substr(at + 7), nullptr, 16) >> (signal - 1) & 1) != 0;
}

/// A program in the background, its standard error in a file.
class Background {
 public:
  Background(std::vector<std::string> arguments, std::filesystem::path err)
      : err_(std::move(err)), pid_(::fork()) {
    if (pid_ != 0) return;
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
