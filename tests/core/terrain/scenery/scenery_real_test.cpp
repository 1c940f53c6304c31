#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <set>

#include "plain_btg.h"
#include "scenery_grid.h"
#include "scenery_tiles.h"
#include "trimtab/terrain/scenery/import.h"

/// Real scenery, held against a second reader and against the ground it must cover.
namespace trimtab {
namespace {

namespace fs = std::filesystem;
using terrain::SceneryMesh;

const fs::path& data() {
  static const fs::path kData = test::sharedDir() / "data";
  return kData;
}

double flatArea(const SceneryMesh& mesh, bool withLines) {
  std::vector<GeodeticPosition> g;
  for (const Vec3& v : mesh.vertices) g.push_back(toGeodetic(v));
  double area = 0;
  for (const auto& t : mesh.triangles) {
    if (!withLines && mesh.materials[t.material].starts_with("lf_")) continue;
    const auto x = [&](int i) { return (g[t.vertex[i]].longitude - g[t.vertex[0]].longitude).value(); };
    const auto y = [&](int i) { return (g[t.vertex[i]].latitude - g[t.vertex[0]].latitude).value(); };
    area += (x(1) * y(2) - x(2) * y(1)) / 2;
  }
  return area;
}
double bucketArea(const SceneryMesh& mesh) {
  const auto bucket = terrain::bucketOf(std::stol(mesh.name));
  return (bucket.east - bucket.west).value() * (bucket.north - bucket.south).value();
}

struct RealSet {
  const char* folder;
  std::size_t tiles, airports, missing;
  double millions, degenerateShare;  ///< as the data's own description has them
};
const RealSet kSets[] = {{"fg-kansai-e135n35", 25, 2, 0, 2.24, 0},
                         {"fg-debian-iceland-reykjanes", 22, 3, 2, 1.42, 409.0 / 1420},
                         {"fg-debian-hawaii-bigisland", 69, 16, 0, 0.72, 300.0 / 720},
                         {"fg-cologne", 4, 2, 1, 0.61, 259.0 / 610}};

/// Read once for all tests.
const Result<terrain::Scenery>& sceneryOf(const char* folder) {
  static std::map<std::string, Result<terrain::Scenery>> all;
  if (const auto known = all.find(folder); known != all.end()) return known->second;
  return all.emplace(folder, terrain::readScenery(data() / folder)).first->second;
}

TEST(RealScenery, hasTheTrianglesThatASecondReaderCounts) {
  for (const RealSet& set : kSets) {
    TRIMTAB_NEEDS_SHARED("data/" + std::string(set.folder));
    const auto& scenery = sceneryOf(set.folder);
    ASSERT_TRUE(scenery);
    const auto counts = terrain::countsOf(*scenery);
    EXPECT_EQ(counts.tiles, set.tiles) << set.folder;
    EXPECT_EQ(counts.airports, set.airports) << set.folder;
    EXPECT_EQ(counts.missing.size(), set.missing) << set.folder;
    EXPECT_NEAR(static_cast<double>(counts.trianglesInFile) / 1e6, set.millions, 0.005) << set.folder;
    const double share = static_cast<double>(counts.degenerate) / static_cast<double>(counts.trianglesInFile);
    EXPECT_NEAR(share, set.degenerateShare, 0.005) << set.folder;
    std::uint64_t triangles = 0, degenerate = 0;
    const auto files = terrain::sceneryFiles(data() / set.folder);
    for (const fs::path& file : *files) {
      if (file.extension() == ".stg") continue;
      const std::string bytes = test::readFile(file);
      const auto plain =
          test::decodedPlainly(file.extension() == ".gz" ? *terrain::gunzip(bytes, "") : bytes);
      triangles += plain.trianglesInFile, degenerate += plain.degenerate;
    }
    EXPECT_EQ(counts.trianglesInFile, triangles) << set.folder;
    EXPECT_EQ(counts.degenerate, degenerate) << set.folder;
    for (const SceneryMesh& mesh : scenery->tiles) ASSERT_TRUE(test::isSound(mesh)) << mesh.name;
  }
}

TEST(RealScenery, namesTheTileThatColognesListHasInVain) {
  TRIMTAB_NEEDS_SHARED("data/fg-cologne");
  const auto scenery = terrain::readScenery(data() / "fg-cologne");
  ASSERT_TRUE(scenery);
  EXPECT_EQ(scenery->missing, std::vector<std::string>{"3056443.btg"});
  ASSERT_EQ(scenery.findings().size(), 1U);
  EXPECT_TRUE(scenery.findings()[0].where.ends_with("3056443.stg:1"));
}

TEST(RealScenery, readsTheUnzippedTileOfCologne) {
  const char* const name = "data/fg-cologne/3056410.btg";
  TRIMTAB_NEEDS_SHARED(name);
  const auto mesh = terrain::readBtg(test::sharedDir() / name);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->version, 7);
  EXPECT_EQ(mesh->trianglesInFile, 60430U);
  EXPECT_GT(static_cast<double>(mesh->degenerate) / 60430, 0.30);
  EXPECT_LT(static_cast<double>(mesh->degenerate) / 60430, 0.45);
}

/// The tiles with a hole, and those whose source covers some ground twice: all others must be exact.
TEST(RealScenery, tilesItsBucketsExactly) {
  const std::set<std::string> twice{"2582137", "2582177", "2582185", "2582200", "400238", "400246"};
  std::size_t exact = 0;
  for (const RealSet& set : kSets) {
    TRIMTAB_NEEDS_SHARED("data/" + std::string(set.folder));
    const auto& scenery = sceneryOf(set.folder);
    ASSERT_TRUE(scenery);
    for (const SceneryMesh& mesh : scenery->tiles) {
      if (mesh.airport) continue;
      const double part = flatArea(mesh, true) / bucketArea(mesh);
      EXPECT_GT(part, 0.95) << mesh.name;
      EXPECT_LT(part, twice.count(mesh.name) ? 1.03 : 1 + 1e-6) << mesh.name;
      if (std::abs(part - 1) < 1e-6) ++exact;
    }
  }
  EXPECT_EQ(exact, 89U);  // of 120; 6 cover ground twice, 25 have holes
}

TEST(RealScenery, putsAirportsIntoHoles) {
  struct Fit {
    const char* folder;
    std::vector<std::string> tiles;
    const char* airport;
  };
  const Fit fits[] = {{"fg-debian-hawaii-bigisland/Terrain/w160n10/w157n19", {"383855", "383863"}, "PHKO"},
                      {"fg-kansai-e135n35/Terrain/e130n30/e135n35", {"5168985"}, "RJBM"},
                      {"fg-debian-iceland-reykjanes/Terrain/w030n60",
                       {"w023n63/2582136", "w023n64/2582144"},
                       "w023n63/BIKF"}};
  for (const Fit& fit : fits) {
    TRIMTAB_NEEDS_SHARED("data/" + std::string(fit.folder));
    const auto read = [&](const std::string& name) {
      return terrain::readBtg(data() / fit.folder / (name + ".btg.gz"));
    };
    double hole = 0;
    std::vector<SceneryMesh> meshes;
    for (const std::string& name : fit.tiles) {
      meshes.push_back(*read(name));
      hole += bucketArea(meshes.back()) - flatArea(meshes.back(), true);
    }
    const auto voids = [&] {
      const auto posts = terrain::sceneryPosts(meshes, Metres{60});
      const auto grid = test::rasterised(meshes, *posts);
      std::size_t count = 0;
      for (const float h : grid->heights) count += std::isnan(h) ? 1 : 0;
      return count - grid->outside;
    };
    const std::size_t before = voids();
    meshes.push_back(*read(fit.airport));
    // Painted lines lie upon the pavement.
    EXPECT_NEAR(flatArea(meshes.back(), false) / hole, 1, 5e-4) << fit.airport;
    EXPECT_GT(before, 20U) << fit.airport;
    EXPECT_LT(voids(), before / 20 + 2) << fit.airport;
  }
}

TEST(RealScenery, hasTheTrianglesHeightsAtItsPosts) {
  const char* const name = "data/fg-kansai-e135n35/Terrain/e130n30/e135n35/5168995.btg.gz";
  TRIMTAB_NEEDS_SHARED(name);
  const std::vector<SceneryMesh> meshes{*terrain::readBtg(test::sharedDir() / name)};
  const auto posts = terrain::sceneryPosts(meshes, Metres{40});
  const auto grid = test::rasterised(meshes, *posts);
  ASSERT_TRUE(grid);
  std::vector<GeodeticPosition> g;
  for (const Vec3& v : meshes[0].vertices) g.push_back(toGeodetic(v));
  std::mt19937 random(7);
  for (int i = 0; i < 100; ++i) {
    const auto r = static_cast<std::uint32_t>(random() % posts->rows),
               c = static_cast<std::uint32_t>(random() % posts->columns);
    double low = 1e9, high = -1e9;
    for (const auto& t : meshes[0].triangles) {
      double area[3], whole = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto &a = g[t.vertex[(k + 1) % 3]], &b = g[t.vertex[(k + 2) % 3]];
        const double ax = a.longitude.value() - posts->longitude(c),
                     ay = a.latitude.value() - posts->latitude(r);
        const double bx = b.longitude.value() - posts->longitude(c),
                     by = b.latitude.value() - posts->latitude(r);
        whole += area[k] = ax * by - ay * bx;
      }
      if (!(std::abs(whole) > 1e-12) || std::min({area[0] / whole, area[1] / whole, area[2] / whole}) < -1e-3)
        continue;
      double height = 0;
      for (std::size_t k = 0; k < 3; ++k) height += area[k] / whole * g[t.vertex[k]].height.value();
      low = std::min(low, height), high = std::max(high, height);
    }
    const float found = grid->heights[std::size_t{r} * posts->columns + c];
    EXPECT_GE(found, low - 0.1) << r << ' ' << c;
    EXPECT_LE(found, high + 0.1) << r << ' ' << c;
  }
}

TEST(RealScenery, hasNoMaterialWithoutAColour) {
  const auto unknown = terrain::materialColour("NeverHeardOf");
  std::set<std::string> materials;
  for (const RealSet& set : kSets) {
    TRIMTAB_NEEDS_SHARED("data/" + std::string(set.folder));
    const auto& scenery = sceneryOf(set.folder);
    for (const SceneryMesh& mesh : scenery->tiles)
      materials.insert(mesh.materials.begin(), mesh.materials.end());
  }
  EXPECT_GT(materials.size(), 90U);
  for (const std::string& material : materials)
    EXPECT_NE(terrain::materialColour(material), unknown) << material;
}

}  // namespace
}  // namespace trimtab
