#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/link/link.h"
#include "options.h"
#include "trimtab/session/session.h"
#include "wake.h"

namespace trimtab::ig {

/// The source of states: a flight or a host.
class Feed {
 public:
  virtual ~Feed() = default;
  /// Passes states that arrived or are due to the session. Reports whether there were any.
  virtual bool advance(Session& session, double now) = 0;
  /// Returns the seconds until a state is due; infinite if only a wake-up announces it.
  virtual double dueIn(double now) const = 0;
  virtual bool finished() const = 0;
  /// Called once everything is ready for states; announces it to anyone who may wait.
  virtual void ready() const {}
  /// Returns the statistics of the link; nothing for a flight.
  virtual std::optional<HostStatistics> statistics() const { return std::nullopt; }
  virtual std::optional<link::Senders> senders() const { return std::nullopt; }
  virtual std::uint64_t dropped() const { return 0; }
  virtual link::Questions questions() const { return {}; }
  /// Sets the terrain that answers what a host asks.
  virtual void setGround(std::shared_ptr<const GroundHeights>) {}
  /// Returns the line that is due about a host whose datagrams lead to no image (link::LinkWatch).
  virtual std::optional<std::string> complaint(double) { return std::nullopt; }
};

/// Opens the head that the options name, or the host's if they name none. Fails for a trace if the options
/// name a head, because a trace contains the head that it was decided with.
Result<HeadInput> openHeadInput(const Options& options);
/// Opens the flight or the port that the options name. Findings may come with the value.
/// `host` is what the preset says of the host; the options come before it.
Result<std::unique_ptr<Feed>> openFeed(const Options& options, const HostParameters& host, const Wake& wake);

}  // namespace trimtab::ig
