#pragma once

#include <random>

#include "trimtab/hold/cost_model.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::test {

/// A machine whose images cost what a line says, with noise.
class NoisyMachine {
 public:
  double slowness = 1, noise = 0.05;

  FrameLoad nextLoad() {
    FrameLoad load;
    load.triangles = between(2e4, 1.5e5);
    load.groundMpx = between(0.1, 0.9);
    load.sceneMpx = 0.92;
    load.particles = between(0, 1) < 0.3 ? between(0.2, 1) : 0;
    load.blurs = between(0, 1) < 0.2;
    return load;
  }
  FrameCost cost(const FrameLoad& load) {
    const auto noisy = [&](double ms) { return ms * slowness * (1 + noise * normal_(random_)); };
    FrameCost c;
    c.decide = 0.01;
    c.symbology = noisy(0.4);
    c.blur = load.blurs ? noisy(3 * load.sceneMpx) : kNan;
    c.weather = load.particles > 0 ? noisy(10 * load.particles + 2 * load.sceneMpx) : kNan;
    c.draw =
        noisy(ground(load)) + c.symbology + (load.blurs ? c.blur : 0) + (load.particles > 0 ? c.weather : 0);
    c.total = c.draw + c.decide;
    c.gpu = kNan;
    return c;
  }
  static double ground(const FrameLoad& load) { return 1.5 + 8e-5 * load.triangles + 14 * load.groundMpx; }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  std::mt19937 random_{3};
  std::normal_distribution<double> normal_;
};

}  // namespace trimtab::test
