#include "trimtab/scene/horizon_culling.h"

#include <algorithm>
#include <cmath>

namespace trimtab::scene {
namespace {

constexpr double kEarthRadius = 6.35e6;
/// Posts from one line that may hide others to the next.
constexpr int kLineStep = 4;
/// Tiles (25 KB each) that are kept beyond those of the cut.
constexpr std::size_t kKept = 4096;

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
}

void HorizonCulling::setDatabase(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  memory_.clear();
  relief_.clear();
  upright_.clear();
  kept_ = 0;
  if (!database_) return;
  const TerrainIndex& index = database_->index();
  relief_.resize(index.size());
  upright_.assign(index.size(), 0);
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
    upright_[node] = 1.5 * double{index.slopeMax[node]} * lean < 0.5 &&
                     astray < 0.5 * std::min(double{b.maxX} - b.minX, double{b.maxY} - b.minY);
  }
}

const TileRelief* HorizonCulling::reliefOf(std::uint32_t node) {
  if (!relief_[node]) {
    relief_[node] = std::make_unique<TileRelief>();
    database_->buildTile(node, mesh_);
    makeRelief(mesh_, *relief_[node]);
    ++reliefs_;
    ++kept_;
  }
  return relief_[node].get();
}

void HorizonCulling::forgetOthers(const LevelCut& cut) {
  std::vector<std::uint8_t> used(relief_.size());
  for (const TileDraw& tile : cut.tiles) used[tile.node] = 1;
  for (std::size_t node = 0; node < relief_.size(); ++node)
    if (relief_[node] && !used[node]) {
      relief_[node].reset();
      --kept_;
    }
}

void HorizonCulling::fill(const LevelCut& cut, const OcclusionConditions& conditions,
                          std::vector<HorizonTile>& tiles) {
  if (kept_ > kKept + cut.tiles.size()) forgetOthers(cut);
  const TerrainIndex& index = database_->index();
  inCut_.assign(index.size(), 0);
  for (const TileDraw& tile : cut.tiles) {
    inCut_[tile.node] = 1;
    tiles.push_back({.relief = reliefOf(tile.node), .mayOcclude = mayOcclude(tile.node, conditions)});
  }
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const auto& [west, east, south, north] = index.neighbours[cut.tiles[i].node];
    const auto goesOn = [&](std::uint32_t node) -> const TileRelief* {
      return node != TerrainIndex::kNone && inCut_[node] != 0 && mayOcclude(node, conditions)
                 ? relief_[node].get()
                 : nullptr;
    };
    tiles[i].east = goesOn(east);
    tiles[i].north = goesOn(north);
  }
}

std::span<const std::uint8_t> HorizonCulling::hidden(const LevelCut& cut, const CutNumber& number, Vec3 eye,
                                                     const Horizon::Settings& settings,
                                                     const OcclusionConditions& conditions,
                                                     const Skips& skips) {
  return memory_.hidden(eye, number, settings, skips,
                        [&](std::vector<HorizonTile>& tiles) { fill(cut, conditions, tiles); });
}

}  // namespace trimtab::scene
