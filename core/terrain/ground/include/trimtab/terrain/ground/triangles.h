#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/terrain/grid/rectangle.h"
#include "trimtab/terrain/scenery/catalogue.h"
#include "trimtab/terrain/scenery/lines.h"

namespace trimtab::terrain {

/// A triangle to paint the ground with.
struct GroundTriangle {
  std::array<double, 3> longitude{}, latitude{};  ///< degrees
  std::array<std::uint8_t, 3> colour{};           ///< sRGB
  LineFeature line = LineFeature::none;
};

/// A source of triangles to paint the ground with.
class GroundTriangles {
 public:
  virtual ~GroundTriangles() = default;
  /// Returns all triangles that overlap a rectangle, and perhaps others; later ones are painted on top. It is
  /// thread-safe.
  virtual Result<std::vector<GroundTriangle>> over(const Rectangle& degrees) const = 0;
};

/// The triangles of scenery: areas, lines, airports, markings on pavement; later ones are painted on top.
class SceneryGround final : public GroundTriangles {
 public:
  /// The catalogue must outlive this object. Longitudes are within half a turn of `nearLongitude`, degrees.
  SceneryGround(const SceneryCatalogue& scenery, double nearLongitude)
      : scenery_(scenery), turn_(scenery.turnTo(nearLongitude)) {}
  Result<std::vector<GroundTriangle>> over(const Rectangle& degrees) const override;

 private:
  const SceneryCatalogue& scenery_;
  double turn_;
};

}  // namespace trimtab::terrain
