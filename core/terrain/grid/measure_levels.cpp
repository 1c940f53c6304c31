#include "trimtab/terrain/grid/measure_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "slope_cone.h"
#include "trimtab/frame/box_union.h"
#include "trimtab/terrain/grid/parallel.h"

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kCells = TerrainIndex::kTileCells;
/// Columns meet at a pole. Nothing that close to it is drawn apart.
constexpr double kShortest = 0.01;
/// Steeper ground than this adds nothing more to what a shift sideways does to a height.
constexpr double kCliff = 50;

struct Measure {
  const PostGrid& posts;
  std::span<const float> heights;
  const PostGeometry& geometry;
  TerrainIndex& index;
  CellSlopes& slopes;

  double height(std::uint32_t row, std::uint32_t column) const {
    return heights[std::size_t{row} * posts.columns + column];
  }

  void bounds(std::uint32_t node) const;
  void errorAndSlope(std::uint32_t node) const;
  NormalCone coneOf(const SlopeCone& steep, const TilePosts& tile, double slack) const;
  double cellError(std::uint32_t r0, std::uint32_t r1, std::uint32_t c0, std::uint32_t c1,
                   bool southWestNorthEast) const;
};

/// Returns the next float below a number of lattice steps in metres; `above` does the same above it.
float below(std::int64_t steps) {
  return std::nextafter(static_cast<float>(static_cast<double>(steps) / PostGeometry::kStepsPerMetre),
                        -std::numeric_limits<float>::max());
}
float above(std::int64_t steps) {
  return std::nextafter(static_cast<float>(static_cast<double>(steps) / PostGeometry::kStepsPerMetre),
                        std::numeric_limits<float>::max());
}

void Measure::bounds(std::uint32_t node) const {
  const TilePosts tile(index, posts, node);
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  PostGeometry::Lattice low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  const std::uint32_t lastRow = tile.row(kCells), lastColumn = tile.column(kCells);
  for (std::uint32_t r = tile.row(0); r <= lastRow; ++r)
    for (std::uint32_t c = tile.column(0); c <= lastColumn; ++c) {
      const PostGeometry::Lattice p = geometry.lattice(r, c, height(r, c));
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  index.bounds[node] = {below(low.x),  below(low.y),  below(low.z),
                        above(high.x), above(high.y), above(high.z)};
}

/// Returns the largest |post - triangle| over a cell's posts. The triangles are linear in column and row.
double Measure::cellError(std::uint32_t r0, std::uint32_t r1, std::uint32_t c0, std::uint32_t c1,
                          bool southWestNorthEast) const {
  const double sw = height(r0, c0), se = height(r0, c1), nw = height(r1, c0), ne = height(r1, c1);
  const double wide = c1 - c0, high = r1 - r0;
  double worst = 0;
  const auto span = [&](const float* row, std::uint32_t from, std::uint32_t to, double start, double step) {
    for (std::uint32_t k = from; k <= to; ++k) worst = std::max(worst, std::abs(row[k] - (start + step * k)));
  };
  for (std::uint32_t r = r0; r <= r1; ++r) {
    const float* row = &heights[std::size_t{r} * posts.columns + c0];
    const double v = (r - r0) / high;
    // West part up to the diagonal, then the east part; both are the diagonal's value on it.
    if (southWestNorthEast) {
      const auto middle = static_cast<std::uint32_t>(v * wide);
      span(row, 0, middle, sw + v * (nw - sw), (ne - nw) / wide);
      if (middle < c1 - c0) span(row, middle + 1, c1 - c0, sw + v * (ne - se), (se - sw) / wide);
    } else {
      const auto middle = static_cast<std::uint32_t>((1 - v) * wide);
      span(row, 0, middle, sw + v * (nw - sw), (se - sw) / wide);
      if (middle < c1 - c0)
        span(row, middle + 1, c1 - c0, ne + (nw - ne) + (1 - v) * (se - ne), (ne - nw) / wide);
    }
  }
  return worst;
}

void Measure::errorAndSlope(std::uint32_t node) const {
  const TilePosts tile(index, posts, node);
  const std::uint32_t level = tile.level;
  double worst = 0;
  SlopeCone cone;
  std::array<std::array<double, kCells>, kCells> steep{};
  for (std::uint32_t j = 0; j < kCells; ++j) {
    const std::uint32_t r0 = tile.row(j), r1 = tile.row(j + 1);
    if (r0 == r1) break;
    // Runs at their shortest within the cell.
    const double dy = std::min(geometry.rowM(r0), geometry.rowM(r1)) * (r1 - r0);
    const double columnM = std::max(std::min(geometry.columnM(r0), geometry.columnM(r1)), kShortest);
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const std::uint32_t c0 = tile.column(i), c1 = tile.column(i + 1);
      if (c0 == c1) break;
      const double dx = columnM * (c1 - c0);
      const double sw = height(r0, c0), se = height(r0, c1), nw = height(r1, c0), ne = height(r1, c1);
      const bool diagonal = (i + j) % 2 == 0;
      cone.addCell({sw, se, nw, ne}, geometry.columnM(r0) * (c1 - c0), geometry.columnM(r1) * (c1 - c0), dy,
                   diagonal);
      const double south = std::abs(se - sw) / dx, north = std::abs(ne - nw) / dx;
      const double west = std::abs(nw - sw) / dy, east = std::abs(ne - se) / dy;
      const double first = south * south + (diagonal ? east * east : west * west),
                   second = north * north + (diagonal ? west * west : east * east);
      steep[j][i] = std::sqrt(std::max(first, second));
      if (level > 0) worst = std::max(worst, cellError(r0, r1, c0, c1, diagonal));
    }
  }
  // Borders drawn with the coarser neighbour's posts: the triangle of two even posts and the fan's centre.
  const auto stitch = [&](std::uint32_t k, std::uint32_t even, std::uint32_t inner, bool horizontal) {
    const auto post = [&](std::uint32_t along, std::uint32_t across) {
      return horizontal ? height(tile.row(across), tile.column(along))
                        : height(tile.row(along), tile.column(across));
    };
    const auto at = [&](std::uint32_t along) { return horizontal ? tile.column(along) : tile.row(along); };
    const double before = at(k + 1) - at(k), both = at(k + 2) - at(k);
    const std::uint32_t rowA = tile.row(horizontal ? even : k), rowB = tile.row(horizontal ? inner : k + 2);
    const double columnM = std::max(std::min(geometry.columnM(rowA), geometry.columnM(rowB)), kShortest);
    const double rowM = std::min(geometry.rowM(rowA), geometry.rowM(rowB));
    const double across = horizontal ? std::abs(double{1} * tile.row(inner) - tile.row(even)) * rowM
                                     : std::abs(double{1} * tile.column(inner) - tile.column(even)) * columnM;
    if (both == 0 || across == 0) return;
    const double h0 = post(k, even), h2 = post(k + 2, even), centre = post(k + 1, inner);
    const double run = both * (horizontal ? columnM : rowM);
    const double rise = (h2 - h0) / run, inwards = (centre - (h0 + (h2 - h0) * before / both)) / across,
                 sideways = inner > even ? inwards : -inwards;
    const double slope = std::hypot(rise, inwards);
    cone.add(horizontal ? rise : sideways, horizontal ? sideways : rise);
    const std::uint32_t cell = std::min(even, inner);
    for (const std::uint32_t along : {k, k + 1}) {
      double& s = horizontal ? steep[cell][along] : steep[along][cell];
      s = std::max(s, slope);
    }
  };
  for (std::uint32_t k = 0; k < kCells; k += 2)
    for (const bool horizontal : {true, false}) {
      stitch(k, 0, 1, horizontal);
      stitch(k, kCells, kCells - 1, horizontal);
    }

  // Runs are at height 0 on an ellipsoid: 1e-4 covers ground below the sea, the rest the rounding and the
  // bend.
  const double span = std::ldexp(std::max(geometry.rowM(tile.row(0)), geometry.columnM(tile.row(0))),
                                 static_cast<int>(level));
  const double shortest = std::ldexp(std::min({geometry.rowM(tile.row(0)), geometry.columnM(tile.row(0)),
                                               geometry.columnM(tile.row(kCells))}),
                                     static_cast<int>(level));
  const double slack = 4 * geometry.roundingM() / std::max(shortest, 1e-3) + span / 6.3e6;
  double steepest = 0;
  for (std::uint32_t j = 0; j < kCells; ++j)
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const double s =
          steep[j][i] == 0 && tile.column(i) == tile.column(i + 1) ? 0 : steep[j][i] * 1.0001 + slack;
      steepest = std::max(steepest, s);
      const double steps = std::ceil(s * CellSlopes::kStepsPerUnit);
      slopes.cells[slopes.at(index, level, tile.tileRow * kCells + j, tile.tileColumn * kCells + i)] =
          static_cast<std::uint8_t>(steps < 255 ? steps : 255.0);
    }
  index.slopeMax[node] = static_cast<float>(steepest * (1 + 1e-6));
  index.cones[node] = coneOf(cone, tile, slack);
  const double astray = (level > 0 ? geometry.sagM(level) : 0.0) + geometry.roundingM();
  index.errorM[node] = static_cast<float>((worst + astray * (1 + std::min(steepest, kCliff))) * (1 + 1e-6));
}

/// Returns the cone in the local frame. Slopes are by the compass at each place, their cone's axis by that in
/// the tile's middle.
NormalCone Measure::coneOf(const SlopeCone& steep, const TilePosts& tile, double slack) const {
  const std::uint32_t firstRow = tile.row(0), lastRow = tile.row(kCells), firstColumn = tile.column(0),
                      lastColumn = tile.column(kCells);
  const double wide = (lastColumn - firstColumn) *
                      std::max(geometry.columnM(firstRow), geometry.columnM(lastRow)),
               high = (lastRow - firstRow) * std::max(geometry.rowM(firstRow), geometry.rowM(lastRow));
  const double least = std::min(geometry.columnM(firstRow), geometry.columnM(lastRow));
  if (!(least > kShortest)) return {};
  // Up turns by what a place is off the middle over the earth's radius, east by as much as meridians
  // converge.
  const double earth = 6.3e6, off = std::hypot(wide, high) / 2,
               furthest = std::max(std::abs(posts.latitude(firstRow)), std::abs(posts.latitude(lastRow)));
  const double turned = 1.1 * off / earth * (1 + std::tan(furthest * std::numbers::pi / 180));
  // Where that is much, more than these two count, and no such tile is seen from one side only.
  if (!(furthest < 89.9 && turned < 0.1)) return {};
  const auto [east, north] = steep.middle();
  const Vec3 axis = geometry.normal(firstRow + (lastRow - firstRow) / 2,
                                    firstColumn + (lastColumn - firstColumn) / 2, east, north);
  return NormalCone::about(axis, steep.halfAngle() + turned + slack + 1e-4);
}

void gatherFromChildren(TerrainIndex& index) {
  for (std::uint32_t node = 0; node < index.size(); ++node) {
    const std::uint32_t parent = index.parent[node];
    if (parent == TerrainIndex::kNone) continue;
    index.errorM[parent] = std::max(index.errorM[parent], index.errorM[node]);
    index.slopeMax[parent] = std::max(index.slopeMax[parent], index.slopeMax[node]);
    const Box& box = index.bounds[node];
    index.bounds[parent] = index.children[parent][0] == node ? box : united(index.bounds[parent], box);
  }
}

void gatherFromNeighbours(TerrainIndex& index) {
  const std::vector<float> own = index.slopeMax;
  for (std::uint32_t node = 0; node < index.size(); ++node) {
    const auto take = [&](std::uint32_t other) {
      if (other != TerrainIndex::kNone) index.slopeMax[node] = std::max(index.slopeMax[node], own[other]);
    };
    for (const std::uint32_t beside : index.neighbours[node]) take(beside);
    for (const std::size_t along : {0u, 1u}) {
      const std::uint32_t beside = index.neighbours[node][along];
      if (beside == TerrainIndex::kNone) continue;
      take(index.neighbours[beside][2]);
      take(index.neighbours[beside][3]);
    }
  }
}

}  // namespace

CellSlopes::CellSlopes(const TerrainIndex& index) {
  std::size_t size = 0;
  for (const TerrainIndex::Level& level : index.levels) {
    firstOfLevel.push_back(size);
    size += std::size_t{level.columns} * level.rows * kCells * kCells;
  }
  firstOfLevel.push_back(size);
  cells.resize(size);
}

bool measureLevels(const PostGrid& posts, std::span<const float> heights, const PostGeometry& geometry,
                   TerrainIndex& index, CellSlopes& slopes, const std::function<bool(double)>& carryOn) {
  const Measure measure{posts, heights, geometry, index, slopes};
  index.frame = geometry.frame();
  index.cones.assign(index.size(), {});
  const std::uint32_t finest =
      index.levels.size() > 1 ? index.levels[1].firstNode : static_cast<std::uint32_t>(index.size());
  const bool done = forEachParallel(
      static_cast<std::uint32_t>(index.size()),
      [&](std::uint32_t i) {
        // The coarsest level comes first: its tiles cost the most time, so that no core is left with one at
        // the end.
        const auto node = static_cast<std::uint32_t>(index.size()) - 1 - i;
        if (node < finest) measure.bounds(node);
        measure.errorAndSlope(node);
      },
      carryOn);
  if (!done) return false;
  gatherFromChildren(index);
  gatherFromNeighbours(index);
  return true;
}

}  // namespace trimtab::terrain
