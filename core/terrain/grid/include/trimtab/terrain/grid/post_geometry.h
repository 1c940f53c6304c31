#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/geodesy.h"

namespace trimtab::terrain {

/// Computes exact WGS84 positions of posts in the terrain's local frame, from tables per row and column.
class PostGeometry {
 public:
  /// Positions are whole multiples of 1/kStepsPerMetre m.
  static constexpr std::int64_t kStepsPerMetre = 256;
  /// Largest distance of a vertex from its tile's origin, metres: a float counts up to 2^24 steps exactly.
  static constexpr double kReachM = 65536.0 - 64.0;

  struct Lattice {
    std::int64_t x = 0, y = 0, z = 0;
  };

  explicit PostGeometry(const PostGrid& posts);

  const LocalFrame& frame() const { return frame_; }
  /// Returns a post's position, the same for every tile and level that uses it. Posts of levels whose tiles
  /// are too wide for floats in 1/256 m are rounded to a wider step, in the finer levels too.
  Lattice lattice(std::uint32_t row, std::uint32_t column, double height) const;
  /// Returns the ECEF position of a post at height 0.
  Vec3 onEllipsoid(std::uint32_t row, std::uint32_t column) const;
  /// Returns the upward normal, in the local frame, of a surface with the slopes `east` and `north` (rise
  /// over run).
  Vec3 normal(std::uint32_t row, std::uint32_t column, double east, double north) const;
  /// Returns the distance of adjacent columns at a row, metres, at height 0.
  double columnM(std::uint32_t row) const { return rows_[row].radius * stepLongitudeRad_; }
  /// Returns the distance from `row` to the next row, metres, at height 0; `row` may be the last one.
  double rowM(std::uint32_t row) const { return rows_[row].meridianRadius * stepLatitudeRad_; }
  /// Returns a bound on the distance between a triangle of a level and the curved earth below it, metres.
  double sagM(std::uint32_t level) const;
  /// Returns a bound on the rounding error of lattice(), metres.
  double roundingM() const;

 private:
  friend class PostPlane;
  struct Row {
    double sine, cosine;
    double normalRadius;    ///< N: along the normal to the polar axis
    double polarRadius;     ///< N (1 - e^2)
    double radius;          ///< N cos(latitude): distance from the polar axis
    double meridianRadius;  ///< M
  };
  struct Column {
    double sine, cosine;
  };
  int shiftOf(std::uint32_t row, std::uint32_t column) const;
  std::vector<Row> rows_;
  std::vector<Column> columns_;
  double stepLongitudeRad_, stepLatitudeRad_;
  LocalFrame frame_;
  Vec3 localOriginEcef_;
  std::vector<std::uint8_t> shiftOfLevel_;  ///< lattice step of a level = 2^shift / 256 m; never falls
  std::uint32_t unshifted_ = 0;             ///< bits of the posts' numbers: one is set, the shift is 0
};

}  // namespace trimtab::terrain
