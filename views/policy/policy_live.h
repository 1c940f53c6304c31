// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>

#include "trimtab/policy/compiled_policy.h"
#include "views/model/draft.h"
#include "views/model/live.h"

namespace trimtab::views {

/// What the active policy makes of the last frame, for all parts of the dock.
struct PolicyLive {
  bool seen = false;      ///< whether a frame was shown, so that `flight` is of it
  bool decided = false;   ///< whether a policy is switched on and a frame was decided
  bool matches = false;   ///< whether it is the policy of the draft: rule i is line i
  SignalValues flight;    ///< NaN: unknown
  PolicyOutcome outcome;  ///< the levers after their rates
  PolicyDecision decision;
  Policy policy;                             ///< as an engineer writes it
  const CompiledPolicy* compiled = nullptr;  ///< while the draft's active parameters stay
  const IgProfile* ig = nullptr;             ///< as Draft::imageGenerator()

  /// Returns the share of a rule in a lever, 0..1.
  double share(std::size_t rule, Lever lever) const {
    return decided && compiled != nullptr ? compiled->share(rule, lever, decision) : 0;
  }
};

/// The signals of a flight so far: a sample each tenth of a second, at most some minutes of them.
class PolicyTrack {
 public:
  struct Sample {
    double time = 0;
    SignalValues flight;
  };

  /// Adds a frame's signals unless the last sample is younger than a tenth of a second. A clock that goes
  /// back, or a gap of some seconds, begins anew.
  void push(double time, const SignalValues& flight);
  void clear() {
    samples_.clear();
    ++revision_;
  }
  const std::deque<Sample>& samples() const { return samples_; }
  /// Counts changes, so that a plot knows whether it has to draw.
  std::uint64_t revision() const { return revision_; }

 private:
  std::deque<Sample> samples_;
  std::uint64_t revision_ = 0;
};

/// Returns a value of a signal with its unit, as round as people read it: "1,240 ft".
QString signalText(Signal signal, double value);
/// Returns a value of a lever with its unit.
QString leverText(Lever lever, double value);
/// Returns a unit in parentheses after a blank; nothing if there is none.
QString inParentheses(std::string_view unit);

}  // namespace trimtab::views
