#include "occlusion_conditions.h"

#include <algorithm>
#include <cmath>

#include "core/scene/surface/triangle_height.h"

namespace trimtab::scene {
namespace {

/// Returns the height of the mesh over (x, y), metres from the tile's origin; unset if (x, y) is beside the
/// tile.
std::optional<double> heightOfMesh(const terrain::TileMesh& mesh, std::span<const std::uint16_t> indices,
                                   double x, double y) {
  std::optional<double> highest;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    if (const auto z = heightOver(mesh.vertices[indices[i]], mesh.vertices[indices[i + 1]],
                                  mesh.vertices[indices[i + 2]], x, y))
      highest = std::max(highest.value_or(*z), *z);
  return highest;
}

}  // namespace

void OcclusionConditions::setDatabase(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  meshNode_ = TerrainIndex::kNone;
  mayOcclude_.clear();
  if (!database_) return;
  const terrain::TerrainInfo& info = database_->info();
  extent_ = DataExtent(info);
  const TerrainIndex& index = database_->index();
  mayOcclude_.assign(index.size(), 0);
  for (std::size_t level = 0; level < index.levels.size(); ++level) {
    const TerrainIndex::Level& l = index.levels[level];
    const double tileM = TerrainIndex::kTileCells * std::ldexp(1.0, static_cast<int>(level)) *
                         std::min(info.postLatitude.value() * extent_.metresPerDegreeNorth(),
                                  info.postLongitude.value() * extent_.metresPerDegreeEast());
    // An occluder's texel may look half a tile beyond its own place (OccluderLimits::farReach). To the east
    // and north one more tile is left out, because the last one may hold only a single column of posts.
    const double border = std::ceil(extent_.sagM() / tileM + 0.5);
    for (std::uint32_t row = 0; row < l.rows; ++row)
      for (std::uint32_t column = 0; column < l.columns; ++column) {
        const auto inside = [border](std::uint32_t i, std::uint32_t n) {
          return i >= border && i + 1 + border < n;
        };
        mayOcclude_[l.firstNode + row * l.columns + column] =
            inside(row, l.rows) && inside(column, l.columns);
      }
  }
}

std::optional<OcclusionConditions::Ground> OcclusionConditions::groundUnder(const LevelCut& cut, Vec3 eye) {
  const auto under = [&](const TileDraw& tile) -> std::optional<Ground> {
    const Box& box = database_->index().bounds[tile.node];
    if (!(eye.x >= box.minX && eye.x <= box.maxX && eye.y >= box.minY && eye.y <= box.maxY)) return {};
    if (meshNode_ != tile.node) {
      database_->buildTile(tile.node, mesh_);
      meshNode_ = tile.node;
    }
    const TileIndices::Range range = indices_.variant[tile.border.bits];
    const auto height = heightOfMesh(mesh_, std::span(indices_.indices).subspan(range.first, range.count),
                                     eye.x - 16.0 * mesh_.origin[0], eye.y - 16.0 * mesh_.origin[1]);
    if (!height) return {};
    return Ground{tile.node, *height + 16.0 * mesh_.origin[2]};
  };
  // Mostly the eye is still over the tile of the last frame, whose mesh is kept.
  const auto last = std::find_if(cut.tiles.begin(), cut.tiles.end(),
                                 [this](const TileDraw& t) { return t.node == meshNode_; });
  if (last != cut.tiles.end())
    if (const auto ground = under(*last)) return ground;
  for (const TileDraw& tile : cut.tiles)
    if (const auto ground = under(tile)) return ground;
  return {};
}

std::string OcclusionConditions::refusal(const LevelCut& cut, const EyePose& eye, const ViewShape& view) {
  const TerrainIndex& index = database_->index();
  if (const char* why = extent_.refusal(index.frame, eye.position); *why != 0) return why;
  const std::optional<Ground> ground = groundUnder(cut, eye.position);
  if (!ground) return "No tile is under the eye.";
  const double slope = 1.5 * index.slopeMax[ground->node] + leanOf(eye.position) + 0.1;
  return nearPlaneRefusal(eye.position.z - ground->height, nearestOf(view), slope);
}

}  // namespace trimtab::scene
