#pragma once

#include <limits>
#include <random>

#include "trimtab/hold/cost_model.h"

namespace trimtab::test {

/// What images of a machine cost, learned from a formula, so that no clock has a part in it.
/// `slowness` multiplies every time, without unit.
inline CostModel formulaMachine(double slowness) {
  CostModel model;
  std::mt19937 random(3);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 200; ++i) {
    const FrameLoad load{between(2e3, 8e4), between(0.05, 0.2), between(0.06, 0.23), between(0.1, 1), true};
    FrameCost cost;
    cost.weather = slowness * 12 * load.particles;
    cost.blur = slowness * 13 * load.sceneMpx;
    cost.total = slowness * (2 + 70 * load.groundMpx + 2e-4 * load.triangles) + cost.weather + cost.blur;
    cost.gpu = std::numeric_limits<double>::quiet_NaN();
    model.observe(load, cost);
  }
  return model;
}

}  // namespace trimtab::test
