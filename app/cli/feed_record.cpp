#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <vector>

#include "commands.h"
#include "feed_work.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/number.h"

namespace trimtab::cli {
namespace {

namespace fs = std::filesystem;

/// A recording while it is made: a capture beside the target, which has every datagram a few milliseconds
/// after it came. Whatever ends the program, `feed play` and the IG read it as it is.
class Recording {
 public:
  /// Refuses, before anything is received, a target that could not be written in the end.
  static Result<Recording> begin(const fs::path& target) {
    const fs::path unfinished = fs::path(target) += ".part";
    std::error_code failed;
    if (const fs::path folder = fs::absolute(target).parent_path(); !fs::is_directory(folder, failed))
      return wrong(target, "a folder that exists", folder.string());
    const fs::file_status there = fs::status(target, failed);
    if (fs::exists(there) && !fs::is_regular_file(there))
      return wrong(target, "a file's name", "a folder or a device");
    if (fs::exists(there) && ::access(target.c_str(), W_OK) != 0)
      return wrong(target, "room and permission to write it", std::generic_category().message(errno));
    // With a header and nothing behind it, it is worth nothing.
    constexpr std::uintmax_t kHeader = 24;
    if (fs::exists(unfinished, failed) && fs::file_size(unfinished, failed) > kHeader)
      return wrong(unfinished, "no recording that was cut off",
                   "one that plays as it is: give it another name, or remove it");
    auto capture = PcapWriter::open(unfinished);
    if (!capture) return capture.findings();
    return Recording(target, unfinished, std::move(capture).value());
  }

  Result<Done> add(const std::vector<CapturedDatagram>& datagrams) { return capture_->add(datagrams); }
  std::uint64_t size() const { return capture_->size(); }

  /// Gives the recording its name; a flight is made from the capture. If that fails, the capture is kept.
  Result<Done> finish() {
    if (auto closed = capture_->close(); !closed) return kept(closed.findings());
    if (target_.extension() == ".pcap") {
      auto done = putInPlace(unfinished_, target_);
      return done ? done : kept(done.findings());
    }
    const auto datagrams = readPcap(unfinished_);
    if (!datagrams) return kept(datagrams.findings());
    const auto flight = flightFromDatagrams(*datagrams, "recording");
    if (!flight) return kept(flight.findings());
    if (const auto written = writeAtomically(target_, flightCsv(*flight)); !written)
      return kept(written.findings());
    discard();
    return {Done{}, flight.findings()};
  }
  void discard() {
    std::error_code ignored;
    fs::remove(unfinished_, ignored);
  }
  Findings kept(Findings why) const {
    why.push_back({Severity::note, unfinished_.string(), "", "",
                   std::to_string(size()) + " datagrams are kept there: it plays as it is"});
    return why;
  }

 private:
  Recording(fs::path target, fs::path unfinished, PcapWriter capture)
      : target_(std::move(target)), unfinished_(std::move(unfinished)) {
    capture_.emplace(std::move(capture));
  }
  static Finding wrong(const fs::path& where, std::string expected, std::string found) {
    return {Severity::error, where.string(), "", std::move(expected), std::move(found)};
  }

  fs::path target_, unfinished_;
  std::optional<PcapWriter> capture_;
};

/// Takes datagrams on the receiver's thread and hands them over, so that a slow disk does not hold it up.
class Inbox {
 public:
  void put(CapturedDatagram datagram) {
    const std::lock_guard lock(mutex_);
    datagrams_.push_back(std::move(datagram));
  }
  std::vector<CapturedDatagram> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(datagrams_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<CapturedDatagram> datagrams_;
};

int refuse(const Findings& findings) {
  report(findings);
  return kRefused;
}

}  // namespace

int recordFeed(const FeedOptions& options) {
  auto begun = Recording::begin(options.out);
  if (!begun) return refuse(begun.findings());
  Recording recording = std::move(begun).value();
  auto receiver = openReceiver(options);
  if (!receiver) {
    recording.discard();
    return refuse(receiver.findings());
  }
  Inbox inbox;
  const std::string port = std::to_string((*receiver)->port());
  (*receiver)->tap([&inbox, own = "127.0.0.1:" + port](const Datagram& d) {
    inbox.put({d.arrival, d.from, own, {d.bytes.begin(), d.bytes.end()}});
  });
  sayListening(options, **receiver);
  Ending ending = options.ending;
  ending.begin = Clock::now();
  EverySecond everySecond;
  Result<Done> added = Done{};
  const auto write = [&] {
    if (added) added = recording.add(inbox.take());
    return added.ok();
  };
  while (write() && !ending.reached(recording.size())) {
    nap();
    everySecond([&] {
      std::fprintf(stderr, "%llu datagrams, %s\n", static_cast<unsigned long long>(recording.size()),
                   health((*receiver)->statistics(), (*receiver)->senders()).c_str());
    });
  }
  const HostStatistics statistics = (*receiver)->statistics();
  (*receiver).reset();
  write();
  printFirstBad(statistics);
  if (!added) return refuse(recording.kept(added.findings()));
  if (recording.size() == 0) {
    recording.discard();
    return refuse({{Severity::error, options.out, "", "datagrams of a host on port " + port,
                    "none in " + numberText(ending.elapsed(), 3) + " s; nothing written"}});
  }
  const auto written = recording.finish();
  if (!written) return refuse(written.findings());
  report(written.findings());
  std::fprintf(stderr, "%llu datagrams recorded in %s\n", static_cast<unsigned long long>(recording.size()),
               options.out.c_str());
  return kDone;
}

}  // namespace trimtab::cli
