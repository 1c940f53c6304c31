#include "core/session/on_ground.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trimtab {
namespace {

constexpr double kDegree = 180 / std::numbers::pi;

/// Returns an attitude relative to a slope as one relative to the horizon.
Attitude conformed(const Attitude& attitude, const GroundSlope& slope) {
  const double heading = attitude.heading.in<Radians>(), pitch = attitude.pitch.in<Radians>(),
               roll = attitude.roll.in<Radians>();
  // The surface's own axes, in east, north and up: along the heading, to the right, and off the surface.
  const Vec3 up = normalized(Vec3{-slope.east, -slope.north, 1});
  const double east = std::sin(heading), north = std::cos(heading);
  const Vec3 ahead = normalized(Vec3{east, north, slope.east * east + slope.north * north});
  const Vec3 right = cross(ahead, up);
  // Pitch turns about the right wing, then roll about the nose.
  const Vec3 nose = ahead * std::cos(pitch) + up * std::sin(pitch);
  const Vec3 level = up * std::cos(pitch) - ahead * std::sin(pitch);
  const Vec3 wing = right * std::cos(roll) - level * std::sin(roll);
  const Vec3 top = level * std::cos(roll) + right * std::sin(roll);
  return {wrapped360(Degrees{std::atan2(nose.x, nose.y) * kDegree}),
          Degrees{std::asin(std::clamp(nose.z, -1.0, 1.0)) * kDegree},
          Degrees{std::atan2(-wing.z, top.z) * kDegree}};
}

}  // namespace

AircraftState onGround(AircraftState state, const GroundHeights* ground) {
  if (state.clamp == GroundClamp::none) return state;
  const Degrees latitude = state.position.latitude, longitude = state.position.longitude;
  if (ground != nullptr) {
    state.aboveGround = state.position.height;
    state.position.height = state.position.height + ground->heightAt(latitude, longitude).value_or(Metres{0});
    if (state.clamp == GroundClamp::conformal)
      if (const auto slope = slopeAt(*ground, latitude, longitude))
        state.attitude = conformed(state.attitude, *slope);
  }
  state.clamp = GroundClamp::none;
  return state;
}

}  // namespace trimtab
