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

/// Triangles to paint the ground with, wherever they are kept.
class GroundTriangles {
 public:
  virtual ~GroundTriangles() = default;
  /// At least those that reach into a rectangle, those that belong on top last. Many threads at once.
  virtual Result<std::vector<GroundTriangle>> over(const Rectangle& degrees) const = 0;
};

/// Those of scenery: areas, lines, airports, paint on pavement, the last on top.
class SceneryGround final : public GroundTriangles {
 public:
  /// The catalogue must outlive it. Longitudes are those within half a turn of `nearLongitude`.
  SceneryGround(const SceneryCatalogue& scenery, double nearLongitude)
      : scenery_(scenery), turn_(scenery.turnTo(nearLongitude)) {}
  Result<std::vector<GroundTriangle>> over(const Rectangle& degrees) const override;

 private:
  const SceneryCatalogue& scenery_;
  double turn_;
};

}  // namespace trimtab::terrain
