#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/LocalCartesian.hpp>

#include <cmath>
#include <optional>

#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::terrain {
namespace {

class MadeDatabase : public ::testing::Test {
 protected:
  std::shared_ptr<const Database> make(const test::RasterRecipe& recipe) {
    auto made = test::bakeInto(dir_, test::writeRaster(dir_ / "made.tif", recipe));
    EXPECT_TRUE(made) << toString(made.findings());
    return made ? *made : nullptr;
  }
  static test::RasterRecipe rough() {
    test::RasterRecipe recipe;
    recipe.columns = 120;
    recipe.rows = 90;
    recipe.value = [](int c, int r, int) { return test::roughGround(c, r); };
    return recipe;
  }
  test::ScratchDir dir_;
};

TEST_F(MadeDatabase, heightIsThePostAndBilinearBetween) {
  const auto database = make(rough());
  ASSERT_TRUE(database);
  const auto height = [](int c, int r) {
    return static_cast<double>(static_cast<float>(test::roughGround(c, r)));
  };
  for (int r = 0; r < 89; r += 11)
    for (int c = 0; c < 119; c += 7) {
      const double lon = 10 + 0.001 * (c + 0.5), lat = 50 - 0.001 * (r + 0.5);
      const auto at = database->heightAt(Degrees{lat}, Degrees{lon});
      ASSERT_TRUE(at);
      EXPECT_NEAR(at->value(), height(c, r), 1e-4);
      const auto between = database->heightAt(Degrees{lat - 0.00025}, Degrees{lon + 0.0005});
      const double north = (height(c, r) + height(c + 1, r)) / 2,
                   south = (height(c, r + 1) + height(c + 1, r + 1)) / 2;
      ASSERT_TRUE(between);
      EXPECT_NEAR(between->value(), 0.75 * north + 0.25 * south, 1e-4);
    }
}

TEST_F(MadeDatabase, hasNoHeightOutsideOrWithoutANumber) {
  const auto database = make(rough());
  ASSERT_TRUE(database);
  const double inLat = 49.95, inLon = 10.05;
  EXPECT_TRUE(database->heightAt(Degrees{inLat}, Degrees{inLon}));
  EXPECT_TRUE(database->heightAt(Degrees{inLat}, Degrees{inLon + 360}));
  EXPECT_TRUE(database->heightAt(Degrees{inLat}, Degrees{inLon - 720}));
  for (const double bad : {kNan, kInfinity, -kInfinity, 48.0, 51.0, 1e300})
    EXPECT_FALSE(database->heightAt(Degrees{bad}, Degrees{inLon}));
  for (const double bad : {kNan, kInfinity, -kInfinity, 9.9, 11.0, -170.0})
    EXPECT_FALSE(database->heightAt(Degrees{inLat}, Degrees{bad}));
  for (const double bad : {kNan, -1.0})
    EXPECT_FALSE(database->highestWithin(Degrees{inLat}, Degrees{inLon}, Metres{bad}));
  EXPECT_FALSE(database->highestWithin(Degrees{kNan}, Degrees{inLon}, Metres{1000}));
  EXPECT_FALSE(database->highestWithin(Degrees{inLat}, Degrees{kInfinity}, Metres{1000}));
  EXPECT_FALSE(database->highestWithin(Degrees{40}, Degrees{inLon}, Metres{1000}));
}

/// Every post by geodesic distance; `close` when one lies on the circle itself.
struct ByHand {
  std::optional<double> highest;
  bool close = false;
};
ByHand highestByHand(const TerrainInfo& info, double west, double south, double lat, double lon,
                     double radius, const std::function<double(std::uint32_t, std::uint32_t)>& height) {
  ByHand result;
  for (std::uint32_t r = 0; r < info.rows; ++r)
    for (std::uint32_t c = 0; c < info.columns; ++c) {
      double distance;
      GeographicLib::Geodesic::WGS84().Inverse(lat, lon, south + r * info.postLatitude.value(),
                                               west + c * info.postLongitude.value(), distance);
      // A chord stands for the geodesic.
      if (std::abs(distance - radius) < 1e-4 * radius) result.close = true;
      if (distance <= radius) result.highest = std::max(result.highest.value_or(-1e9), height(r, c));
    }
  return result;
}

TEST_F(MadeDatabase, highestWithinIsTheHighestPostByGeodesicDistance) {
  struct Place {
    double west, north, step;
  };
  int compared = 0;
  for (const Place& place : {Place{10, 50, 0.001}, Place{179.95, -30, 0.001}, Place{20, 89.95, 0.02}}) {
    test::RasterRecipe recipe = rough();
    recipe.west = place.west, recipe.north = place.north, recipe.step = place.step;
    recipe.rows = place.north > 80 ? 60 : 90;
    const auto database = make(recipe);
    ASSERT_TRUE(database);
    const double west = place.west + place.step / 2, south = place.north - place.step * (recipe.rows - 0.5);
    const auto height = [&](std::uint32_t r, std::uint32_t c) {
      return static_cast<double>(
          static_cast<float>(test::roughGround(static_cast<int>(c), recipe.rows - 1 - static_cast<int>(r))));
    };
    for (int k = 0; k < 25; ++k) {
      const double lat = south + place.step * (k * 7 % recipe.rows) + 0.2 * place.step,
                   lon = west + place.step * (k * 31 % 120) - 0.3 * place.step;
      const double radius = 40 + 70.0 * k;
      const ByHand expected = highestByHand(database->info(), west, south, lat, lon, radius, height);
      const auto found = database->highestWithin(Degrees{lat}, Degrees{lon}, Metres{radius});
      if (expected.close) continue;
      ++compared;
      ASSERT_EQ(found.has_value(), expected.highest.has_value()) << lat << " " << lon << " " << radius;
      if (found) {
        ASSERT_EQ(found->value(), *expected.highest) << lat << " " << lon << " " << radius;
      }
    }
  }
  EXPECT_GT(compared, 20);
}

TEST_F(MadeDatabase, reusesTheMeshAndIsTheSameEachTime) {
  const auto database = make(rough());
  ASSERT_TRUE(database);
  TileMesh a, b;
  database->buildTile(0, a);
  database->buildTile(3, b);
  const TileVertex* storage = b.vertices.data();
  database->buildTile(0, b);
  EXPECT_EQ(b.vertices.data(), storage);
  EXPECT_EQ(std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(TileVertex)), 0);
}

TEST(RealDatabase, putsEverestWhereGeographicLibDoes) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  test::ScratchDir dir;
  const auto made = test::bakeInto(dir, test::sharedDir() / "data/dem-srtm3-everest/N27E086.hgt");
  ASSERT_TRUE(made);
  const Database& database = **made;
  const std::string raw = test::readFile(test::sharedDir() / "data/dem-srtm3-everest/N27E086.hgt");
  const GeodeticPosition origin = database.index().frame.origin();
  EXPECT_NEAR(origin.latitude.value(), 27.5, 1e-9);
  EXPECT_NEAR(origin.longitude.value(), 86.5, 1e-9);
  const GeographicLib::LocalCartesian oracle(origin.latitude.value(), origin.longitude.value(), 0);
  TileMesh mesh;
  double worst = 0;
  for (std::uint32_t node = 0; node < 38 * 38; node += 3) {
    database.buildTile(node, mesh);
    const std::uint32_t column0 = (node % 38) * 32, row0 = (node / 38) * 32;
    for (std::uint32_t j = 1; j <= 31; j += 2)
      for (std::uint32_t i = 1; i <= 31; i += 2) {
        const std::uint32_t c = column0 + i, r = row0 + j;
        if (c >= 1200 || r >= 1200) continue;
        const std::size_t k = ((1200 - r) * std::size_t{1201} + c) * 2;
        const double h = static_cast<std::int16_t>(static_cast<std::uint8_t>(raw[k]) << 8 |
                                                   static_cast<std::uint8_t>(raw[k + 1]));
        double x, y, z;
        oracle.Forward(27 + r / 1200.0, 86 + c / 1200.0, h, x, y, z);
        const TileVertex& v = mesh.vertices[j * TileMesh::kSide + i];
        worst = std::max(worst, std::hypot(mesh.origin[0] * 16.0 + static_cast<double>(v.x) - x,
                                           mesh.origin[1] * 16.0 + static_cast<double>(v.y) - y,
                                           mesh.origin[2] * 16.0 + static_cast<double>(v.z) - z));
      }
  }
  EXPECT_LT(worst, 0.005);
  // The summit: within a post of 27.9881 N 86.9250 E.
  const auto summit = database.highestWithin(Degrees{27.9881}, Degrees{86.9250}, Metres{150});
  ASSERT_TRUE(summit);
  EXPECT_NEAR(summit->value(), 8840, 15);
}

TEST(RealDatabase, colourAndNormalsMakeSense) {
  TRIMTAB_NEEDS_SHARED("data/dem-dted1-saotome");
  test::ScratchDir dir;
  const auto made = test::bakeInto(dir, test::sharedDir() / "data/dem-dted1-saotome/n00_e006_3arc_v2.dt1");
  ASSERT_TRUE(made);
  TileMesh mesh;
  (*made)->buildTile(0, mesh);  // open sea
  for (const TileVertex& v : mesh.vertices) {
    ASSERT_GT(v.colour[2], v.colour[0]);
    ASSERT_GE(v.normal[2], 126);
  }
}

}  // namespace
}  // namespace trimtab::terrain
