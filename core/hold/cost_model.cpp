#include "trimtab/hold/cost_model.h"

#include <algorithm>
#include <cmath>

#include "trimtab/units/not_finite.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

/// Below this amount the model learns nothing of particles: the first drops of a fade cost the pass, not the
/// drops, and would give their cost a scale that is far too large.
constexpr double kFewestParticles = 0.05;
/// The model remembers so many times of what belongs to no load, and so many errors of predictions.
constexpr std::size_t kOthers = 9, kRecent = 50;
/// After so many predictions in a row of which each is more than twice too long or too short, a clock has
/// numbers that it can no longer correct, as from a damaged file. What is forgotten then is worth nothing.
constexpr int kHopeless = 100;
/// A time of the GPU may be late by so many images, because its stamps go round a ring of four frames.
constexpr std::size_t kMostLate = 3;
/// Triangles count by ten thousands, so that all quantities are of one order.
constexpr double kTriangleUnit = 1e-4;

std::array<double, 3> groundOf(const FrameLoad& load) {
  return {1, load.triangles * kTriangleUnit, load.groundMpx};
}
std::array<double, 2> weatherOf(const FrameLoad& load) {
  return {load.particles, load.sceneMpx};
}
std::array<double, 1> blurOf(const FrameLoad& load) {
  return {load.sceneMpx};
}

/// Reports whether a timer's value can be a time.
bool isTime(double ms) {
  return std::isfinite(ms) && ms >= 0;
}
double orZero(double ms) {
  return isTime(ms) ? ms : 0;
}

/// Keeps the last `most` values, of which there are at most kRecent.
void push(std::deque<double>& values, std::size_t most, double value) {
  if (values.size() == most) values.pop_front();
  values.push_back(value);
}
double medianOf(const std::deque<double>& values) {
  if (values.empty()) return 0;
  std::array<double, kRecent> sorted{};
  const auto end = std::copy(values.begin(), values.end(), sorted.begin());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(sorted.begin(), middle, end);
  return *middle;
}

StageTimes predict(const ClockCoefficients& c, const FrameLoad& load) {
  StageTimes times;
  times.ground = c.fixed + c.perTriangle * load.triangles + c.perGroundMpx * load.groundMpx;
  if (load.particles > 0) times.weather = c.perParticles * load.particles + c.perWeatherMpx * load.sceneMpx;
  if (load.blurs) times.blur = c.perBlurMpx * load.sceneMpx;
  times.other = c.other;
  return times;
}

}  // namespace

StageTimes predict(const CostCoefficients& cost, const FrameLoad& load) {
  const StageTimes first = predict(static_cast<const ClockCoefficients&>(cost), load);
  if (!cost.second) return first;
  const StageTimes second = predict(*cost.second, load);
  return second.total() > first.total() ? second : first;
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

void ClockModel::observe(const FrameLoad& load, const ClockTimes& times) {
  if (!(times.work >= cost_bounds::kShortestMs && times.work <= cost_bounds::kLongestMs)) return;
  const bool falls = load.particles > 0;
  if (times.apart && ((falls && !isTime(times.weather)) || (load.blurs && !isTime(times.blur)))) return;
  const StageTimes expected = predict(coefficients(), load);
  // If weather was not measured apart, it gets the time that nothing else is expected to use.
  const double weather =
      times.apart ? orZero(times.weather) : times.work - times.other - expected.ground - expected.blur;
  const double ground =
      times.work - times.other - orZero(times.blur) - (times.apart ? weather : expected.weather);
  if (times.apart && !(ground > 0)) return;
  if (known()) {
    const double error = std::abs(times.work - expected.total());
    push(off_, kRecent, error);
    const bool near = expected.total() <= 2 * times.work && times.work <= 2 * expected.total();
    farOff_ = near ? 0 : farOff_ + 1;
    // A running quantile: it rises nine times as fast as it falls, and rests where one image in ten is
    // outside.
    constexpr double kStep = 0.02;
    band_ =
        std::clamp(band_ + kStep * (error > halfBandMs(load) ? 0.9 : -0.1) * band_, kLeastBand, kMostBand);
  }
  ground_.observe(groundOf(load), ground);
  if (load.particles >= kFewestParticles) weather_.observe(weatherOf(load), weather);
  if (load.blurs) blur_.observe(blurOf(load), times.blur);
  // The median counts: a long upload, or a trial of a method that looks for hidden ground, is not what every
  // image takes.
  push(others_, kOthers, times.other);
  other_ = medianOf(others_);
  ++images_;
  const bool finite = ground_.state().isFinite() && weather_.state().isFinite() && blur_.state().isFinite();
  if (finite && farOff_ < kHopeless) return;
  Finding why{Severity::warning, "cost model", "prediction",
              finite ? "about " + numberText(times.work, 3) + " ms, which the image took" : "finite numbers",
              numberText(expected.total(), 3) + " ms after " + std::to_string(images_) +
                  " images, and many as far off before; it is learned anew"};
  if (whyAnew_) why = *whyAnew_;
  *this = ClockModel();
  whyAnew_ = std::move(why);
}

ClockCoefficients ClockModel::coefficients() const {
  const auto& g = ground_.state().coefficient;
  const auto& w = weather_.state().coefficient;
  return {g[0], g[1] * kTriangleUnit, g[2], w[0], w[1], blur_.state().coefficient[0], other_};
}

double ClockModel::halfBandMs(const FrameLoad& load) const {
  double deviation = ground_.deviation(groundOf(load));
  if (load.particles > 0) deviation = std::hypot(deviation, weather_.deviation(weatherOf(load)));
  if (load.blurs) deviation = std::hypot(deviation, blur_.deviation(blurOf(load)));
  return band_ * deviation;
}

double ClockModel::offMs() const {
  return medianOf(off_);
}

ClockModel::State ClockModel::state() const {
  return {ground_.state(), weather_.state(), blur_.state(), other_, band_};
}

void ClockModel::restore(const State& state) {
  ground_.restore(state.ground);
  weather_.restore(state.weather);
  blur_.restore(state.blur);
  other_ = state.other;
  others_.assign(kOthers, state.other);
  band_ = state.band;
}

void CostModel::observe(const FrameLoad& load, const FrameCost& cost) {
  const double before = orZero(cost.decide) + orZero(cost.occlusion) + orZero(cost.page);
  if (!isTime(cost.gpu))
    return processor_.observe(load, {cost.total, before + orZero(cost.symbology), cost.weather, cost.blur});
  // Beside a GPU the processor draws no pixel. Its work for particles is not measured apart.
  processor_.observe({load.triangles, 0, 0, load.particles, false}, {cost.total, before, 0, 0, false});
  if (loads_.size() > kMostLate) {
    gpu_.observe(loads_.back(), {cost.gpu, orZero(cost.symbology), cost.weather, cost.blur});
    loads_.pop_front();
  }
  loads_.push_back(load);
}

CostCoefficients CostModel::coefficients(const FrameLoad& load) const {
  CostCoefficients c;
  const ClockModel* longer = &processor_;
  if (gpu_.known()) {
    c.second = gpu_.coefficients();
    if (predict(*c.second, load).total() > predict(processor_.coefficients(), load).total())
      c.second = processor_.coefficients(), longer = &gpu_;
  }
  static_cast<ClockCoefficients&>(c) = longer->coefficients();
  c.halfBandMs = longer->halfBandMs(load);
  c.offMs = longer->offMs();
  c.known = processor_.known() && (loads_.empty() || gpu_.known());
  return c;
}

}  // namespace trimtab
