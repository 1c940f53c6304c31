#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "synthetic_terrain.h"
#include "tests/core/terrain/ground/build_and_open.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/ground/build.h"
#include "trimtab/terrain/patches/build.h"

/// A terrain of error-bounded patches, all in memory, with tiles of the same posts or without.
namespace trimtab::test {

class PatchedTerrain final : public terrain::Database {
 public:
  /// `tiles`: what is drawn of it in the form of levels; null: nothing.
  explicit PatchedTerrain(terrain::HeightGrid grid, std::shared_ptr<const terrain::Database> tiles = {},
                          bool ground = true)
      : grid_(std::move(grid)), tiles_(std::move(tiles)) {
    const terrain::GridHeights heights(grid_);
    patches_ = terrain::buildPatches(heights, terrain::defaultLeafToleranceM(grid_.posts));
    none_.frame = patches_->index().frame;
    const terrain::PostGrid& p = grid_.posts;
    info_.name = "patched";
    info_.southWest = {Degrees{p.south}, Degrees{p.west}, Metres{0}};
    info_.northEast = {Degrees{p.latitude(p.rows - 1)}, Degrees{p.longitude(p.columns - 1)}, Metres{0}};
    const auto [low, high] = std::minmax_element(grid_.heights.begin(), grid_.heights.end());
    info_.lowest = Metres{double{*low}}, info_.highest = Metres{double{*high}};
    info_.columns = p.columns;
    info_.rows = p.rows;
    info_.postLatitude = Degrees{p.stepLatitude};
    info_.postLongitude = Degrees{p.stepLongitude};
    if (!ground) return;
    const terrain::PostGeometry geometry(p);
    terrain::GroundSources sources;
    sources.heights = &heights;
    sources.geometry = &geometry;
    ground_ = buildAndOpenGround(sources).value();
  }

  /// The same with other patches in place of its own.
  void replace(std::shared_ptr<const terrain::PatchTerrain> patches) { patches_ = std::move(patches); }

  const terrain::TerrainInfo& info() const override { return info_; }
  const TerrainIndex& index() const override { return tiles_ ? tiles_->index() : none_; }
  void buildTile(std::uint32_t node, terrain::TileMesh& mesh) const override {
    tiles_->buildTile(node, mesh);
  }
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    const auto height = heightAtPost((longitude.value() - grid_.posts.west) / grid_.posts.stepLongitude,
                                     (latitude.value() - grid_.posts.south) / grid_.posts.stepLatitude);
    if (!height) return {};
    return Metres{*height};
  }
  std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres) const override {
    if (!heightAt(latitude, longitude)) return {};
    return Metres{double{*std::max_element(grid_.heights.begin(), grid_.heights.end())}};
  }
  std::shared_ptr<const terrain::PatchTerrain> patches() const override { return patches_; }
  std::shared_ptr<const terrain::GroundPyramid> ground() const override { return ground_; }

  /// Bilinear; none beside the posts.
  std::optional<double> heightAtPost(double column, double row) const {
    const terrain::PostGrid& p = grid_.posts;
    if (!(column >= 0 && row >= 0 && column <= p.columns - 1 && row <= p.rows - 1)) return {};
    const auto c = std::min(static_cast<std::uint32_t>(column), p.columns - 2),
               r = std::min(static_cast<std::uint32_t>(row), p.rows - 2);
    const double u = column - c, v = row - r;
    const float* south = &grid_.heights[std::size_t{r} * p.columns + c];
    const float* north = south + p.columns;
    return (1 - v) * ((1 - u) * south[0] + u * south[1]) + v * ((1 - u) * north[0] + u * north[1]);
  }
  const terrain::HeightGrid& grid() const { return grid_; }

 private:
  terrain::HeightGrid grid_;
  std::shared_ptr<const terrain::Database> tiles_;
  std::shared_ptr<const terrain::PatchTerrain> patches_;
  std::shared_ptr<const terrain::GroundPyramid> ground_;
  TerrainIndex none_;
  terrain::TerrainInfo info_;
};

/// syntheticMountains in scene_test.h, with patches of its posts: 46 km a side.
inline std::shared_ptr<const PatchedTerrain> patchedMountains(bool tiles) {
  static const auto make = [](bool withTiles) {
    constexpr int kPosts = 16 * TerrainIndex::kTileCells + 1;
    terrain::HeightGrid grid;
    grid.posts = {128.1, 36.4, 1.0 / 1200, 1.0 / 1200, kPosts, kPosts};
    for (int row = 0; row < kPosts; ++row)
      for (int column = 0; column < kPosts; ++column)
        grid.heights.push_back(static_cast<float>(mountains(column, row)));
    std::shared_ptr<const terrain::Database> under;
    if (withTiles)
      under = std::make_shared<const SyntheticTerrain>(
          16, 1.0 / 1200, GeodeticPosition{Degrees{36.4}, Degrees{128.1}, Metres{0}}, mountains);
    return std::make_shared<const PatchedTerrain>(std::move(grid), under);
  };
  static const auto with = make(true), without = make(false);
  return tiles ? with : without;
}

}  // namespace trimtab::test
