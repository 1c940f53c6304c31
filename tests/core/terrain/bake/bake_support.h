#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/format/patch_terrain.h"

/// What tests of baked databases share.
namespace trimtab::terrain {

namespace fs = std::filesystem;

class BakeFixture : public ::testing::Test {
 protected:
  BakeFixture() {
    test::RasterRecipe recipe;
    recipe.columns = 90;
    recipe.rows = 70;
    recipe.value = [](int c, int r, int) { return test::roughGround(c, r); };
    source_ = test::writeRaster(dir_ / "ground.tif", recipe);
    options_.sources = {source_};
    options_.output = dir_ / "db";
  }
  test::ScratchDir dir_;
  fs::path source_;
  BakeOptions options_;
};

/// Uses all of a database, whatever state it is in.
inline void useAll(const Database& database) {
  TileMesh mesh;
  for (std::uint32_t node = 0; node < database.index().size(); ++node) database.buildTile(node, mesh);
  const GeodeticPosition a = database.info().southWest, b = database.info().northEast;
  for (int k = 0; k <= 20; ++k)
    database.heightAt(Degrees{a.latitude.value() + (b.latitude - a.latitude).value() * k / 20},
                      Degrees{a.longitude.value() + (b.longitude - a.longitude).value() * (k * 7 % 20) / 20});
  database.highestWithin(a.latitude, a.longitude, Metres{1e5});
  if (const auto patches = database.patches())
    for (std::uint32_t page = 0; page < patches->index().pages.size(); ++page) {
      const auto read = patches->readPage(page);
      EXPECT_EQ(read.ok(), read.findings().empty());
    }
  if (const auto ground = database.ground())
    for (std::uint32_t level = 0; level < ground->shape().levels.size(); ++level) {
      const auto read = ground->readTile(level, 0, 0);
      EXPECT_EQ(read.ok(), read.findings().empty());
    }
}

}  // namespace trimtab::terrain
