#include "trimtab/hold/linear_cost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace trimtab {
namespace {

/// A machine that takes next to nothing for an image as such, while an arbiter moves its levers: what noise
/// would push below 0 must not make predictions too long.
TEST(LinearCost, staysRightWhereACoefficientIsNearZero) {
  struct Stay {
    double triangles, scale;  ///< ten thousands; of the picture's width and height
    int images;
  };
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    LinearCost<4> cost;
    for (const Stay& stay : {Stay{22, 1, 10},
                             {4.5, 0.5, 40},
                             {12.6, 0.65, 50},
                             {12.6, 0.7, 30},
                             {7.1, 0.8, 25},
                             {6, 0.9, 60},
                             {6.5, 0.95, 50},
                             {8, 0.95, 60}}) {
      double ratio = 0;
      for (int i = 0; i < stay.images; ++i) {
        const double mpx = 0.92 * stay.scale * stay.scale;
        const LinearCost<4>::Quantities x{1, stay.triangles, 0.8 * mpx, mpx};
        const double ms = 0.2 + 1.4 * stay.triangles + 8.7 * mpx;
        ratio += cost.predict(x) / ms / stay.images;
        cost.observe(x, ms * (1 + 0.1 * normal(random)));
      }
      if (stay.images >= 25) {
        EXPECT_NEAR(ratio, 1, 0.08) << seed << ", scale " << stay.scale;
      }
    }
  }
}

/// Rests at one load, then at a smaller one and at the first again, of a machine on which three coefficients
/// are 0: what is learned must lead each prediction towards what is measured.
TEST(LinearCost, learnsWhileSeveralCoefficientsAreAtZero) {
  LinearCost<4> cost;
  const auto stay = [&](double triangles, double ms) {
    double before = 0;
    for (int i = 0; i < 120; ++i) {
      const LinearCost<4>::Quantities x{1, triangles, 0.11, 0.23};
      const double off = std::abs(cost.predict(x) / ms - 1);
      if (i > 1) {
        EXPECT_LE(off, before + 1e-9) << "image " << i << " at " << triangles;
      }
      before = off;
      cost.observe(x, ms);
    }
    EXPECT_LT(before, 0.02) << triangles;
  };
  stay(19, 62);
  stay(4.5, 13.5);
  stay(12.6, 36);
  stay(19, 46);
}

/// One image in seven takes 1.4 times as long, because another program had a core: the mean is 6 % late.
TEST(LinearCost, predictsWhatMostImagesTakeWhereSomeAreLate) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> noise(1, 0.03);
  LinearCost<2> cost;
  double late = 0;
  constexpr int kFirst = 200, kImages = 2000;
  for (int i = 0; i < kImages; ++i) {
    const LinearCost<2>::Quantities x{1, 5 + 3 * uniform(random)};
    const double usual = 2 + 1.5 * x[1];
    if (i >= kFirst) late += cost.predict(x) / usual - 1;
    cost.observe(x, usual * noise(random) * (uniform(random) < 0.15 ? 1.4 : 1));
  }
  EXPECT_NEAR(late / (kImages - kFirst), 0, 0.03);
}

/// The first image of a program builds and uploads what the others find.
TEST(LinearCost, forgetsAFirstImageThatTookMuchLonger) {
  const LinearCost<2>::Quantities x{1, 10};
  LinearCost<2> with, without;
  with.observe(x, 240);
  for (int i = 0; i < 20; ++i) with.observe(x, 40), without.observe(x, 40);
  EXPECT_EQ(with.state().coefficient, without.state().coefficient);
  EXPECT_EQ(with.state().covariance, without.state().covariance);
}

}  // namespace
}  // namespace trimtab
