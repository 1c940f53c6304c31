#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>

#include "trimtab/units/quantity.h"

namespace trimtab {

struct CurvePoint {
  double x = 0;  ///< in the curve's own unit
  double y = 0;  ///< membership, 0..1

  friend constexpr bool operator==(const CurvePoint&, const CurvePoint&) = default;
};

/// A piecewise linear membership function: up to kCapacity points with rising x. It is a flat array, so that
/// parameters are one block of memory that is copied without allocating. Validation, not this type, refuses
/// falling x and fewer than two points.
struct CurvePoints {
  static constexpr std::size_t kCapacity = 32;

  std::array<CurvePoint, kCapacity> point{};
  std::size_t size = 0;

  constexpr CurvePoints() = default;
  constexpr CurvePoints(std::initializer_list<CurvePoint> points) {
    std::copy(points.begin(), points.end(), point.begin());
    size = points.size();
  }
  constexpr std::span<const CurvePoint> span() const { return {point.data(), size}; }
  friend constexpr bool operator==(const CurvePoints& a, const CurvePoints& b) {
    if (a.size != b.size) return false;
    for (std::size_t i = 0; i < a.size; ++i)
      if (a.point[i] != b.point[i]) return false;
    return true;
  }
};

/// Curve points whose x is a quantity of type X.
template <class X>
struct Curve : CurvePoints {
  using Argument = X;
  using CurvePoints::CurvePoints;
};

/// One resolution of occlusion, for total memberships from `low` up to, but not including, the next band's
/// low. The last band includes kTop.
struct Band {
  double low = 0;
  int widthPx = 0;
  int heightPx = 0;

  friend constexpr bool operator==(const Band&, const Band&) = default;
};

/// Bands in order of rising `low`. Below the first nothing looks for hidden ground (scheme *frustum*).
struct BandList {
  static constexpr std::size_t kCapacity = 16;
  static constexpr double kTop = 2.0;  ///< the largest total membership (documents A and B, Table 2)

  std::array<Band, kCapacity> band{};
  std::size_t size = 0;

  constexpr BandList() = default;
  constexpr BandList(std::initializer_list<Band> bands) {
    std::copy(bands.begin(), bands.end(), band.begin());
    size = bands.size();
  }
  constexpr std::span<const Band> span() const { return {band.data(), size}; }
  friend constexpr bool operator==(const BandList& a, const BandList& b) {
    if (a.size != b.size) return false;
    for (std::size_t i = 0; i < a.size; ++i)
      if (a.band[i] != b.band[i]) return false;
    return true;
  }
};

}  // namespace trimtab
