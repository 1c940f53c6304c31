#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/geodesy.h"

namespace trimtab::terrain {

/// True WGS84 positions of posts in the terrain's local frame, from tables by row and by column.
class PostGeometry {
 public:
  /// Steps of the lattice a metre: positions are whole numbers of them.
  static constexpr std::int64_t kStepsPerMetre = 256;
  /// Vertices are floats relative to an origin: 2^24 steps is as far as a float counts.
  static constexpr double kReachM = 65536.0 - 64.0;

  struct Lattice {
    std::int64_t x = 0, y = 0, z = 0;
  };

  explicit PostGeometry(const PostGrid& posts);

  const LocalFrame& frame() const { return frame_; }
  /// A post's place, the same for every tile and level that uses it. Posts of levels whose tiles are too wide
  /// for floats in 1/256 m are rounded to a wider step, in the finer levels too.
  Lattice lattice(std::uint32_t row, std::uint32_t column, double height) const;
  /// ECEF of a post at height 0.
  Vec3 onEllipsoid(std::uint32_t row, std::uint32_t column) const;
  /// Upward normal in the local frame of a surface that rises by `east` and `north` a metre there.
  Vec3 normal(std::uint32_t row, std::uint32_t column, double east, double north) const;
  /// Metres from a column to the next at a row, at height 0.
  double columnM(std::uint32_t row) const { return rows_[row].radius * stepLongitudeRad_; }
  /// Metres from a row to the next, at height 0; `row` may be the last (the step on beyond it).
  double rowM(std::uint32_t row) const { return rows_[row].meridianRadius * stepLatitudeRad_; }
  /// Bound on how far a triangle of a level strays from the curved earth under it, metres.
  double sagM(std::uint32_t level) const;
  /// Bound on the distance of a lattice position from the true one, metres.
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
