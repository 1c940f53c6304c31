#pragma once

#include "trimtab/frame/frame.h"

/// How far apart two states are, and whether anything can have flown from one to the other.
namespace trimtab {

/// Without a state for so long, nothing is known of the motion any more.
inline constexpr double kSilenceS = 2;

/// Straight through the earth, metres.
double distanceM(const GeodeticPosition& a, const GeodeticPosition& b);
/// `seconds` lie between the two. Faster than any aircraft, or more than a kilometre covered in a silence.
bool isJump(const GeodeticPosition& a, const GeodeticPosition& b, double seconds, bool silence);
/// From a to b by `fraction` (beyond 0..1 too), the short way round.
Degrees blended(Degrees a, Degrees b, double fraction);
/// Angle by angle; heading in 0..360, pitch held within a quarter turn.
Attitude blended(const Attitude& a, const Attitude& b, double fraction);
/// The same for a head: its heading, too, in -180..180.
Attitude blendedHead(const Attitude& a, const Attitude& b, double fraction);
/// Along the chord, with the height changing evenly; exactly a at 0.
GeodeticPosition blended(const GeodeticPosition& a, const GeodeticPosition& b, double fraction);

}  // namespace trimtab
