#include <cstddef>
#include <cstdio>

#include "app/link/inbox.h"
#include "app/link/recording.h"
#include "commands.h"
#include "feed_work.h"
#include "trimtab/host/flight.h"
#include "trimtab/units/number.h"

namespace trimtab::cli {
namespace {

/// At most so many bytes wait for a slow disk; datagrams beyond them are dropped.
constexpr std::size_t kMostWaitingBytes = std::size_t{256} << 20;

int refuse(const Findings& findings) {
  report(findings);
  return kRefused;
}

}  // namespace

int recordFeed(const FeedOptions& options) {
  auto begun = link::Recording::begin(options.out);
  if (!begun) return refuse(begun.findings());
  link::Recording recording = std::move(begun).value();
  auto receiver = openReceiver(options);
  if (!receiver) {
    recording.discard();
    return refuse(receiver.findings());
  }
  link::Inbox inbox(kMostWaitingBytes);
  const std::string port = std::to_string((*receiver)->port());
  (*receiver)->tap([&inbox, own = "127.0.0.1:" + port](const Datagram& d) {
    inbox.put({d.arrival, d.from, own, {d.bytes.begin(), d.bytes.end()}});
  });
  sayListening(options, **receiver);
  link::LinkWatch watch((*receiver)->port(), options.bind);
  Ending ending = options.ending;
  ending.begin = Clock::now();
  EverySecond everySecond;
  Result<Done> added = Done{};
  const auto write = [&] {
    if (added) added = recording.add(inbox.take());
    return added.ok();
  };
  while (write() && !ending.reached(recording.size())) {
    sayWhyNothing(**receiver, watch);
    nap();
    everySecond([&] {
      std::fprintf(stderr, "%llu datagrams, %s\n", static_cast<unsigned long long>(recording.size()),
                   health((*receiver)->statistics(), (*receiver)->senders()).c_str());
    });
  }
  sayWhyNothing(**receiver, watch);
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
  if (inbox.dropped() > 0)
    report({{Severity::warning, options.out, "", "a disk that keeps up",
             std::to_string(inbox.dropped()) + " datagrams that had to be dropped"}});
  report(written.findings());
  std::fprintf(stderr, "%llu datagrams recorded in %s\n", static_cast<unsigned long long>(recording.size()),
               options.out.c_str());
  return kDone;
}

}  // namespace trimtab::cli
