// SPDX-License-Identifier: GPL-3.0-or-later
#include "free_camera.h"

#include <Qt>
#include <algorithm>
#include <cmath>

namespace trimtab::workbench {
namespace {

constexpr int kKeys[] = {Qt::Key_W,    Qt::Key_A,     Qt::Key_S,      Qt::Key_D,
                         Qt::Key_Q,    Qt::Key_E,     Qt::Key_Up,     Qt::Key_Down,
                         Qt::Key_Left, Qt::Key_Right, Qt::Key_PageUp, Qt::Key_PageDown};
constexpr double kTurnDegPerS = 40;
constexpr double kSlowestMps = 1, kFastestMps = 20000;
constexpr double kLowestM = -500, kHighestM = 100000;

bool isCameraKey(int key) {
  return std::find(std::begin(kKeys), std::end(kKeys), key) != std::end(kKeys);
}

}  // namespace

void FreeCamera::place(const GeodeticPosition& position, const Attitude& attitude) {
  position_ = position;
  attitude_ = attitude;
}

void FreeCamera::look(Degrees heading, Degrees pitch) {
  attitude_.heading = wrapped360(attitude_.heading + heading);
  attitude_.pitch = Degrees{std::clamp(attitude_.pitch.value() + pitch.value(), -90.0, 90.0)};
}

void FreeCamera::changeSpeed(double notches) {
  speedMps_ = std::clamp(speedMps_ * std::pow(1.25, notches), kSlowestMps, kFastestMps);
}

bool FreeCamera::press(int key) {
  if (!isCameraKey(key)) return false;
  held_.insert(key);
  return true;
}

bool FreeCamera::release(int key) {
  held_.remove(key);
  return isCameraKey(key);
}

void FreeCamera::advance(double seconds) {
  if (held_.isEmpty()) return;
  const double s = std::clamp(seconds, 0.0, 0.25);
  const auto axis = [this](int plus, int minus) {
    return double(held_.contains(plus)) - double(held_.contains(minus));
  };
  look(Degrees{axis(Qt::Key_Right, Qt::Key_Left) * kTurnDegPerS * s},
       Degrees{axis(Qt::Key_Up, Qt::Key_Down) * kTurnDegPerS * s});

  const double forward = axis(Qt::Key_W, Qt::Key_S), right = axis(Qt::Key_D, Qt::Key_A);
  const double up =
      std::clamp(axis(Qt::Key_PageUp, Qt::Key_PageDown) + axis(Qt::Key_E, Qt::Key_Q), -1.0, 1.0);
  if (forward == 0 && right == 0 && up == 0) return;
  const double heading = attitude_.heading.in<Radians>(), pitch = attitude_.pitch.in<Radians>();
  const Vec3 ahead{std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch), std::sin(pitch)};
  const Vec3 aside{std::cos(heading), -std::sin(heading), 0};
  const Vec3 step = (ahead * forward + aside * right + Vec3{0, 0, up}) * (speedMps_ * s);
  const Mat3 toEarth = transposed(eastNorthUp(position_.latitude, position_.longitude));
  GeodeticPosition next = toGeodetic(toEcef(position_) + toEarth * step);
  next.height = Metres{std::clamp(next.height.value(), kLowestM, kHighestM)};
  position_ = next;
}

}  // namespace trimtab::workbench
