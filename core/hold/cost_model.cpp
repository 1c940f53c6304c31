#include "trimtab/hold/cost_model.h"

#include <algorithm>
#include <cmath>

namespace trimtab {
namespace {

/// Below so many images a prediction would be little more than the first image's time.
constexpr std::size_t kFewestImages = 8;
/// Triangles count by ten thousands, so that all quantities are of one order.
constexpr double kTriangleUnit = 1e-4;

std::array<double, 4> groundOf(const FrameLoad& load) {
  return {1, load.triangles * kTriangleUnit, load.groundMpx, load.sceneMpx};
}
std::array<double, 2> weatherOf(const FrameLoad& load) {
  return {load.particles, load.sceneMpx};
}
std::array<double, 1> blurOf(const FrameLoad& load) {
  return {load.sceneMpx};
}

double orZero(double ms) {
  return std::isnan(ms) ? 0 : ms;
}

}  // namespace

StageTimes predict(const CostCoefficients& c, const FrameLoad& load) {
  StageTimes times;
  times.ground = c.fixed + c.perTriangle * load.triangles + c.perGroundMpx * load.groundMpx +
                 c.perSceneMpx * load.sceneMpx;
  if (load.particles > 0) times.weather = c.perParticles * load.particles + c.perWeatherMpx * load.sceneMpx;
  if (load.blurs) times.blur = c.perBlurMpx * load.sceneMpx;
  times.other = c.other;
  return times;
}

double workMs(const FrameCost& cost) {
  return std::isfinite(cost.gpu) ? std::max(cost.gpu, cost.total) : cost.total;
}

StageTimes stagesOf(const FrameCost& cost) {
  const double other = orZero(cost.decide) + orZero(cost.page) + orZero(cost.symbology);
  const double weather = orZero(cost.weather), blur = orZero(cost.blur);
  return {std::max(workMs(cost) - other - weather - blur, 0.0), weather, blur, other};
}

void CostModel::observe(const FrameLoad& load, const FrameCost& cost) {
  const double work = workMs(cost);
  if (!std::isfinite(work) || !(work > 0)) return;
  const bool falls = load.particles > 0;
  if ((falls && std::isnan(cost.weather)) || (load.blurs && std::isnan(cost.blur))) return;
  const StageTimes took = stagesOf(cost);
  if (!(took.ground > 0)) return;

  const CostCoefficients before = coefficients(load);
  if (before.known) {
    // A running quantile: it rises nine times as fast as it falls, and rests where one image in ten is
    // outside.
    const double error = std::abs(work - predict(before, load).total());
    constexpr double kStep = 0.02;
    band_ = std::clamp(band_ + kStep * (error > before.bandMs ? 0.9 : -0.1) * band_, 0.3, 10.0);
  }
  ground_.observe(groundOf(load), took.ground);
  if (falls) weather_.observe(weatherOf(load), cost.weather);
  if (load.blurs) blur_.observe(blurOf(load), cost.blur);
  noteOther(took.other);
  ++images_;
}

/// The shortest of the first images counts, because the longer ones built and uploaded what it found. After
/// them the value moves like a median: a long upload now and then is not what every image takes.
void CostModel::noteOther(double ms) {
  if (otherImages_ < kFewestImages)
    other_ = otherImages_++ == 0 ? ms : std::min(other_, ms);
  else
    other_ += 0.05 * std::clamp(ms - other_, -0.5 * other_, 0.5 * other_ + 0.01);
}

CostCoefficients CostModel::coefficients(const FrameLoad& load) const {
  const auto& g = ground_.state().coefficient;
  const auto& w = weather_.state().coefficient;
  CostCoefficients c;
  c.fixed = g[0];
  c.perTriangle = g[1] * kTriangleUnit;
  c.perGroundMpx = g[2];
  c.perSceneMpx = g[3];
  c.perParticles = w[0];
  c.perWeatherMpx = w[1];
  c.perBlurMpx = blur_.state().coefficient[0];
  c.other = other_;
  double deviation = ground_.deviation(groundOf(load));
  if (load.particles > 0) deviation = std::hypot(deviation, weather_.deviation(weatherOf(load)));
  if (load.blurs) deviation = std::hypot(deviation, blur_.deviation(blurOf(load)));
  c.bandMs = band_ * deviation;
  c.known = ground_.state().images >= kFewestImages;
  return c;
}

CostModel::State CostModel::state() const {
  return {ground_.state(), weather_.state(), blur_.state(), other_, band_};
}

void CostModel::restore(const State& state) {
  ground_.restore(state.ground);
  weather_.restore(state.weather);
  blur_.restore(state.blur);
  other_ = state.other;
  otherImages_ = kFewestImages;
  band_ = state.band;
}

}  // namespace trimtab
