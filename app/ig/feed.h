#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "options.h"
#include "trimtab/session/session.h"
#include "wake.h"

namespace trimtab::ig {

/// Where states come from.
class Feed {
 public:
  virtual ~Feed() = default;
  /// Gives the session what has come or is due; whether there was anything.
  virtual bool advance(Session& session, double now) = 0;
  /// Seconds until something is due; infinite when only a wake-up tells.
  virtual double dueIn(double now) const = 0;
  virtual bool finished() const = 0;
  /// Everything stands ready for what comes: says so where someone may wait for it.
  virtual void ready() const {}
  /// Health of the link; none for a flight.
  virtual std::optional<HostStatistics> statistics() const { return std::nullopt; }
  virtual std::uint64_t dropped() const { return 0; }
};

/// The head that the options name; a host's where they name none. A trace brings the head that it was decided
/// with: naming another is refused.
Result<HeadInput> openHeadInput(const Options& options);
/// Opens the flight or the port that the options name. Findings may come with the value.
Result<std::unique_ptr<Feed>> openFeed(const Options& options, const Wake& wake);

}  // namespace trimtab::ig
