#pragma once

#include "trimtab/frame/frame.h"

/// Measures how far apart two states are, reports whether an aircraft can have flown from one to the other,
/// and interpolates between them. NaN gives NaN where nothing else is said.
namespace trimtab {

/// The longest gap between two states, seconds, over which a motion is derived from them. A longer gap may be
/// a silence of the host, in which nobody knows how the aircraft moved.
inline constexpr double kSilenceS = 2;

/// Returns the longest gap after a state, seconds, that is no silence: kSilenceS, or for a host that promises
/// a dead reckoning the time after which DIS gives it up.
double longestGapS(const AircraftState& state);
/// Returns a state moved on by its host's dead reckoning, with all else as it was; only its time is moved on
/// if it has none.
AircraftState deadReckoned(const AircraftState& state, double seconds);

/// Returns the distance of two places along the chord through the earth, metres. Their heights count.
double distanceM(const GeodeticPosition& a, const GeodeticPosition& b);
/// Reports whether the move from a to b is a jump: farther than any aircraft flies in `seconds`. `silence`
/// says that no state came for long in between; then a move beyond a fixed distance is a jump too, however
/// long the silence was. A short move is never a jump, because hosts stutter, and a longer one always is if
/// `seconds` is 0 or less. motion.cpp has the limits. A place that is not a number gives false.
bool isJump(const GeodeticPosition& a, const GeodeticPosition& b, double seconds, bool silence);
/// Returns the angle at `fraction` of the short way from a to b. A fraction below 0 or above 1 extrapolates,
/// here and below. The result is not wrapped: between 350 and 20 degrees lies 365.
Degrees blended(Degrees a, Degrees b, double fraction);
/// Interpolates each angle by itself. The heading is wrapped to 0..360 and the roll to -180..180. The pitch
/// is clamped to -90..90, because an extrapolation may pass the vertical.
Attitude blended(const Attitude& a, const Attitude& b, double fraction);
/// Does the same for a head, whose heading is wrapped to -180..180.
Attitude blendedHead(const Attitude& a, const Attitude& b, double fraction);
/// Returns the place at `fraction` of the chord from a to b, with a height that changes evenly, because the
/// chord itself dips below the curved earth. Returns exactly `a` at 0, and `b` at 1 but for rounding. Do not
/// use it across a jump: the chord between opposite sides of the earth passes near its centre, where latitude
/// and longitude mean nothing.
GeodeticPosition blended(const GeodeticPosition& a, const GeodeticPosition& b, double fraction);

}  // namespace trimtab
