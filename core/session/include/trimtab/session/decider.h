#pragma once

#include <memory>
#include <optional>

#include "trimtab/decision/decide.h"
#include "trimtab/frame/ground_heights.h"
#include "trimtab/host/ground_velocity.h"
#include "trimtab/preset/table.h"
#include "trimtab/session/ground_doubt.h"
#include "trimtab/session/signal_tracker.h"

namespace trimtab {

/// Decides states in order, with the memory, the signals and the velocity that follow from those before. A
/// free camera's states have a memory of their own.
class Decider {
 public:
  explicit Decider(const ValidatedParameters& parameters) : parameters_(parameters) {}

  const ValidatedParameters& parameters() const { return parameters_; }
  /// Sets the parameters for the next state. The policy's levers take their new targets at once.
  void setParameters(const ValidatedParameters& parameters);
  /// Sets what is asked for the height of the ground. May be null.
  void setGround(std::shared_ptr<const GroundHeights> ground);
  /// Returns it; null if there is none.
  const GroundHeights* ground() const { return ground_.get(); }
  /// Derives the signals also while the preset has no policy.
  void watchSignals() { watched_.emplace(); }

  /// Returns the state with what the decision wants to know of the ground.
  FrameInput inputFor(const AircraftState& state) const;

  /// Decides the next state of a host or flight. Returns the memory that it was decided with.
  DecisionMemory next(FrameInput input);
  /// Decides the newest state once more, for an image of it. Returns the memory that it was decided with.
  DecisionMemory forImage(FrameInput input);
  /// Takes note of a state that images will be decided from.
  void arrive(const AircraftState& state);
  /// Decides a state of a free camera. `anew`: it was set down here, so that it has not moved.
  void look(FrameInput input, bool anew);
  /// Decides the last input anew, after an edit, and leaves the memory as it was. Head motion goes from the
  /// state before it: no time passes in an edit, and a head would seem to rest.
  void again();
  /// Continues from the memory of a trace.
  void resume(const DecisionMemory& memory) { memory_ = memory; }
  /// Sets the input that stands until the first decision.
  void setInput(const FrameInput& input) { input_ = input; }
  /// Forgets all states, for a new host or flight.
  void restart();

  /// Reports whether the last state was a free camera's.
  bool looking() const { return looking_; }
  const FrameInput& input() const { return input_; }
  const FrameDecision& decision() const { return decision_; }
  /// Returns the memory that the next state will be decided with.
  const DecisionMemory& memory() const { return memory_; }
  /// Returns the signals of the last decided state; unknown without a policy, unless they are watched.
  SignalValues signalValues() const { return watched_.value_or(input_.signalValues); }
  /// Returns where the host's height above ground contradicts the terrain's; nullopt if it never did.
  const std::optional<GroundDoubt>& groundDoubt() const { return doubt_; }
  SignalTracker& signalTracker() { return tracker_; }
  /// Returns the velocity of a state: the host's, or what follows from the states before.
  std::optional<Velocity> velocityOf(const AircraftState& state) const;
  /// Returns the height of the highest ground, if the decision wants it.
  std::optional<Metres> highestGround() const;
  /// Returns the height above the terrain, if the decision wants it; what the host sent, where the terrain
  /// knows nothing or nobody asks.
  std::optional<Metres> groundBelow(const AircraftState& state) const;

 private:
  DecisionMemory decideWith(DecisionMemory& memory);
  void decideInput(DecisionMemory& memory);
  void trackSignals(const WeatherDecision& weather);
  void compareGround(std::optional<Metres> overTerrain);
  std::optional<Metres> heightOverTerrain(const AircraftState& state) const;

  ValidatedParameters parameters_;
  std::shared_ptr<const GroundHeights> ground_;
  DecisionMemory memory_, lookMemory_;
  MotionMemory motionBefore_;  ///< before the last decision
  bool looking_ = false;
  FrameInput input_;  ///< of the last decision
  FrameDecision decision_;
  GroundVelocity groundVelocity_;
  SignalTracker tracker_;                ///< pushed only if the preset has a policy or somebody watches
  std::optional<SignalValues> watched_;  ///< if unset, nobody watches
  std::optional<GroundDoubt> doubt_;
};

}  // namespace trimtab
