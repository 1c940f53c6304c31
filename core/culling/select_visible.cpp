#include <bit>
#include <cmath>

#include "trimtab/culling/select.h"

namespace trimtab {
namespace {

/// Points with dot(normal, p - eye) >= offset are inside.
struct Plane {
  Vec3 normal;
  double offset;
};

std::array<Plane, 5> frustumPlanes(const EyePose& eye, const ViewShape& view) {
  const Vec3 right = eye.axes.row[0], up = eye.axes.row[1], forward = -eye.axes.row[2];
  const auto side = [](Vec3 normal) { return Plane{normalized(normal), 0}; };
  return {side(right - forward * view.left), side(forward * view.right - right),
          side(up - forward * view.bottom), side(forward * view.top - up), Plane{forward, view.nearM}};
}

void count(VisibleSet& visible, const TileDraw& tile, int sign) {
  // Each border that uses the coarser posts leaves out 16 vertices and folds 16 triangles away.
  const int sides = std::popcount(tile.coarser);
  constexpr int kCells = TerrainIndex::kTileCells;
  visible.triangles += static_cast<std::uint64_t>(sign * (2 * kCells * kCells - sides * kCells / 2));
  visible.vertices += static_cast<std::uint64_t>(sign * ((kCells + 1) * (kCells + 1) - sides * kCells / 2));
}

}  // namespace

void selectVisible(const TerrainIndex& index, const LevelCut& cut, const EyePose& eye, const ViewShape& view,
                   bool test, VisibleSet& visible) {
  visible.tiles.clear();
  visible.reason.assign(index.size(), CullReason::other_level);
  visible.outsideFrustum = visible.occluded = 0;
  visible.triangles = visible.vertices = 0;

  const auto planes = frustumPlanes(eye, view);
  for (const TileDraw& tile : cut.tiles) {
    bool inside = true;
    if (test) {
      const Box& b = index.bounds[tile.node];
      const Vec3 centre = Vec3{0.5 * (double{b.minX} + b.maxX), 0.5 * (double{b.minY} + b.maxY),
                               0.5 * (double{b.minZ} + b.maxZ)} -
                          eye.position;
      const Vec3 half{0.5 * (double{b.maxX} - b.minX), 0.5 * (double{b.maxY} - b.minY),
                      0.5 * (double{b.maxZ} - b.minZ)};
      // Vertices are drawn from floats relative to the eye: wrong by less than 1e-6 of their distance.
      const double margin = 1e-3 + 1e-6 * (std::abs(centre.x) + std::abs(centre.y) + std::abs(centre.z) +
                                           half.x + half.y + half.z);
      for (const Plane& plane : planes) {
        const double reach = half.x * std::abs(plane.normal.x) + half.y * std::abs(plane.normal.y) +
                             half.z * std::abs(plane.normal.z);
        // Said so that a plane that is not a number drops nothing.
        if (dot(plane.normal, centre) + reach < plane.offset - margin) {
          inside = false;
          break;
        }
      }
    }
    if (inside) {
      visible.tiles.push_back(tile);
      visible.reason[tile.node] = CullReason::drawn;
      count(visible, tile, 1);
    } else {
      visible.reason[tile.node] = CullReason::outside_frustum;
      ++visible.outsideFrustum;
    }
  }
}

void removeOccluded(const TerrainIndex&, std::span<const std::uint8_t> flags, VisibleSet& visible) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < visible.tiles.size(); ++i) {
    const TileDraw tile = visible.tiles[i];
    if (i >= flags.size() || flags[i] == 0) {
      visible.tiles[kept++] = tile;
      continue;
    }
    const bool hidden = flags[i] == 1;
    visible.reason[tile.node] = hidden ? CullReason::occluded : CullReason::outside_frustum;
    ++(hidden ? visible.occluded : visible.outsideFrustum);
    count(visible, tile, -1);
  }
  visible.tiles.resize(kept);
}

}  // namespace trimtab
