#include "exposed_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "trimtab/measure/image_error.h"
#include "trimtab/motion/line_of_sight.h"

namespace trimtab::experiment {
namespace {

/// Times of an exposure at which the scene is drawn: of a sweep at 180 degrees a second, some 7 px apart.
constexpr int kMostTimes = 8;

/// Returns the attitude a part of the way back from `now` to `then`; a part above 1 goes beyond.
Attitude back(const Attitude& now, const Attitude& then, double part) {
  const auto mixed = [part](Degrees a, Degrees b) { return a + wrapped180(b - a) * part; };
  return {mixed(now.heading, then.heading), mixed(now.pitch, then.pitch), mixed(now.roll, then.roll)};
}

class Average {
 public:
  void add(const std::vector<std::uint8_t>& image) {
    sum_.resize(image.size());
    for (std::size_t i = 0; i < image.size(); ++i) sum_[i] += image[i];
    ++images_;
  }
  std::vector<std::uint8_t> image() const {
    std::vector<std::uint8_t> mean(sum_.size());
    for (std::size_t i = 0; i < mean.size(); ++i)
      mean[i] = static_cast<std::uint8_t>((sum_[i] + images_ / 2) / images_);
    return mean;
  }

 private:
  std::vector<std::uint32_t> sum_;
  std::uint32_t images_ = 0;
};

}  // namespace

ExposedError exposedError(scene::ErrorMeter& meter, const FrameRequest& request,
                          std::span<const FrameRequest> before, double exposureMs) {
  ExposedError error;
  error.sharp = error.smeared = meter.measure(request, before, nullptr).flip;
  if (before.empty()) return error;
  const FrameRequest& last = before.back();
  const double seconds = request.time - last.time;
  if (!(seconds > 0)) return error;
  const double turned = degreesBetween(directionOf(last.attitude), directionOf(request.attitude));
  // The way of a point at the image's centre during the exposure, pixels.
  const double smear =
      turned / seconds * exposureMs * 1e-3 * std::numbers::pi / 180 * pixelsPerRadian(request.view);
  if (!(smear >= 1)) return error;
  const int times = std::clamp(static_cast<int>(std::ceil(smear)), 2, kMostTimes);
  const double perExposure = exposureMs * 1e-3 / seconds;
  Average reference, ours;
  for (int i = 0; i < times; ++i) {
    FrameRequest at = request;
    at.attitude = back(request.attitude, last.attitude, perExposure * (i + 0.5) / times);
    scene::ErrorPictures pictures;
    meter.measure(at, before, &pictures);
    reference.add(pictures.reference);
    ours.add(pictures.ours);
  }
  error.smeared = flip(reference.image(), ours.image(), request.view.widthPx, request.view.heightPx, {});
  return error;
}

}  // namespace trimtab::experiment
