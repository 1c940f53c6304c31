#include "trimtab/scene/occlusion_conditions.h"

#include <algorithm>
#include <cmath>

namespace trimtab::scene {
namespace {

/// Height of the mesh's triangle over (x, y), metres from the tile's origin; none beside the tile.
std::optional<double> heightOver(const terrain::TileMesh& mesh, std::span<const std::uint16_t> indices,
                                 double x, double y) {
  std::optional<double> highest;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const terrain::TileVertex &a = mesh.vertices[indices[i]], &b = mesh.vertices[indices[i + 1]],
                              &c = mesh.vertices[indices[i + 2]];
    const auto area = [](double px, double py, double qx, double qy) { return px * qy - py * qx; };
    const double whole = area(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
    if (whole <= 0) continue;
    const double v = area(x - a.x, y - a.y, c.x - a.x, c.y - a.y) / whole;
    const double w = area(b.x - a.x, b.y - a.y, x - a.x, y - a.y) / whole;
    constexpr double kEdge = -1e-6;
    if (v < kEdge || w < kEdge || 1 - v - w < kEdge) continue;
    const double z = a.z + v * (b.z - a.z) + w * (c.z - a.z);
    highest = std::max(highest.value_or(z), z);
  }
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
    // Half a tile is how far from its own place an occluder's texel may look (OccluderLimits::farReach). One
    // more tile to the east and north, where the last one may be empty but for a column of posts.
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
    const TileIndices::Range range = indices_.variant[tile.coarser];
    const auto height = heightOver(mesh_, std::span(indices_.indices).subspan(range.first, range.count),
                                   eye.x - 16.0 * mesh_.origin[0], eye.y - 16.0 * mesh_.origin[1]);
    if (!height) return {};
    return Ground{tile.node, *height + 16.0 * mesh_.origin[2]};
  };
  // Mostly it still is the tile of the last frame, whose mesh is at hand.
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
  if (!ground) return "no tile is under the eye";
  const double slope = 1.5 * index.slopeMax[ground->node] + leanOf(eye.position) + 0.1;
  return nearPlaneRefusal(eye.position.z - ground->height, nearestOf(view), slope);
}

}  // namespace trimtab::scene
