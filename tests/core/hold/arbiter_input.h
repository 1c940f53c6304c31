#pragma once

#include <cmath>

#include "trimtab/hold/arbiter.h"

namespace trimtab::test {

inline HoldParameters enabled() {
  HoldParameters p;
  p.enabled = true;
  return p;
}

/// 40 ms as asked for: 10 for triangles, 20 for ground pixels, 4 for rain, 3 for blur, 3 else.
inline HoldGiven given(double timeS = 0) {
  HoldGiven g;
  g.timeS = timeS;
  g.budgetMs = 100;
  g.asked = {1, 1, 1, 1};
  g.particles = 1;
  g.blurs = true;
  g.imageMpx = 1;
  g.groundMpx = 0.5;
  for (std::size_t k = 0; k < kErrorSteps; ++k)
    g.triangles[k] = 1e5 * std::exp2(-static_cast<double>(k) / kPlacesPerOctave);
  static_cast<ClockCoefficients&>(g.cost) = {.fixed = 2,
                                             .perTriangle = 1e-4,
                                             .perGroundMpx = 40,
                                             .perParticles = 3,
                                             .perWeatherMpx = 1,
                                             .perBlurMpx = 3,
                                             .other = 1};
  g.cost.halfBandMs = 2;
  g.cost.known = true;
  return g;
}

}  // namespace trimtab::test
