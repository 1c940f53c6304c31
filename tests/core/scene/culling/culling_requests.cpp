#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "culling_truth.h"
#include "trimtab/frame/frame_request.h"

/// The views of CullingTruth: of all kinds, and frames of a flight.
namespace trimtab::test {
namespace {

constexpr double kRadians = 3.14159265358979 / 180;

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

}  // namespace

FrameRequest CullingTruth::viewOf(const GeodeticPosition& eye, const Attitude& attitude) const {
  auto r = request(eye, attitude);
  r.terrain.form = form_;
  r.waitForPages = true;
  return r;
}

std::vector<FrameRequest> CullingTruth::anyViews(int count, unsigned seed) const {
  std::mt19937 random(seed);
  std::vector<FrameRequest> views;
  for (int i = 0; i < count; ++i) {
    double east = between(random, 0.02, 0.98), north = between(random, 0.02, 0.98);
    // Valleys and shores: the lowest of some places nearby.
    if (i % 3 == 1) {
      double lowest = 1e9;
      const double east0 = east, north0 = north;
      for (int k = 0; k < 12; ++k) {
        const double e = std::clamp(east0 + between(random, -0.03, 0.03), 0.0, 1.0),
                     n = std::clamp(north0 + between(random, -0.03, 0.03), 0.0, 1.0);
        const double height = over(e, n, 0).height.value();
        if (height < lowest) lowest = height, east = e, north = n;
      }
    }
    // Up to 9,000 m above the ground, most of them low, where much is hidden.
    double above = 8 * std::pow(9000 / 8.0, std::pow(between(random, 0, 1), 2.5));
    if (i % 16 == 5) above = between(random, 9000, 30000);
    if (i % 24 == 11) above = -between(random, 5, 300);
    if (i % 12 == 8) east = between(random, -0.2, 1.2), north = i % 8 == 0 ? -0.1 : 1.15;
    double pitch = between(random, -20, 5);
    if (i % 7 == 3) pitch = between(random, -89, -45);
    if (i % 13 == 6) pitch = between(random, 5, 60);
    if (i % 40 == 39) pitch = -90;
    const double roll = i % 3 == 0 ? between(random, -180, 180) : 0;
    auto r =
        viewOf(over(east, north, above), {Degrees{between(random, 0, 360)}, Degrees{pitch}, Degrees{roll}});
    ViewShape& v = r.view;
    if (i % 8 == 2) v.widthPx = 1280, v.heightPx = 720;
    if (i % 16 == 9) v.widthPx = 333, v.heightPx = 217;
    if (i % 5 == 4) v.left = -0.2, v.right = 0.9, v.bottom = -0.6, v.top = 0.1;
    if (i % 9 == 2) v.left = -1.7, v.right = 1.7, v.bottom = -1, v.top = 1;
    if (i % 11 == 7) v.left = -0.02, v.right = 0.02, v.bottom = -0.01, v.top = 0.01;
    r.levers.drawn.errorPx = i % 16 == 1 ? 0.1 : i % 4 == 0 ? 6.0 : i % 4 == 1 ? 0.5 : 2.0;
    r.levers.drawn.treeErrorPx = r.levers.drawn.errorPx;
    if (i % 10 == 6) {
      const double farM = between(random, 3000, 20000);
      r.decision.weather = {
          .fogged = true, .visibilityM = farM, .extinctionPerM = 3.912 / farM, .farM = farM};
      r.levers.drawn.farM = r.decision.weather.farM;
    }
    views.push_back(r);
  }
  return views;
}

std::vector<FrameRequest> CullingTruth::flight(int frames, unsigned seed) const {
  std::mt19937 random(seed);
  std::vector<FrameRequest> path;
  constexpr double kStepM = 600 * 1852.0 / 3600 / 60, kTurnDeg = 200.0 / 60;
  double east = 0.5, north = 0.5, course = 0, head = 0, above = 60;
  for (int i = 0; i < frames; ++i) {
    const int leg = i / legFrames(), step = i % legFrames();
    if (step == 0) {  // a leap
      east = between(random, 0.2, 0.8), north = between(random, 0.2, 0.8);
      course = between(random, 0, 360), head = course;
      above = leg % 4 == 3 ? between(random, 1500, 4000) : between(random, 15, 400);
    }
    const bool stands = leg % 3 == 2;
    const double stepM = leg % 2 == 1 ? kStepM * (4 + leg % 9) : kStepM;
    if (!stands) {
      const auto& info = database->info();
      const double heightM = 111e3 * (info.northEast.latitude - info.southWest.latitude).value(),
                   turned = course * kRadians;
      const double middle = (info.northEast.latitude + info.southWest.latitude).value() / 2;
      const double widthM = 111e3 * scene::widthOf(info).value() * std::cos(middle * kRadians);
      east += stepM * std::sin(turned) / widthM, north += stepM * std::cos(turned) / heightM;
      if (leg % 4 == 1) above += 2;
    }
    head += (step / (legFrames() / 2) % 2 == 0 ? kTurnDeg : -kTurnDeg);
    if (leg % 5 == 4) head = course;
    auto r = viewOf(over(east, north, above),
                    {Degrees{head}, Degrees{leg % 4 == 2 ? -35.0 : -4.0}, Degrees{leg % 3 == 1 ? 30.0 : 0}});
    r.time = i / 60.0;
    r.levers.drawn.errorPx = leg % 3 == 0 ? 0.5 : 2.0;
    if (step >= legFrames() * 3 / 4) r.levers.drawn.lodScale = 2;
    r.levers.drawn.treeErrorPx = r.levers.drawn.errorPx;
    path.push_back(r);
  }
  return path;
}

std::string CullingTruth::describe(const FrameRequest& r) {
  char text[400];
  std::snprintf(
      text, sizeof text,
      "eye %.9f %.9f %.4f, attitude %.6f %.6f %.6f, %dx%d, tangents %g %g %g %g, error %g, scale %g, "
      "far %g",
      r.eye.latitude.value(), r.eye.longitude.value(), r.eye.height.value(), r.attitude.heading.value(),
      r.attitude.pitch.value(), r.attitude.roll.value(), r.view.widthPx, r.view.heightPx, r.view.left,
      r.view.right, r.view.bottom, r.view.top, r.levers.drawn.errorPx, r.levers.drawn.lodScale,
      r.levers.drawn.farM);
  return text;
}

}  // namespace trimtab::test
