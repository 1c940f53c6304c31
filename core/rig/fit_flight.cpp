#include "trimtab/rig/fit_flight.h"

#include <algorithm>
#include <cmath>

#include "trimtab/measure/image_error.h"
#include "trimtab/measure/image_shift.h"
#include "trimtab/measure/statistics.h"

namespace trimtab {
namespace {

/// So many images of a setting count, and the quicker one is kept: a single late image is another program's.
constexpr std::size_t kCounted = 2;
/// The octaves of LoadShape, and steps to either end of a range that has no octaves.
constexpr int kOctaves = 4, kSteps = 3;

/// Returns the settings from the neutral value to an end of the range: octaves and the end, or equal steps
/// where a value is not above 0.
std::vector<double> towards(double neutral, double end) {
  std::vector<double> values;
  if (end == neutral) return values;
  if (!(neutral > 0 && end > 0)) {
    for (int i = 1; i <= kSteps; ++i) values.push_back(neutral + (end - neutral) * i / kSteps);
    return values;
  }
  constexpr double kNextTo = 1.05;
  const double factor = end > neutral ? 2 : 0.5;
  const auto beyond = [&](double value) {
    return factor > 1 ? value * kNextTo > end : value < end * kNextTo;
  };
  double value = neutral * factor;
  for (int i = 0; i < kOctaves && !beyond(value); ++i, value *= factor) values.push_back(value);
  values.push_back(end);
  return values;
}

/// A smaller shift is not told from none.
constexpr double kSeenPx = 0.1;

/// Where fewer of an image's blocks can be told, what is left says nothing of the image.
constexpr double kLeastTold = 0.5;

double median(const std::vector<double>& samples) {
  return quantileOf(samples, 0.5);
}

/// Returns the median shift of the views; NaN if most of them tell none.
double shiftOf(const std::vector<double>& views) {
  const auto told = std::ranges::count_if(views, [](double px) { return !std::isnan(px); });
  return 2 * told > std::ssize(views) ? median(views) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

FitFlight::FitFlight(IgProfile profile) : profile_(std::move(profile)) {
  for (const IgLever& lever : profile_.levers) {
    if (lever.names().value == nullptr) continue;  // the occlusion's resolution is no number of a lever
    for (const double end : {lever.ours().low, lever.ours().high})
      for (const double value : towards(lever.neutral(), end))
        settings_.push_back({&lever, value, {}, {}, {}, {}});
  }
  taken_.resize(settings_.size() + 1);
}

std::size_t FitFlight::imagesPerView() const {
  return taken_.size() * perSetting();
}

std::size_t FitFlight::perSetting() const {
  return static_cast<std::size_t>(profile_.settleImages) + kCounted;
}

/// Returns the number of the setting of a turn; 0 is neutral. Each view begins with another one, so that what
/// drifts while a view is drawn meets all of them alike.
std::size_t FitFlight::numberAt(std::size_t turn) const {
  return (turn + views()) % taken_.size();
}

const FitFlight::Setting& FitFlight::settingAt(std::size_t turn) const {
  const std::size_t number = numberAt(turn);
  return number == 0 ? neutral_ : settings_[number - 1];
}

void FitFlight::setLevers(FrameRequest& request) const {
  FrameLevers base = request.levers.preset;
  for (const IgLever& lever : profile_.levers)
    if (lever.names().value != nullptr) base.*lever.names().value = lever.neutral();
  request.levers = {base, base, base, base, base};
  const Setting& setting = settingAt(inView_ / perSetting());
  if (setting.lever != nullptr) request.levers.drawn.*setting.lever->names().value = setting.value;
}

bool FitFlight::wantsPicture() const {
  return inView_ % perSetting() + 1 == perSetting();
}

void FitFlight::picture(std::span<const std::uint8_t> rgba, int width, int height) {
  if (!wantsPicture()) return;
  taken_[numberAt(inView_ / perSetting())].seen = {{rgba.begin(), rgba.end()}, width, height};
}

void FitFlight::finished(const FrameRequest& drawn, const FrameCost& cost, double load) {
  Taken& taken = taken_[numberAt(inView_ / perSetting())];
  const std::size_t image = inView_ % perSetting(), settled = perSetting() - kCounted;
  if (image == 0) cost_.leversMoved();
  if (image >= settled) {
    const FrameLevers& levers = drawn.levers.drawn;
    const double part = levers.renderScale * levers.renderScale;
    cost_.observe({load, groundMpxOf({}, drawn.view, {drawn.eye, drawn.attitude}) * part,
                   1e-6 * drawn.view.widthPx * drawn.view.heightPx * part, 0, levers.blurStrength > 0},
                  cost);
    const double ms = workMs(cost);
    taken.ms = image == settled ? ms : std::min(taken.ms, ms);
    taken.load = load;
  }
  if (++inView_ < imagesPerView()) return;
  inView_ = 0;
  completeView();
}

void FitFlight::completeView() {
  for (std::size_t i = 0; i < settings_.size(); ++i) {
    Setting& s = settings_[i];
    const Taken& t = taken_[i + 1];
    s.ms.push_back(t.ms), s.load.push_back(t.load);
    const Seen &a = taken_[0].seen, &b = t.seen;
    if (a.rgba.empty() || b.rgba.empty()) continue;
    s.flip.push_back(flip(a.rgba, b.rgba, a.width, a.height));
    const ImageShift shift = imageShift(a.rgba, b.rgba, a.width, a.height);
    s.shiftPx.push_back(shift.told < kLeastTold ? std::numeric_limits<double>::quiet_NaN() : shift.p95Px);
  }
  neutral_.ms.push_back(taken_[0].ms), neutral_.load.push_back(taken_[0].load);
  for (Taken& t : taken_) t.seen.rgba.clear();
}

/// Returns the load that is left octave by octave of the lever that an allowed error moves: from setting to
/// setting by a constant factor an octave. Octaves beyond its range leave what its end does.
LoadShape FitFlight::shape() const {
  constexpr double kLeast = 1e-3;
  const IgLever* error = profile_.errorLever();
  double octave = 0, left = 1, nextOctave = 0, next = 1;
  auto s = settings_.begin();
  LoadShape shape;
  for (std::size_t k = 0; k < shape.size(); ++k) {
    const auto at = static_cast<double>(k);
    for (; s != settings_.end() && nextOctave < at; ++s) {
      if (s->lever != error || s->value <= error->neutral()) continue;
      octave = nextOctave, left = next;
      nextOctave = std::log2(s->value / error->neutral());
      next = std::clamp(pairedRatio(neutral_.load, s->load).median, kLeast, left);
    }
    const double part = nextOctave > octave ? std::clamp((at - octave) / (nextOctave - octave), 0.0, 1.0) : 1;
    shape[k] = left * std::pow(next / left, part);
  }
  return shape;
}

/// Returns the error that the neutral value of the error's lever stands for, pixels: the error is in
/// proportion to the lever, so that from neutral to s times as much it grows by s - 1 of it.
double FitFlight::neutralPx() const {
  std::vector<double> px;
  for (const Setting& s : settings_)
    if (s.lever == profile_.errorLever() && shiftOf(s.shiftPx) >= kSeenPx)
      px.push_back(shiftOf(s.shiftPx) / std::abs(s.value / s.lever->neutral() - 1));
  return median(px);
}

Result<IgFit> FitFlight::result() const {
  const auto refused = [&](std::string key, std::string expected, std::string found) {
    return Finding{Severity::error, "fit of " + profile_.name, std::move(key), std::move(expected),
                   std::move(found)};
  };
  if (views() == 0)
    return refused("views", "at least one, of " + std::to_string(imagesPerView()) + " images", "none");
  if (std::ranges::none_of(neutral_.ms, [](double ms) { return ms > 0; }))
    return refused("total_ms", "times of images", "none");
  if (std::ranges::none_of(neutral_.load, [](double load) { return load > 0; }))
    return refused("load", "a count in some image, or \"load\": \"time\" in the profile", "none");
  IgFit fit;
  fit.ig = profile_.name;
  fit.views = views();
  fit.timeMs = median(neutral_.ms);
  const auto [least, most] = std::ranges::minmax(neutral_.load);
  const bool enough = isEnoughFor(0.95, views());
  fit.loadLow = enough ? quantileOf(neutral_.load, 0.05) : least;
  fit.loadHigh = enough ? quantileOf(neutral_.load, 0.95) : most;
  for (const Setting& s : settings_) {
    LeverPoint point{s.lever->row, s.value, pairedRatio(neutral_.ms, s.ms),
                     pairedRatio(neutral_.load, s.load)};
    if (!s.flip.empty()) point.flip = median(s.flip), point.shiftPx = shiftOf(s.shiftPx);
    fit.points.push_back(point);
  }
  fit.shape = shape();
  fit.neutralPx = neutralPx();
  fit.cost = cost_.state();
  return fit;
}

}  // namespace trimtab
