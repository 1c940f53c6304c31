#include "patch_ground.h"
#include "trimtab/terrain/format/object_terrain.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/scene/surface/triangle_height.h"

namespace trimtab::scene {
namespace {

/// Lines to a side of a patch's square: as many hide nearly all that more would.
constexpr int kLinesASide = 8;
/// Patches so near in plan share the ground under the near plane, metres.
constexpr float kBesideM = 20;
/// MeshRelief treats a triangle as upright if the z of its normal is less than this.
constexpr double kLeastRise = 1 / MeshRelief::kSteepest;

bool isOver(const Box& b, float x, float y, float beside = 0) {
  return x >= b.minX - beside && x <= b.maxX + beside && y >= b.minY - beside && y <= b.maxY + beside;
}

/// Reports whether heights that differ along the earth's verticals differ by at most half as much again along
/// the frame's, where it is nowhere steeper than that. Bounds: metres from the origin.
bool isGentle(const Box& b, Vec3 origin, double steepest) {
  double lean = 0;
  for (const float x : {b.minX, b.maxX})
    for (const float y : {b.minY, b.maxY}) lean = std::max(lean, leanOf(origin + Vec3{x, y, 0}));
  return 1.5 * steepest * lean < 0.5;
}

/// z of the surface over a place, from the relief's origin; none beside it.
std::optional<double> heightOfRelief(const MeshRelief& relief, double x, double y) {
  struct Corner {
    float x, y, z;
  };
  std::optional<double> highest;
  for (const MeshRelief::Part& part : relief.parts) {
    if (!isOver(part.box, static_cast<float>(x), static_cast<float>(y), 0.01f)) continue;
    for (std::size_t i = 0; i < part.triangles; ++i) {
      const auto corner = [&](std::size_t k) {
        const std::size_t v = part.firstVertex + relief.corners[part.firstCorner + 3 * i + k];
        return Corner{relief.x[v], relief.y[v], relief.z[v]};
      };
      if (const auto z = heightOver(corner(0), corner(1), corner(2), x, y))
        highest = std::max(highest.value_or(*z), *z);
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

void PatchGround::setTerrain(std::shared_ptr<const terrain::Database> database) {
  const bool any = database && database->patches();
  under_.clear();
  graphOf_.reset();
  const std::size_t patches = any ? database->patches()->index().size() : 0;
  inside_.assign(patches, 0);
  normalsRise_.assign(patches, 0);
  surfaces_.reset(patches);
  lids_.reset(patches);
  const auto objects = database ? database->objects() : nullptr;
  setObjects(objects ? &objects->index : nullptr);
  const std::size_t variants = any ? database->patches()->index().variants() : 1;
  surfaceErrorM_ = VariantTable<float>(variants);
  if (!any) return;
  for (const terrain::PatchFacts& facts : database->patches()->facts())
    surfaceErrorM_.push_back(std::span(facts.bilinearErrorM).first(variants));
  const terrain::TerrainInfo& info = database->info();
  extent_ = DataExtent(info);
  posts_ = postsOf(info);
  const auto margin = [this](double postM) {
    return static_cast<std::uint32_t>(std::min(1e9, std::ceil(extent_.sagM() / std::max(postM, 1e-3)) + 1));
  };
  marginColumns_ = margin(info.postLongitude.value() * extent_.metresPerDegreeEast());
  marginRows_ = margin(info.postLatitude.value() * extent_.metresPerDegreeNorth());
}

void PatchGround::make(const terrain::PatchMesh& mesh, TileDraw patch, Surface& surface) {
  surface.variant = patch.variant.number;
  makeRelief(mesh, patch.variant.number, vertices_, surface.relief);
  // Errors are along the ellipsoid's verticals: what is so far above or below this surface along one that
  // leans is half as much again along z at most, if the surface rises no more than that beside it.
  surface.replacementsStayNear =
      isGentle(surface.relief.bounds, surface.relief.origin, surface.relief.steepest);
  const PatchIndex& index = patches_.index();
  surface.inside = std::all_of(vertices_.begin(), vertices_.end(), [&](const ReliefVertex& v) {
    const std::uint32_t column = mesh.firstColumn + v.column, row = mesh.firstRow + v.row;
    return column >= marginColumns_ && row >= marginRows_ && column + marginColumns_ < index.columns &&
           row + marginRows_ < index.rows;
  });
}

const PatchGround::Surface* PatchGround::surfaceOf(TileDraw patch) const {
  const Surface* kept = surfaces_.find(patch.node);
  return kept && kept->variant == patch.variant.number ? kept : nullptr;
}

std::size_t PatchGround::makeSurfaces(Vec3 eye) {
  const auto misses = [this](TileDraw patch) { return !surfaceOf(patch) && patches_.meshOf(patch.node); };
  const auto makeNearest = [&](const auto& which) {
    return share().makeNearest(cut().tiles, patches_.index().bounds, eye, which, [this](TileDraw patch) {
      make(*patches_.meshOf(patch.node), patch, surfaces_.make(patch.node));
    });
  };
  // While one may hang over, none hides anything: so surfaces that alone can show it are made first.
  makeNearest([&](TileDraw patch) { return !normalsRise(patch.node) && misses(patch); });
  return makeNearest(misses);
}

const PatchGround::Surface* PatchGround::surfaceUnder(TileDraw patch) {
  if (const Surface* kept = surfaceOf(patch)) return kept;
  for (const Under& under : under_)
    if (under.node == patch.node && under.surface->variant == patch.variant.number)
      return under.surface.get();
  const terrain::PatchMesh* mesh = patches_.meshOf(patch.node);
  if (!mesh) return nullptr;
  constexpr std::size_t kMost = 64;
  if (under_.size() >= kMost) under_.erase(under_.begin());
  under_.push_back({patch.node, std::make_unique<Surface>()});
  make(*mesh, patch, *under_.back().surface);
  return under_.back().surface.get();
}

std::string PatchGround::refusal(const EyePose& eye, const ViewShape& view) {
  const PatchIndex& index = patches_.index();
  if (const char* why = extent_.refusal(index.frame, eye.position); *why != 0) return why;
  const auto x = static_cast<float>(eye.position.x), y = static_cast<float>(eye.position.y);
  std::optional<double> ground;
  float steepest = 0;
  for (const TileDraw& patch : patches_.cut().tiles) {
    if (!isOver(index.bounds[patch.node], x, y, kBesideM)) continue;
    const Surface* surface = surfaceUnder(patch);
    if (!surface) continue;
    const Vec3 in = eye.position - surface->relief.origin;
    if (const auto height = heightOfRelief(surface->relief, in.x, in.y))
      ground = std::max(ground.value_or(-1e30), *height + surface->relief.origin.z);
    steepest = std::max(steepest, surface->relief.steepest);
  }
  if (!ground) return "No patch is under the eye.";
  if (!(nearestOf(view) < kBesideM)) return "The near plane is too far from the eye.";
  return nearPlaneRefusal(eye.position.z - *ground, nearestOf(view), steepest);
}

void PatchGround::fill(std::vector<HorizonTile>& tiles) {
  forgetOthers();
  for (const TileDraw& patch : cut().tiles) {
    const Surface* surface = surfaceOf(patch);
    tiles.push_back({.mayOcclude = surface && surface->inside, .mesh = surface ? &surface->relief : nullptr});
    // A lid beside another variant's surface would be judged by that surface (replacementsStayNear), so there
    // is none.
    if (!surfaces_.find(patch.node))
      tiles.back().mesh = lids_.of(patch.node, patches_.index().bounds[patch.node]);
  }
}

/// A patch without a surface is judged by the cone of its normals.
bool PatchGround::replacementsStayNear(std::uint32_t node) const {
  if (const Surface* surface = surfaces_.find(node)) return surface->replacementsStayNear;
  const PatchIndex& index = patches_.index();
  if (normalsRise_[node] != 2) return false;
  const double steepest = std::acos(index.cones[node].axis().z) + std::asin(index.cones[node].sine());
  return isGentle(index.bounds[node], {}, std::tan(steepest));
}

bool PatchGround::normalsRise(std::uint32_t node) {
  std::uint8_t& known = normalsRise_[node];
  if (known == 0) {
    const std::vector<NormalCone>& cones = patches_.index().cones;
    const NormalCone cone = cones.empty() ? NormalCone{} : cones[node];
    known = cone.isKnown() && cone.axis().z > cone.sine() + kLeastRise ? 2 : 1;
  }
  return known == 2;
}

/// Where a single patch stands upright or hangs over, a place may have two heights; where one is missing, it
/// has none.
bool PatchGround::isGraph() {
  if (graphOf_ == cutNumber().cut) return true;
  const bool graph = std::all_of(cut().tiles.begin(), cut().tiles.end(), [this](const TileDraw& patch) {
    if (normalsRise(patch.node)) return patches_.meshOf(patch.node) != nullptr;
    const Surface* surface = surfaceOf(patch);
    return surface && surface->relief.upright;
  });
  if (graph) graphOf_ = cutNumber().cut;
  return graph;
}

/// The boxes of the node and of all nodes below it decide.
bool PatchGround::mayOcclude(std::uint32_t node) {
  std::uint8_t& known = inside_[node];
  if (known == 0) {
    const PatchIndex& index = patches_.index();
    const Box& b = index.bounds[node];
    known = 2;
    for (int corner = 0; corner < 8; ++corner) {
      const GeodeticPosition place =
          index.frame.toGeodetic({(corner & 1) != 0 ? b.maxX : b.minX, (corner & 2) != 0 ? b.maxY : b.minY,
                                  (corner & 4) != 0 ? b.maxZ : b.minZ});
      const double column = posts_.columnOf(place.longitude.value()),
                   row = posts_.rowOf(place.latitude.value());
      // One more for the bulge of a meridian or parallel within the box.
      const double besideColumns = marginColumns_ + 1.0, besideRows = marginRows_ + 1.0;
      if (!(column >= besideColumns && row >= besideRows && column + besideColumns < index.columns &&
            row + besideRows < index.rows))
        known = 1;
    }
  }
  return known == 2;
}

}  // namespace trimtab::scene
