#include "trimtab/scene/horizon_culling.h"

#include <algorithm>
#include <cmath>

namespace trimtab::scene {
namespace {

constexpr double kEarthRadius = 6.35e6;
/// Posts from one line that may hide others to the next.
constexpr int kLineStep = 4;
/// A horizon that hides less than one tile in so many is not built again until the eye is this far away.
constexpr std::size_t kLeastShare = 50;
constexpr double kBelievedM = 50;
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
  key_.reset();
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

int HorizonCulling::columnsFor(int depthMapWidthPx) {
  return std::clamp(2 * depthMapWidthPx, Horizon::kLeastColumns, Horizon::kMostColumns);
}

double HorizonCulling::slackOf(const ViewShape& view, int subpixelBits) {
  // Five steps of a pixel that has 256 of them, which leaves room for rounding; in coarser ones as many.
  const double pixels = 0.02 * std::max(1.0, std::ldexp(1.0, 8 - subpixelBits));
  return pixels * std::max((view.right - view.left) / view.widthPx, (view.top - view.bottom) / view.heightPx);
}

Renderer::Grey HorizonCulling::picture(const EyePose& eye, const ViewShape& view, int widthPx,
                                       int heightPx) const {
  constexpr std::uint8_t kCovered = 110, kOpen = 255;
  Renderer::Grey grey{widthPx, heightPx, {}};
  grey.pixels.reserve(static_cast<std::size_t>(widthPx) * static_cast<std::size_t>(heightPx));
  const Mat3 toLocal = transposed(eye.axes);
  for (int y = 0; y < heightPx; ++y)
    for (int x = 0; x < widthPx; ++x) {
      const double across = view.left + (view.right - view.left) * (x + 0.5) / widthPx,
                   up = view.bottom + (view.top - view.bottom) * (y + 0.5) / heightPx;
      grey.pixels.push_back(horizon_.blocks(toLocal * Vec3{across, up, -1}) ? kCovered : kOpen);
    }
  return grey;
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

/// Where next to nothing is hidden there is nothing to gain a little further on.
bool HorizonCulling::hidLittleNear(const Key& key) const {
  return key_ && key_->cut.rule == key.cut.rule && key_->columns == key.columns &&
         key_->raised == key.raised && horizon_.hiddenCount() * kLeastShare < tiles_.size() &&
         length(key.eye - key_->eye) < kBelievedM;
}

std::span<const std::uint8_t> HorizonCulling::hidden(const LevelCut& cut, const CutNumber& number, Vec3 eye,
                                                     const Horizon::Settings& settings,
                                                     const OcclusionConditions& conditions,
                                                     const Skips& skips) {
  const Key key{eye, number, settings.columns, settings.slack, settings.raised};
  if (key_ == key) {
    if (skips.sameHorizon) return horizon_.hidden();
  } else if (skips.littleHidden && hidLittleNear(key)) {
    ++leftOut_;
    return {};
  }
  if (kept_ > kKept + cut.tiles.size()) forgetOthers(cut);
  const TerrainIndex& index = database_->index();
  tiles_.clear();
  inCut_.assign(index.size(), 0);
  for (const TileDraw& tile : cut.tiles) {
    inCut_[tile.node] = 1;
    tiles_.push_back({reliefOf(tile.node), mayOcclude(tile.node, conditions)});
  }
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const auto& [west, east, south, north] = index.neighbours[cut.tiles[i].node];
    const auto goesOn = [&](std::uint32_t node) -> const TileRelief* {
      return node != TerrainIndex::kNone && inCut_[node] != 0 && mayOcclude(node, conditions)
                 ? relief_[node].get()
                 : nullptr;
    };
    tiles_[i].east = goesOn(east);
    tiles_[i].north = goesOn(north);
  }
  horizon_.build(eye, tiles_, settings);
  ++built_;
  key_ = key;
  return horizon_.hidden();
}

}  // namespace trimtab::scene
