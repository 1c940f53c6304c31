#pragma once

#include "trimtab/units/geodesy.h"

namespace trimtab::flights {

inline constexpr double kStep = 0.01;  ///< seconds, of the integration

/// A jet trainer as a point mass: angles in degrees, the rest in metres and seconds. On the ground it rolls
/// straight on until it is fast enough.
struct PointMass {
  double latitude = 0, longitude = 0, height = 0;
  double speed = 0, acceleration = 0;
  double path = 0, pathRate = 0;
  double bank = 0, bankRate = 0;
  double track = 0;
  bool airborne = false;
};

struct Command {
  double bank = 0, path = 0, speed = 0;
};

/// One step of kStep towards what is commanded.
void advance(PointMass& a, const Command& c);
/// The body's attitude: the velocity's direction, banked, and the nose raised by the angle of attack that the
/// load factor needs.
Attitude attitudeOf(const PointMass& a);

/// Into -180..180.
double wrapped(double degrees);

}  // namespace trimtab::flights
