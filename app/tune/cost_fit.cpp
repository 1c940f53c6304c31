#include "cost_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace trimtab::tune {
namespace {

constexpr std::size_t kTerms = 8;
using Terms = std::array<double, kTerms>;

Terms termsOf(const FrameLoad& load, double instances, bool looksForHidden) {
  return {1,
          load.triangles,
          load.groundMpx,
          looksForHidden ? 1.0 : 0.0,
          load.particles,
          load.particles > 0 ? load.sceneMpx : 0,
          instances,
          load.blurs ? load.sceneMpx : 0};
}

}  // namespace

double FittedCost::operator()(const FrameLoad& load, double instances, bool looksForHidden) const {
  CostCoefficients cost;
  static_cast<ClockCoefficients&>(cost) = coefficients;
  return predict(cost, load).total() + perInstance * instances + (looksForHidden ? lookingMs : 0);
}

FittedCost fitCost(std::span<const TimedImage> images) {
  // Each row of the system is divided by its time, so that what counts is the part by which a time is missed.
  std::array<Terms, kTerms> square{};
  Terms right{}, size{};
  for (const TimedImage& image : images) {
    if (!(image.ms > 0)) continue;
    Terms terms = termsOf(image.load, image.instances, image.looksForHidden);
    for (double& term : terms) term /= image.ms;
    for (std::size_t i = 0; i < kTerms; ++i) {
      right[i] += terms[i];
      for (std::size_t j = 0; j < kTerms; ++j) square[i][j] += terms[i] * terms[j];
    }
  }
  for (std::size_t i = 0; i < kTerms; ++i) size[i] = std::sqrt(square[i][i]);
  // The problem is convex, so that moving one cost after the other, none below 0, comes to its only answer.
  constexpr int kTurns = 20000;
  Terms cost{};
  for (int turn = 0; turn < kTurns; ++turn) {
    double moved = 0;
    for (std::size_t i = 0; i < kTerms; ++i) {
      if (!(size[i] > 0)) continue;
      double rest = right[i];
      for (std::size_t j = 0; j < kTerms; ++j)
        if (j != i) rest -= square[i][j] * cost[j];
      const double next = std::max(rest / square[i][i], 0.0);
      moved = std::max(moved, std::abs(next - cost[i]) * size[i]);
      cost[i] = next;
    }
    if (moved < 1e-12) break;
  }
  FittedCost fitted;
  fitted.coefficients.fixed = cost[0];
  fitted.coefficients.perTriangle = cost[1];
  fitted.coefficients.perGroundMpx = cost[2];
  fitted.lookingMs = cost[3];
  fitted.coefficients.perParticles = cost[4];
  fitted.coefficients.perWeatherMpx = cost[5];
  fitted.perInstance = cost[6];
  fitted.coefficients.perBlurMpx = cost[7];
  return fitted;
}

}  // namespace trimtab::tune
