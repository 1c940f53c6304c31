#pragma once

#include <algorithm>
#include <cmath>
#include <random>

namespace trimtab::test {

/// By how much a busy machine stretches what is drawn, one drawing after the other: a jitter, slow spells of
/// a dozen drawings, now and then a stall, and a clock that drifts. The same seed gives the same machine.
class NoisyMachine {
 public:
  explicit NoisyMachine(unsigned seed) : random_(seed) {}

  /// Returns the factor of the next drawing.
  double next() {
    if (spell_ == 0 && chance() < 1.0 / 60) {
      spell_ = 1 + static_cast<int>(24 * chance());
      slow_ = 1.2 + 1.3 * chance();
    }
    drift_ = 0.999 * drift_ + 0.003 * normal_(random_);
    double factor = std::exp(drift_ + 0.04 * normal_(random_));
    if (spell_ > 0) factor *= slow_, --spell_;
    // Heavy-tailed: one in a hundred takes half as long again, one in ten thousand 30 times as long.
    if (chance() < 0.01) factor *= 1 + 0.5 / std::pow(std::max(chance(), 1e-4), 0.9);
    return factor;
  }

 private:
  double chance() { return uniform_(random_); }

  std::mt19937_64 random_;
  std::uniform_real_distribution<double> uniform_{0, 1};
  std::normal_distribution<double> normal_{0, 1};
  int spell_ = 0;
  double slow_ = 1, drift_ = 0;
};

}  // namespace trimtab::test
