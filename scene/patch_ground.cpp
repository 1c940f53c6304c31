#include "trimtab/scene/patch_horizon.h"

#include <algorithm>
#include <cmath>

namespace trimtab::scene {
namespace {

/// Lines to a side of a patch's square: as many hide nearly all that more would.
constexpr int kLinesASide = 8;
/// Surfaces (some 10 KB each) that are kept beyond those of the cut.
constexpr std::size_t kKept = 4096;
/// Patches so near in plan share the ground under the near plane, metres.
constexpr float kBesideM = 20;

bool isOver(const Box& b, float x, float y, float beside = 0) {
  return x >= b.minX - beside && x <= b.maxX + beside && y >= b.minY - beside && y <= b.maxY + beside;
}

/// z of the surface over a place, from the relief's origin; none beside it.
std::optional<double> heightOver(const MeshRelief& relief, double x, double y) {
  std::optional<double> highest;
  for (const MeshRelief::Part& part : relief.parts) {
    if (!isOver(part.box, static_cast<float>(x), static_cast<float>(y), 0.01f)) continue;
    for (std::size_t i = 0; i < part.triangles; ++i) {
      const std::uint8_t* corner = &relief.corners[part.firstCorner + 3 * i];
      const std::size_t a = part.firstVertex + corner[0], b = part.firstVertex + corner[1],
                        c = part.firstVertex + corner[2];
      const auto area = [](double px, double py, double qx, double qy) { return px * qy - py * qx; };
      const double bx = double{relief.x[b]} - relief.x[a], by = double{relief.y[b]} - relief.y[a],
                   cx = double{relief.x[c]} - relief.x[a], cy = double{relief.y[c]} - relief.y[a];
      const double whole = area(bx, by, cx, cy);
      if (whole <= 0) continue;
      const double v = area(x - relief.x[a], y - relief.y[a], cx, cy) / whole,
                   w = area(bx, by, x - relief.x[a], y - relief.y[a]) / whole;
      constexpr double kEdge = -1e-6;
      if (v < kEdge || w < kEdge || 1 - v - w < kEdge) continue;
      const double z =
          relief.z[a] + v * (double{relief.z[b]} - relief.z[a]) + w * (double{relief.z[c]} - relief.z[a]);
      highest = std::max(highest.value_or(z), z);
    }
  }
  return highest;
}

}  // namespace

void makeRelief(const terrain::PatchMesh& mesh, int variant, std::vector<ReliefVertex>& vertices,
                MeshRelief& relief) {
  vertices.clear();
  int low = 0xffff, high = 0;
  for (const terrain::PatchVertex& v : mesh.vertices) {
    vertices.push_back({v.x, v.y, v.z, v.column, v.row});
    low = std::min({low, int{v.column}, int{v.row}});
    high = std::max({high, int{v.column}, int{v.row}});
  }
  const auto first = mesh.firstIndex[static_cast<std::size_t>(variant)],
             end = mesh.firstIndex[static_cast<std::size_t>(variant) + 1];
  makeMeshRelief(vertices, std::span(mesh.indices).subspan(first, end - first),
                 {16.0 * mesh.origin[0], 16.0 * mesh.origin[1], 16.0 * mesh.origin[2]},
                 std::max(1, (high - low) / kLinesASide), relief);
}

void PatchHorizon::setTerrain(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  memory_.clear();
  surfaces_.clear();
  kept_ = 0;
  if (!database_ || !database_->patches()) return;
  surfaces_.resize(database_->patches()->index().size());
  const terrain::TerrainInfo& info = database_->info();
  extent_ = DataExtent(info);
  const auto margin = [this](double postM) {
    return static_cast<std::uint32_t>(std::min(1e9, std::ceil(extent_.sagM() / std::max(postM, 1e-3)) + 1));
  };
  marginColumns_ = margin(info.postLongitude.value() * extent_.metresPerDegreeEast());
  marginRows_ = margin(info.postLatitude.value() * extent_.metresPerDegreeNorth());
}

const PatchHorizon::Surface* PatchHorizon::surfaceOf(const PatchCulling& patches, TileDraw patch) {
  std::unique_ptr<Surface>& kept = surfaces_[patch.node];
  if (kept && kept->variant == patch.coarser) return kept.get();
  const terrain::PatchMesh* mesh = patches.meshOf(patch.node);
  if (!mesh) return nullptr;
  if (!kept) {
    kept = std::make_unique<Surface>();
    ++kept_;
  }
  kept->variant = patch.coarser;
  makeRelief(*mesh, patch.coarser, vertices_, kept->relief);
  ++reliefs_;
  const PatchIndex& index = patches.index();
  kept->inside = true;
  for (const ReliefVertex& v : vertices_) {
    const std::uint32_t column = mesh->firstColumn + v.column, row = mesh->firstRow + v.row;
    kept->inside = kept->inside && column >= marginColumns_ && row >= marginRows_ &&
                   column + marginColumns_ < index.columns && row + marginRows_ < index.rows;
  }
  return kept.get();
}

std::string PatchHorizon::refusal(const PatchCulling& patches, const EyePose& eye, const ViewShape& view) {
  const PatchIndex& index = patches.index();
  if (const char* why = extent_.refusal(index.frame, eye.position); *why != 0) return why;
  const auto x = static_cast<float>(eye.position.x), y = static_cast<float>(eye.position.y);
  std::optional<double> ground;
  float steepest = 0;
  for (const TileDraw& patch : patches.cut().tiles) {
    if (!isOver(index.bounds[patch.node], x, y, kBesideM)) continue;
    const Surface* surface = surfaceOf(patches, patch);
    if (!surface) continue;
    const Vec3 in = eye.position - surface->relief.origin;
    if (const auto height = heightOver(surface->relief, in.x, in.y))
      ground = std::max(ground.value_or(-1e30), *height + surface->relief.origin.z);
    steepest = std::max(steepest, surface->relief.steepest);
  }
  if (!ground) return "no patch is under the eye";
  if (!(nearestOf(view) < kBesideM)) return "the near plane is too far from the eye";
  return nearPlaneRefusal(eye.position.z - *ground, nearestOf(view), steepest);
}

void PatchHorizon::forgetOthers(const LevelCut& cut) {
  std::vector<std::uint8_t> used(surfaces_.size());
  for (const TileDraw& patch : cut.tiles) used[patch.node] = 1;
  for (std::size_t patch = 0; patch < surfaces_.size(); ++patch)
    if (surfaces_[patch] && used[patch] == 0) {
      surfaces_[patch].reset();
      --kept_;
    }
}

void PatchHorizon::fill(const PatchCulling& patches, std::vector<HorizonTile>& tiles) {
  const LevelCut& cut = patches.cut();
  if (kept_ > kKept + cut.tiles.size()) forgetOthers(cut);
  // Where a single patch stands upright or hangs over, a place may have two heights.
  bool graph = true;
  for (const TileDraw& patch : cut.tiles) {
    const Surface* surface = surfaceOf(patches, patch);
    graph = graph && surface && surface->relief.upright;
    tiles.push_back({.mayOcclude = surface && surface->inside, .mesh = surface ? &surface->relief : nullptr});
  }
  if (!graph)
    for (HorizonTile& tile : tiles) tile.mayOcclude = false;
}

std::span<const std::uint8_t> PatchHorizon::hidden(const PatchCulling& patches,
                                                   const HorizonMemory::CutNumber& number, Vec3 eye,
                                                   const Horizon::Settings& settings, const Skips& skips) {
  return memory_.hidden(eye, number, settings, skips,
                        [&](std::vector<HorizonTile>& tiles) { fill(patches, tiles); });
}

}  // namespace trimtab::scene
