#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "trimtab/frame/frame.h"
#include "trimtab/host/head_log.h"

namespace trimtab {

/// Where the pilot's head comes from: it replaces what a state brings before the state is decided.
class HeadInput {
 public:
  enum class Source {
    host,     ///< as the state says
    log,      ///< a recording or a sweep, on the states' clock
    pointer,  ///< the pointer's place in the picture, as document C's authors did it
    none      ///< straight ahead
  };
  /// Of the picture's edges from its middle: document C's largest view movement, 180 by 90 degrees.
  static constexpr double kPointerHeadingDeg = 90, kPointerPitchDeg = 45;
  /// Pointer events come with the pictures, states between them: what a state is given lies so far back that
  /// there are events on either side of it. The eye follows at once.
  static constexpr double kPointerDelayS = 0.1;

  Source source() const { return source_; }
  void useHost() { source_ = Source::host; }
  void useNone() { source_ = Source::none; }
  /// It begins with the next state, or where `begin` says.
  void useLog(HeadLog log);
  void usePointer();
  const HeadLog& log() const { return log_; }
  /// The states' time at which the log begins.
  void begin(double stateTime) { begin_ = stateTime; }
  /// Another flight or host: the log begins again with its first state.
  void restart() { begin_.reset(); }

  /// The pointer is at this place, -1 (left, below) to 1; beyond counts as the edge, no number as the middle.
  /// `now` as for apply().
  void point(double right, double up, double now);

  /// `now`: when the state came, on the clock of point(); NaN where nobody knows.
  void apply(AircraftState& state, double now) const;
  /// The same for the eye, which follows the pointer at once and a log as its states do.
  void applyToEye(AircraftState& eye) const;
  /// Whether states given from `now` on would differ although nothing else moves.
  bool moves(double now) const;
  /// Seconds into the log at this time of the states.
  double logTime(double stateTime) const { return begin_ ? stateTime - *begin_ : 0; }

 private:
  struct Place {
    double time = 0, right = 0, up = 0;
  };
  static Attitude attitudeOf(const Place& place);
  void remember(const Place& place);
  Place placeAt(double time) const;
  const Place& nth(std::size_t newest) const { return places_[(next_ + kPlaces - 1 - newest) % kPlaces]; }

  static constexpr std::size_t kPlaces = 256;
  Source source_ = Source::host;
  HeadLog log_;
  mutable std::optional<double> begin_;  ///< set by the first state that the log is asked for
  std::array<Place, kPlaces> places_{};
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace trimtab
