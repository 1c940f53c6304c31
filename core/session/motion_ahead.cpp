#include "trimtab/session/motion_ahead.h"

#include <algorithm>
#include <cmath>

namespace trimtab {
namespace {

constexpr double kLongestStepS = 0.25;

}  // namespace

void MotionAhead::push(double timeS, const ComingEye& eye) {
  const double seconds = timeS_ ? timeS - *timeS_ : 0;
  moves_ = seconds > 0 && seconds <= kLongestStepS;
  if (moves_) {
    step_.position = {eye.position.latitude - last_.position.latitude,
                      wrapped180(eye.position.longitude - last_.position.longitude),
                      eye.position.height - last_.position.height};
    step_.attitude = {wrapped180(eye.attitude.heading - last_.attitude.heading),
                      eye.attitude.pitch - last_.attitude.pitch,
                      wrapped180(eye.attitude.roll - last_.attitude.roll)};
    moves_ = std::isfinite(step_.position.latitude.value() + step_.position.longitude.value() +
                           step_.position.height.value() + step_.attitude.heading.value() +
                           step_.attitude.pitch.value() + step_.attitude.roll.value());
  }
  last_ = eye;
  if (std::isfinite(timeS))
    timeS_ = timeS;
  else
    timeS_.reset();
}

std::span<const ComingEye> MotionAhead::coming(std::size_t images) {
  coming_.clear();
  if (!moves_) return coming_;
  for (std::size_t i = 0; i < std::min(images, kMostImages); ++i) {
    const double n = static_cast<double>(i + 1);
    const double pitch = last_.attitude.pitch.value() + n * step_.attitude.pitch.value();
    coming_.push_back(
        {{last_.position.latitude + step_.position.latitude * n,
          wrapped180(last_.position.longitude + step_.position.longitude * n),
          last_.position.height + step_.position.height * n},
         {last_.attitude.heading + step_.attitude.heading * n, Degrees{std::clamp(pitch, -90.0, 90.0)},
          last_.attitude.roll + step_.attitude.roll * n}});
  }
  return coming_;
}

}  // namespace trimtab
