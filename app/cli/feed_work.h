#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "app/link/link.h"
#include "app/link/link_watch.h"
#include "trimtab/preset/stop_request.h"

/// Declares what the commands play, record and show of `feed` share.
namespace trimtab::cli {

using Clock = std::chrono::steady_clock;

/// Says when a command ends by itself; without limits only an interrupt ends it.
struct Ending {
  double seconds = 0;         ///< 0: never
  std::uint64_t packets = 0;  ///< 0: never
  Clock::time_point begin = Clock::now();

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - begin).count(); }
  bool reached(std::uint64_t count) const {
    return stopRequested() || (packets > 0 && count >= packets) || (seconds > 0 && elapsed() >= seconds);
  }
};

/// Sleeps for a few milliseconds.
void nap();

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

struct FeedOptions {
  std::string flight, columns, head, headColumns, to, out, protocol = "cigi3", listenProtocol = "auto", reply,
                                                           group, bind = link::kOwnMachine,
                                                           from = link::kAnyone, entity;
  double rateHz = 60, speed = 1, startS = 0;
  bool loop = false;
  bool skipBadRows = false;  ///< of the head log
  bool symbols = false;
  int listen = 0;
  std::optional<int> view;  ///< the first that the host controls, if unset
  Ending ending;
};

/// Opens the port that the options name.
Result<std::unique_ptr<link::Receiver>> openReceiver(const FeedOptions& options);
/// Says on standard error where a receiver listens, and to whom.
void sayListening(const FeedOptions& options, const link::Receiver& receiver);
/// Says on standard error why datagrams lead to nothing, if that is due.
void sayWhyNothing(const link::Receiver& receiver, link::LinkWatch& watch);
/// Returns the counters that are worth a word, on one line.
std::string health(const HostStatistics& statistics, const link::Senders& senders);
void printFirstBad(const HostStatistics& statistics);

/// Runs the command `feed record`. Returns the exit code.
int recordFeed(const FeedOptions& options);

}  // namespace trimtab::cli
