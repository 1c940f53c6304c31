#include "map_culling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "occluder.h"

namespace trimtab::scene {
namespace {

/// Cells per side of a part that is tested as a box.
constexpr int kPartCells = 4;
/// Occluders narrower than this, in texels, are not drawn: they cost as much as others and hide little more.
constexpr double kLeastTexels = 16;

}  // namespace

void makeDepthMesh(const terrain::TileMesh& mesh, float slopeMax, DepthMesh& out) {
  TileOccluder occluder;
  makeOccluder(mesh, slopeMax, occluder);
  out.origin = {16.0 * mesh.origin[0], 16.0 * mesh.origin[1], 16.0 * mesh.origin[2]};
  out.setVertices(occluder.vertices.size());
  for (std::size_t i = 0; i < occluder.vertices.size(); ++i) {
    const OccluderVertex& v = occluder.vertices[i];
    out.setVertex(i, v.x, v.y, v.z, v.slope);
  }
  out.finishVertices();
  out.reach = occluder.limits.reach;
  out.farReach = occluder.limits.farReach;
  out.farSlope = occluder.limits.farSlope;
  out.edge = occluder.limits.edge;

  constexpr int kAcross = TerrainIndex::kTileCells / kPartCells;
  std::array<Box, kAcross * kAcross> parts;
  for (int part = 0; part < kAcross * kAcross; ++part)
    parts[static_cast<std::size_t>(part)] =
        boxOfCells(mesh, part % kAcross * kPartCells, part / kAcross * kPartCells, kPartCells);
  out.setBoxes(parts);
}

std::span<const std::uint8_t> DepthMapCulling::hidden(std::span<const Item> items, const EyePose& eye,
                                                      const MapView& view) {
  fates_.assign(items.size(), static_cast<std::uint8_t>(DepthFate::seen));
  places_.clear();
  const double perM = view.size.widthPx / (view.view.right - view.view.left);
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    const DepthMesh* mesh = items[i].mesh;
    if (!mesh) continue;
    const Vec3 from = eye.position - mesh->origin;
    const auto outside = [](double at, float low, float high) {
      return std::max({double{low} - at, at - double{high}, 0.0});
    };
    const auto& b = mesh->boxes;
    const double distance = std::hypot(outside(from.x, b[0][0], b[3][0]), outside(from.y, b[1][0], b[4][0]),
                                       outside(from.z, b[2][0], b[5][0]));
    places_.push_back({std::isfinite(distance) ? static_cast<float>(distance) : 0.0f, i});
  }
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.item < b.item;
  });
  map_.begin(eye, view.view, {view.size.widthPx, view.size.heightPx, view.lowering});
  for (const Place& place : places_) {
    const Item& item = items[place.item];
    const double across = double{item.mesh->boxes[3][0]} - double{item.mesh->boxes[0][0]};
    if (item.mayOcclude && !(across * perM < kLeastTexels * double{place.distance}))
      fates_[place.item] = static_cast<std::uint8_t>(map_.draw(*item.mesh, *item.triangles));
  }
  map_.finish();
  nearM_ = view.view.nearM;
  for (const Place& place : places_)
    if (fates_[place.item] == static_cast<std::uint8_t>(DepthFate::seen))
      fates_[place.item] = static_cast<std::uint8_t>(map_.test(*items[place.item].mesh));
  return fates_;
}

DistanceImage DepthMapCulling::picture() const {
  const DepthPyramid& pyramid = map_.pyramid();
  return distanceImage(pyramid.depths(), pyramid.width(), pyramid.height(), nearM_);
}

void MapCulling::setDatabase(std::shared_ptr<const terrain::Database> database) {
  database_ = std::move(database);
  meshes_.reset(database_ ? database_->index().size() : 0);
}

void MapCulling::make(std::uint32_t node) {
  database_->buildTile(node, mesh_);
  makeDepthMesh(mesh_, database_->index().slopeMax[node], meshes_.make(node));
}

std::span<const std::uint8_t> MapCulling::hidden(const LevelCut& cut, std::span<const TileDraw> visible,
                                                 const EyePose& eye, const MapView& view,
                                                 const OcclusionConditions& conditions, SurfaceShare& share) {
  meshes_.forgetOthers(cut);
  share.makeNearest(
      visible, database_->index().bounds, eye.position,
      [this](TileDraw tile) { return !meshes_.find(tile.node); }, [this](TileDraw tile) { make(tile.node); });
  static const depth::Triangles kTriangles(makeOccluderIndices());
  items_.clear();
  for (const TileDraw& tile : visible)
    items_.push_back({meshes_.find(tile.node), &kTriangles, conditions.mayOcclude(tile.node)});
  return culling_.hidden(items_, eye, view);
}

}  // namespace trimtab::scene
