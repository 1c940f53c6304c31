#include "trimtab/host/motion.h"

#include "limits.h"

namespace trimtab {
namespace {

// Twice the fastest aircraft that a visual system was built for; below the floor it is a host that stuttered.
constexpr double kFastestMps = 1500, kFloorM = 250, kSilentM = 1000;

}  // namespace

double distanceM(const GeodeticPosition& a, const GeodeticPosition& b) {
  return length(toEcef(a) - toEcef(b));
}

bool isJump(const GeodeticPosition& a, const GeodeticPosition& b, double seconds, bool silence) {
  const double moved = distanceM(a, b);
  if (silence && moved > kSilentM) return true;
  return moved > kFloorM && moved > kFastestMps * seconds;
}

Degrees blended(Degrees a, Degrees b, double fraction) {
  return a + wrapped180(b - a) * fraction;
}

Attitude blended(const Attitude& a, const Attitude& b, double fraction) {
  return {wrapped360(blended(a.heading, b.heading, fraction)),
          Degrees{limits::clampedPitch(blended(a.pitch, b.pitch, fraction).value())},
          wrapped180(blended(a.roll, b.roll, fraction))};
}

Attitude blendedHead(const Attitude& a, const Attitude& b, double fraction) {
  Attitude head = blended(a, b, fraction);
  head.heading = wrapped180(head.heading);
  return head;
}

GeodeticPosition blended(const GeodeticPosition& a, const GeodeticPosition& b, double fraction) {
  if (a == b || fraction == 0) return a;
  const Vec3 from = toEcef(a);
  GeodeticPosition p = toGeodetic(from + (toEcef(b) - from) * fraction);
  p.height = a.height + (b.height - a.height) * fraction;
  return p;
}

}  // namespace trimtab
