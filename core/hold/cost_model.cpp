#include "trimtab/hold/cost_model.h"

#include <algorithm>
#include <cmath>

#include "trimtab/units/not_finite.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

/// Below so many images a prediction would be little more than the first image's time.
constexpr std::size_t kFewestImages = 8;
/// What the first drops of a fade take is the pass, not the drops, and would give their cost a scale that is
/// far too large.
constexpr double kFewestParticles = 0.05;
/// Triangles count by ten thousands, so that all quantities are of one order.
constexpr double kTriangleUnit = 1e-4;

/// The side of a square with as many pixels as the scene, thousands of pixels.
double sideOf(const FrameLoad& load) {
  return std::sqrt(std::max(load.sceneMpx, 0.0));
}

std::array<double, 4> groundOf(const FrameLoad& load) {
  const double triangles = load.triangles * kTriangleUnit;
  return {1, triangles, triangles * sideOf(load), load.groundMpx};
}
std::array<double, 2> weatherOf(const FrameLoad& load) {
  return {load.particles, load.sceneMpx};
}
std::array<double, 1> blurOf(const FrameLoad& load) {
  return {load.sceneMpx};
}

/// Returns a covariance as CostVariance keeps it, in units that are so many times those of the filter.
template <std::size_t N, std::size_t Kept>
void keep(const std::array<std::array<double, N>, N>& covariance, const std::array<double, N>& unit,
          std::array<double, Kept>& kept) {
  static_assert(Kept == N * (N + 1) / 2);
  std::size_t at = 0;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = i; j < N; ++j) kept[at++] = covariance[i][j] * unit[i] * unit[j];
}

/// Returns the variance of a sum of coefficients times quantities.
template <std::size_t N, std::size_t Kept>
double varianceOf(const std::array<double, Kept>& kept, const std::array<double, N>& quantity) {
  double variance = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = i; j < N; ++j) variance += (i == j ? 1 : 2) * kept[at++] * quantity[i] * quantity[j];
  return std::max(variance, 0.0);
}

/// Reports whether a timer's value can be a time.
bool isTime(double ms) {
  return std::isfinite(ms) && ms >= 0;
}
double orZero(double ms) {
  return isTime(ms) ? ms : 0;
}

}  // namespace

StageTimes predict(const CostCoefficients& c, const FrameLoad& load) {
  StageTimes times;
  times.ground = c.fixed + (c.perTriangle + c.perTriangleSide * sideOf(load)) * load.triangles +
                 c.perGroundMpx * load.groundMpx;
  if (load.particles > 0) times.weather = c.perParticles * load.particles + c.perWeatherMpx * load.sceneMpx;
  if (load.blurs) times.blur = c.perBlurMpx * load.sceneMpx;
  times.other = c.other;
  return times;
}

double coefficientBandMs(const CostCoefficients& c, const FrameLoad& load) {
  const CostVariance& v = c.variance;
  double variance =
      varianceOf<4>(v.ground, {1, load.triangles, load.triangles * sideOf(load), load.groundMpx});
  if (load.particles > 0) variance += varianceOf<2>(v.weather, {load.particles, load.sceneMpx});
  if (load.blurs) variance += v.blur * load.sceneMpx * load.sceneMpx;
  return kNormalBand * std::sqrt(variance);
}

double mostTimesAsLong(const FrameLoad& before, const FrameLoad& after) {
  double most = 1;
  const auto compare = [&most](double from, double to) {
    if (to > from) most = std::max(most, from > 0 ? to / from : kInfinity);
  };
  compare(before.triangles, after.triangles);
  compare(before.triangles * sideOf(before), after.triangles * sideOf(after));
  compare(before.groundMpx, after.groundMpx);
  compare(before.sceneMpx, after.sceneMpx);
  compare(before.particles, after.particles);
  compare(before.blurs, after.blurs);
  return most;
}

double workMs(const FrameCost& cost) {
  return std::isfinite(cost.gpu) ? std::max(cost.gpu, cost.total) : cost.total;
}

StageTimes stagesOf(const FrameCost& cost) {
  const double other =
      orZero(cost.decide) + orZero(cost.occlusion) + orZero(cost.page) + orZero(cost.symbology);
  const double weather = orZero(cost.weather), blur = orZero(cost.blur);
  return {std::max(workMs(cost) - other - weather - blur, 0.0), weather, blur, other};
}

void CostModel::observe(const FrameLoad& load, const FrameCost& cost) {
  const double work = workMs(cost);
  if (!(work >= cost_bounds::kShortestMs && work <= cost_bounds::kLongestMs)) return;
  const bool falls = load.particles > 0;
  if ((falls && !isTime(cost.weather)) || (load.blurs && !isTime(cost.blur))) return;
  const StageTimes took = stagesOf(cost);
  if (!(took.ground > 0)) return;

  const CostCoefficients before = coefficients(load);
  if (before.known) {
    noteFarOff(predict(before, load).total(), work);
    // A running quantile: it rises nine times as fast as it falls, and rests where one image in ten is
    // outside.
    const double error = std::abs(work - predict(before, load).total());
    constexpr double kStep = 0.02;
    band_ = std::clamp(band_ + kStep * (error > before.bandMs ? 0.9 : -0.1) * band_, kLeastBand, kMostBand);
  }
  ground_.observe(groundOf(load), took.ground);
  if (load.particles >= kFewestParticles) weather_.observe(weatherOf(load), cost.weather);
  if (load.blurs) blur_.observe(blurOf(load), cost.blur);
  noteOther(took.other);
  ++images_;
  if (!ground_.state().isFinite() || !weather_.state().isFinite() || !blur_.state().isFinite())
    beginAnew({Severity::warning, "cost model", "", "finite numbers",
               "one that is not finite after " + std::to_string(images_) + " images"});
}

/// The coefficients mostly follow a machine that changes within some tens of images. Numbers that were read
/// from a damaged file may keep them far off for good, and so may a machine that was much slower for a while:
/// what is forgotten then is worth less than eight images.
void CostModel::noteFarOff(double predictedMs, double ms) {
  constexpr double kFar = 2;
  constexpr int kHopeless = 100;
  const bool near = predictedMs <= kFar * ms && predictedMs >= ms / kFar;
  farOff_ = near ? 0 : farOff_ + 1;
  if (farOff_ < kHopeless) return;
  beginAnew(
      {Severity::warning, "cost model", "prediction",
       "about " + numberText(ms, 3) + " ms, which the image took",
       numberText(predictedMs, 3) + " ms, and " + std::to_string(kHopeless - 1) + " before it as far off"});
}

void CostModel::beginAnew(Finding why) {
  why.found += "; it is learned anew";
  if (whyAnew_) why = *whyAnew_;
  *this = CostModel();
  whyAnew_ = std::move(why);
}

/// The median of the last images counts: a long upload, or a trial of a method that looks for hidden ground,
/// is not what every image takes.
void CostModel::noteOther(double ms) {
  if (others_.size() == kOthers) others_.pop_front();
  others_.push_back(ms);
  std::array<double, kOthers> sorted{};
  const auto end = std::copy(others_.begin(), others_.end(), sorted.begin());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(others_.size() / 2);
  std::nth_element(sorted.begin(), middle, end);
  other_ = *middle;
}

CostCoefficients CostModel::coefficients(const FrameLoad& load) const {
  const auto& g = ground_.state().coefficient;
  const auto& w = weather_.state().coefficient;
  CostCoefficients c;
  c.fixed = g[0];
  c.perTriangle = g[1] * kTriangleUnit;
  c.perTriangleSide = g[2] * kTriangleUnit;
  c.perGroundMpx = g[3];
  c.perParticles = w[0];
  c.perWeatherMpx = w[1];
  c.perBlurMpx = blur_.state().coefficient[0];
  c.other = other_;
  double deviation = ground_.deviation(groundOf(load));
  if (load.particles > 0) deviation = std::hypot(deviation, weather_.deviation(weatherOf(load)));
  if (load.blurs) deviation = std::hypot(deviation, blur_.deviation(blurOf(load)));
  c.bandMs = band_ * deviation;
  c.known = ground_.state().images >= kFewestImages;
  keep<4>(ground_.state().covariance, {1, kTriangleUnit, kTriangleUnit, 1}, c.variance.ground);
  keep<2>(weather_.state().covariance, {1, 1}, c.variance.weather);
  c.variance.blur = blur_.state().covariance[0][0];
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
  others_.assign(kOthers, state.other);
  band_ = state.band;
}

}  // namespace trimtab
