#pragma once

#include <array>
#include <cmath>

#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/terrain_index.h"

namespace trimtab {

/// The near, left, right, bottom and top planes of a view, and the tests of boxes against them. There is no
/// far plane.
class Frustum {
 public:
  Frustum(const EyePose& eye, const ViewShape& view) : eye_(eye.position) {
    const Vec3 right = eye.axes.row[0], up = eye.axes.row[1], forward = -eye.axes.row[2];
    const auto side = [](Vec3 normal) { return Plane{normalized(normal), 0}; };
    planes_ = {side(right - forward * view.left), side(forward * view.right - right),
               side(up - forward * view.bottom), side(forward * view.top - up), Plane{forward, view.nearM}};
  }

  /// Points with dot(normal, p - eye) >= offset are inside.
  struct Plane {
    Vec3 normal;
    double offset = 0;
  };
  Vec3 eye() const { return eye_; }
  const std::array<Plane, 5>& planes() const { return planes_; }

  /// Returns false only if no point of the box can be in the image.
  bool mayShow(const Box& b) const {
    return eachPlane(b, [](double middle, double reach, double offset, double margin) {
      // The test is written so that a plane that is not a number drops nothing.
      return !(middle + reach < offset - margin);
    });
  }

  /// Returns true only if every point of the box is inside all planes, so that GL clips no triangle there.
  bool holds(const Box& b) const {
    return eachPlane(b, [](double middle, double reach, double offset, double margin) {
      return middle - reach > offset + margin;
    });
  }

 private:
  template <class Test>
  bool eachPlane(const Box& b, Test test) const {
    const Vec3 centre = Vec3{0.5 * (double{b.minX} + b.maxX), 0.5 * (double{b.minY} + b.maxY),
                             0.5 * (double{b.minZ} + b.maxZ)} -
                        eye_;
    const Vec3 half{0.5 * (double{b.maxX} - b.minX), 0.5 * (double{b.maxY} - b.minY),
                    0.5 * (double{b.maxZ} - b.minZ)};
    // Vertices are drawn from floats relative to the eye, whose error is below 1e-6 of their distance.
    const double margin = 1e-3 + 1e-6 * (std::abs(centre.x) + std::abs(centre.y) + std::abs(centre.z) +
                                         half.x + half.y + half.z);
    for (const Plane& plane : planes_) {
      const double reach = half.x * std::abs(plane.normal.x) + half.y * std::abs(plane.normal.y) +
                           half.z * std::abs(plane.normal.z);
      if (!test(dot(plane.normal, centre), reach, plane.offset, margin)) return false;
    }
    return true;
  }

  Vec3 eye_;
  std::array<Plane, 5> planes_;
};

}  // namespace trimtab
