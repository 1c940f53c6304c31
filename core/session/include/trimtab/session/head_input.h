#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "trimtab/frame/frame.h"
#include "trimtab/host/head_log.h"

namespace trimtab {

/// Chooses where the pilot's head comes from, and puts it into each state before the state is decided.
class HeadInput {
 public:
  enum class Source {
    host,     ///< the head that the state has
    log,      ///< a recording or a sweep, on the states' clock
    pointer,  ///< the pointer's place in the image, as document C's authors did it
    none      ///< straight ahead
  };
  /// The head's angles at the edges of the image: document C's largest view movement, 180 by 90 degrees.
  static constexpr double kPointerHeadingDeg = 90, kPointerPitchDeg = 45;
  /// Pointer events arrive with the images, and states between them. A state gets the pointer's place of this
  /// many seconds ago, so that there are events on either side of it. The eye follows the pointer at once.
  static constexpr double kPointerDelayS = 0.1;

  Source source() const { return source_; }
  void useHost() { source_ = Source::host; }
  void useNone() { source_ = Source::none; }
  /// Uses a log. It begins with the next state, or at the time that `begin` sets.
  void useLog(HeadLog log);
  void usePointer();
  const HeadLog& log() const { return log_; }
  /// Sets the time, on the states' clock, at which the log begins.
  void begin(double stateTime) { begin_ = stateTime; }
  /// Call this for another flight or host: the log begins again with its first state.
  void restart() { begin_.reset(); }

  /// Records the pointer's place in the image, -1 (left, bottom) to 1. Values beyond count as the edge, and
  /// NaN as the middle. `now` is as for apply().
  void point(double right, double up, double now);

  /// Puts the head into a state. `now` is when the state arrived, on the clock of point(); NaN if that is
  /// unknown.
  void apply(AircraftState& state, double now) const;
  /// Puts the head into the eye's state. The eye follows the pointer at once, and a log as states do.
  void applyToEye(AircraftState& eye) const;
  /// Reports whether states from `now` on would differ although nothing but the head moves.
  bool moves(double now) const;
  /// Returns the seconds into the log at a time on the states' clock.
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
  mutable std::optional<double> begin_;  ///< set by the first state that uses the log
  std::array<Place, kPlaces> places_{};
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace trimtab
