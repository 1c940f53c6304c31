// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QSet>

#include "trimtab/units/geodesy.h"

namespace trimtab::workbench {

/// An eye that a person moves with mouse and keys while no host and no flight moves it.
class FreeCamera {
 public:
  void place(const GeodeticPosition& position, const Attitude& attitude);
  const GeodeticPosition& position() const { return position_; }
  const Attitude& attitude() const { return attitude_; }
  double speedMps() const { return speedMps_; }

  /// Turns the view; pitch stops at straight up and down.
  void look(Degrees heading, Degrees pitch);
  /// Makes the camera a quarter faster per notch; slower if negative.
  void changeSpeed(double notches);

  /// Returns true if the key is one that moves the camera.
  bool press(int key);
  bool release(int key);
  void releaseAll() { held_.clear(); }
  bool moving() const { return !held_.isEmpty(); }
  /// Moves by the keys that are held, for this many seconds. A step is cut at a quarter of a second, so that
  /// the camera does not leap after a stall.
  void advance(double seconds);

 private:
  GeodeticPosition position_;
  Attitude attitude_;
  double speedMps_ = 150;
  QSet<int> held_;
};

}  // namespace trimtab::workbench
