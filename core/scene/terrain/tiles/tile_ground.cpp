#include "tile_ground.h"
#include "trimtab/terrain/format/object_terrain.h"

#include <algorithm>
#include <cmath>

namespace trimtab::scene {
namespace {

constexpr double kEarthRadius = 6.35e6;
/// Posts from one line that may hide others to the next.
constexpr int kLineStep = 4;

}  // namespace

void makeRelief(const terrain::TileMesh& mesh, TileRelief& relief) {
  relief.side = terrain::TileMesh::kSide;
  relief.origin = {16.0 * mesh.origin[0], 16.0 * mesh.origin[1], 16.0 * mesh.origin[2]};
  const std::size_t count = mesh.vertices.size();
  relief.x.resize(count);
  relief.y.resize(count);
  relief.z.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    relief.x[i] = mesh.vertices[i].x;
    relief.y[i] = mesh.vertices[i].y;
    relief.z[i] = mesh.vertices[i].z;
  }
  relief.finish(kLineStep);
  relief.x = relief.y = relief.z = {};
}

void TileGround::setDatabase(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  conditions_.setDatabase(database_);
  const auto objects = database_ ? database_->objects() : nullptr;
  setObjects(objects ? &objects->index : nullptr);
  relief_.reset(database_ ? database_->index().size() : 0);
  lids_.reset(database_ ? database_->index().size() : 0);
  upright_.clear();
  replacementsStayNear_.clear();
  inCut_.clear();
  if (!database_) return;
  const TerrainIndex& index = database_->index();
  upright_.assign(index.size(), 0);
  replacementsStayNear_.assign(index.size(), 0);
  inCut_.assign(index.size(), 0);
  double lowest = 1e30, highest = -1e30;
  for (const Box& b : index.bounds) {
    lowest = std::min(lowest, double{b.minZ});
    highest = std::max(highest, double{b.maxZ});
  }
  // Heights are along the ellipsoid's verticals, which lean by `lean` from the frame's z. Below a point of
  // the surface there is ground all the way down, unless within as far as z leads astray the surface is
  // steeper than z leans. The index's slopes hold for the neighbouring tiles too; a coarser neighbour's
  // triangle may be 1.42 times steeper than the finer ones in it.
  for (std::uint32_t node = 0; node < index.size(); ++node) {
    const Box& b = index.bounds[node];
    const double away = std::hypot(std::max(std::abs(double{b.minX}), std::abs(double{b.maxX})),
                                   std::max(std::abs(double{b.minY}), std::abs(double{b.maxY})));
    const double lean = away / kEarthRadius;
    const double astray = (highest - lowest) * lean / std::sqrt(std::max(1e-6, 1 - lean * lean));
    const bool gentle = 1.5 * double{index.slopeMax[node]} * lean < 0.5;
    upright_[node] = gentle && astray < 0.5 * std::min(double{b.maxX} - b.minX, double{b.maxY} - b.minY);
    // A tile that ends between two of its posts has diagonals of its own, and an error known at posts alone.
    const TerrainIndex::Level& level = index.levels[index.level[node]];
    const std::uint32_t i = node - level.firstNode;
    const auto isWhole = [&](std::uint32_t place, std::uint32_t posts) {
      return ((std::uint64_t{place} + 1) * TerrainIndex::kTileCells << index.level[node]) < posts;
    };
    replacementsStayNear_[node] = gentle && isWhole(i % level.columns, database_->info().columns) &&
                                  isWhole(i / level.columns, database_->info().rows);
  }
}

std::size_t TileGround::makeSurfaces(Vec3 eye) {
  return share().makeNearest(
      cut_->tiles, database_->index().bounds, eye, [this](TileDraw tile) { return !relief_.find(tile.node); },
      [this](TileDraw tile) {
        database_->buildTile(tile.node, mesh_);
        makeRelief(mesh_, relief_.make(tile.node));
      });
}

void TileGround::fill(std::vector<HorizonTile>& tiles) {
  forgetOthers();
  const TerrainIndex& index = database_->index();
  for (const TileDraw& tile : cut_->tiles) {
    inCut_[tile.node] = 1;
    const TileRelief* relief = relief_.find(tile.node);
    tiles.push_back({.relief = relief, .mayOcclude = relief && mayOcclude(tile.node)});
    if (!relief) tiles.back().mesh = lids_.of(tile.node, index.bounds[tile.node]);
  }
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const auto& [west, east, south, north] = index.neighbours[cut_->tiles[i].node];
    const auto goesOn = [&](std::uint32_t node) -> const TileRelief* {
      return node != TerrainIndex::kNone && inCut_[node] != 0 && mayOcclude(node) ? relief_.find(node)
                                                                                  : nullptr;
    };
    tiles[i].east = goesOn(east);
    tiles[i].north = goesOn(north);
  }
  for (const TileDraw& tile : cut_->tiles) inCut_[tile.node] = 0;
}

}  // namespace trimtab::scene
