#pragma once

#include "trimtab/frame/frame.h"

/// How far apart two states are, and whether anything can have flown from one to the other.
namespace trimtab {

/// Without a state for so long, seconds, the motion is unknown.
inline constexpr double kSilenceS = 2;

/// Returns the distance of two places along the chord through the earth, metres.
double distanceM(const GeodeticPosition& a, const GeodeticPosition& b);
/// Reports whether no aircraft flies from one to the other in `seconds`: faster than any, or more than a
/// kilometre in a silence.
bool isJump(const GeodeticPosition& a, const GeodeticPosition& b, double seconds, bool silence);
/// Returns the angle at `fraction` of the short way from a to b; the fraction may lie beyond 0 to 1.
Degrees blended(Degrees a, Degrees b, double fraction);
/// Interpolates angle by angle; heading in 0..360, pitch clamped to -90..90.
Attitude blended(const Attitude& a, const Attitude& b, double fraction);
/// Does the same for a head, whose heading is in -180..180.
Attitude blendedHead(const Attitude& a, const Attitude& b, double fraction);
/// Interpolates along the chord, with the height changing evenly. Returns exactly a at 0.
GeodeticPosition blended(const GeodeticPosition& a, const GeodeticPosition& b, double fraction);

}  // namespace trimtab
