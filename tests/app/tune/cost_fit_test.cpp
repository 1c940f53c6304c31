#include "app/tune/cost_fit.h"

#include <gtest/gtest.h>

#include <random>

namespace trimtab::tune {
namespace {

/// Images of a machine with these costs, with noise of so much.
std::vector<TimedImage> images(double noise, double perInstance) {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<TimedImage> images;
  for (int i = 0; i < 96; ++i) {
    TimedImage image;
    const double area = i % 3 == 0 ? 0.25 : 1;
    image.load = {between(5e4, 8e5), between(0.1, 0.9) * area, 0.92 * area, i % 4 == 0 ? 0.5 : 0, i % 7 == 0};
    image.instances = between(0, 3e4);
    image.looksForHidden = i % 5 != 0;
    image.ms = 1.5 + 2e-5 * image.load.triangles + 6 * image.load.groundMpx + perInstance * image.instances +
               (image.looksForHidden ? 0.4 : 0) + 3 * image.load.particles +
               (image.load.particles > 0 ? 5 * image.load.sceneMpx : 0) +
               (image.load.blurs ? 2.5 * image.load.sceneMpx : 0);
    image.ms *= 1 + noise * between(-1, 1);
    images.push_back(image);
  }
  return images;
}

TEST(CostFit, findsWhatImagesCost) {
  const FittedCost cost = fitCost(images(0, 3e-4));
  EXPECT_NEAR(cost.coefficients.fixed, 1.5, 1e-4);
  EXPECT_NEAR(cost.coefficients.perTriangle, 2e-5, 1e-9);
  EXPECT_NEAR(cost.coefficients.perGroundMpx, 6, 1e-3);
  EXPECT_NEAR(cost.perInstance, 3e-4, 1e-8);
  EXPECT_NEAR(cost.lookingMs, 0.4, 1e-4);
  EXPECT_NEAR(cost.coefficients.perParticles, 3, 1e-3);
  EXPECT_NEAR(cost.coefficients.perWeatherMpx, 5, 1e-3);
  EXPECT_NEAR(cost.coefficients.perBlurMpx, 2.5, 1e-3);
}

TEST(CostFit, missesByLessThanTheNoise) {
  const std::vector<TimedImage> noisy = images(0.1, 3e-4);
  const FittedCost cost = fitCost(noisy);
  for (const TimedImage& image : images(0, 3e-4))
    EXPECT_NEAR(cost(image.load, image.instances, image.looksForHidden) / image.ms, 1, 0.06);
}

TEST(CostFit, nothingCostsLessThanNothing) {
  // Images that grow quicker with more objects: they cost nothing then.
  const FittedCost cost = fitCost(images(0, -2e-5));
  EXPECT_EQ(cost.perInstance, 0);
  EXPECT_GT(cost.coefficients.perTriangle, 0);
}

TEST(CostFit, withoutImagesNothingCosts) {
  const FittedCost cost = fitCost({});
  EXPECT_EQ(cost({1e5, 1, 1, 0, false}, 10, true), 0);
}

}  // namespace
}  // namespace trimtab::tune
