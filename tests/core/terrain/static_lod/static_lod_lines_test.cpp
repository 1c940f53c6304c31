#include "core/terrain/static_lod/lines.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "static_lod_check.h"
#include "static_lod_support.h"
#include "tests/support.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/level.h"

namespace trimtab::terrain {
namespace {

/// A grid of two triangles a cell with a material by place.
LatticeTile gridTile(int cells, double cellM,
                     const std::function<std::uint16_t(double x, double y)>& material) {
  LatticeTile tile;
  tile.name = "1";
  const auto step = [&](double m) { return static_cast<std::int32_t>(std::lround(m / Lattice::kStepM)); };
  for (int r = 0; r <= cells; ++r)
    for (int c = 0; c <= cells; ++c) tile.vertices.push_back({step(c * cellM), step(r * cellM), 0});
  for (int r = 0; r < cells; ++r)
    for (int c = 0; c < cells; ++c) {
      const auto a = static_cast<std::uint32_t>(r * (cells + 1) + c),
                 d = a + static_cast<std::uint32_t>(cells) + 1;
      tile.triangles.push_back({a, a + 1, d + 1});
      tile.triangles.push_back({a, d + 1, d});
      tile.material.insert(tile.material.end(), 2, material((c + 0.5) * cellM, (r + 0.5) * cellM));
    }
  tile.shared.assign(tile.vertices.size(), 0);
  return tile;
}

TEST(LineWidths, areTheStripsWidthAndNothingElsewhere) {
  const std::vector<std::string> materials{"Grass", "Road", "Stream"};
  const LatticeTile tile = gridTile(60, 8, [](double x, double y) -> std::uint16_t {
    if (x > 160 && x < 168) return 1;             // 8 m wide
    if (y > 320 && y < 344 && x > 200) return 2;  // 24 m wide, ends in the tile
    return 0;
  });
  const auto widths = lineWidths(tile, materials);
  for (std::size_t v = 0; v < tile.vertices.size(); ++v) {
    const Vec3 p = tile.vertices[v].metres();
    const bool road = p.x >= 160 && p.x <= 168, stream = p.y >= 320 && p.y <= 344 && p.x >= 200;
    EXPECT_NEAR(widths[v], stream ? 24 : road ? 8 : 0, stream ? 1 : 0.01) << p.x << " " << p.y;
  }
  LatticeTile airport = tile;
  airport.name = "EDKB";
  for (const float w : lineWidths(airport, materials)) EXPECT_EQ(w, 0);
}

TEST(LineWidths, ofShoresAreTheDetailOrTheNarrowerSide) {
  const std::vector<std::string> materials{"Grass", "Lake"};
  // A straight shore with one cove 40 m deep, and a pond of 16 m.
  const LatticeTile tile = gridTile(60, 8, [](double x, double y) -> std::uint16_t {
    if (x > 240 || (x > 200 && y > 200 && y < 208)) return 1;
    return x > 80 && x < 96 && y > 80 && y < 96 ? 1 : 0;
  });
  const auto widths = lineWidths(tile, materials);
  float cove = 0, pond = 0;
  for (std::size_t v = 0; v < tile.vertices.size(); ++v) {
    const Vec3 p = tile.vertices[v].metres();
    if (p.x == 240 && p.y > 8 && p.y < 190) {
      EXPECT_LT(widths[v], 20) << "straight: next to no detail at " << p.y;
    }
    if (p.x == 200) cove = std::max(cove, widths[v]);
    if (p.x >= 80 && p.x <= 96) pond = std::max(pond, widths[v]);
  }
  EXPECT_GE(cove, 39);
  EXPECT_NEAR(pond, 8, 0.01);  // twice 256 m^2 over 64 m
}

/// Hills with roads, a stream and a lake.
SceneryMesh landscape() {
  SceneryMesh mesh = test::tin("100", {.cell = 20, .columns = 90, .rows = 90, .materials = 4});
  mesh.materials = {"Grass", "Road", "Stream", "Lake"};
  const LocalFrame frame = test::testFrame();
  for (SceneryMesh::Triangle& t : mesh.triangles) {
    Vec3 p{};
    for (const std::uint32_t v : t.vertex) p = p + frame.fromEcef(mesh.vertices[v]) * (1.0 / 3);
    t.material = 0;
    if (std::hypot(p.x - 1300, p.y - 1300) < 220) t.material = 3;
    if (std::abs(p.x - 500 - 60 * std::sin(p.y / 200)) < 15) t.material = 1;
    if (std::abs(p.y - 700) < 25) t.material = 2;
  }
  return mesh;
}

StaticLodOptions lines(std::uint32_t n, bool keep) {
  StaticLodOptions options;
  options.trianglesPerNode = n;
  options.keepLines = keep;
  return options;
}

TEST(StaticLodLines, survivesToThePixelThatIsAsWide) {
  const std::vector<SceneryMesh> tiles{landscape()};
  const auto plain = buildStaticLod(tiles, test::testFrame(), lines(600, false));
  const auto kept = buildStaticLod(tiles, test::testFrame(), lines(600, true));
  ASSERT_TRUE(plain && kept);
  const test::PlacedTrees trees(**kept);
  const test::TreeFaults faults = test::faultsOf(trees);
  EXPECT_EQ(faults.cracks, 0u);
  EXPECT_EQ(faults.newFolds, 0u);
  EXPECT_EQ(faults.lostArea, 0u);
  EXPECT_EQ(faults.wrongLeaves, 0u);
  EXPECT_EQ(faults.wrongErrors, 0u);
  EXPECT_EQ(faults.wrongLocks, 0u);
  EXPECT_EQ(test::openCuts(trees, 8, 1), 0);

  const auto before = lineShares(**plain, 0), after = lineShares(**kept, 0);
  const StaticLodReport report = reportStaticLod(**kept, 0);
  ASSERT_EQ(before.size(), after.size());
  EXPECT_EQ(before.back().ofLines(), 1);
  EXPECT_LT(before.front().ofLines(), 0.5);
  for (std::size_t level = 0; level < after.size(); ++level) {
    std::printf("level %zu: lines %.3f, kept %.3f; shores %.3f, kept %.3f; %llu triangles at %.2f m\n", level,
                before[level].ofLines(), after[level].ofLines(), before[level].ofShores(),
                after[level].ofShores(), static_cast<unsigned long long>(report.facesOfLevel[level]),
                report.rmsErrorM[level]);
    EXPECT_GE(after[level].ofLines(), before[level].ofLines()) << level;
    // The narrowest is some 20 m wide.
    if (report.rmsErrorM[level] < 18) {
      EXPECT_EQ(after[level].ofLines(), 1) << level;
    }
  }
}

TEST(StaticLodLines, keepsEveryLineAsWideAsItsStatedError) {
  const std::vector<SceneryMesh> tiles{landscape()};
  const auto kept = buildStaticLod(tiles, test::testFrame(), lines(300, true));
  ASSERT_TRUE(kept);
  const StaticLodTerrain& terrain = **kept;
  const LocalFrame frame = test::testFrame();
  const auto lattice = toLattice(tiles, frame);
  ASSERT_TRUE(lattice);
  const LatticeTile& tile = lattice->tiles[0];
  const auto widths = lineWidths(tile, lattice->materials);
  const test::PlacedTrees trees(terrain);
  std::size_t asked = 0;
  for (std::uint32_t node = 0; node < terrain.index.size(); ++node) {
    std::set<test::PlacedTrees::Place> there;
    for (const auto& t : trees.triangles(node))
      for (const std::uint32_t v : t) there.insert(trees.place(v));
    std::set<test::PlacedTrees::Place> below;
    for (const std::uint32_t leaf : trees.leavesOf(node))
      for (const auto& t : trees.triangles(leaf))
        for (const std::uint32_t v : t) below.insert(trees.place(v));
    for (std::size_t v = 0; v < tile.vertices.size(); ++v) {
      const Lattice& p = tile.vertices[v];
      const test::PlacedTrees::Place place{p.x, p.y, p.z};
      if (!(widths[v] > terrain.index.rmsErrorM[node]) || !below.contains(place)) continue;
      ++asked;
      EXPECT_TRUE(there.contains(place)) << "node " << node << ", " << widths[v] << " m";
    }
  }
  EXPECT_GT(asked, 1000u);
}

TEST(StaticLodLines, offIsWhatItWas) {
  // A tile without lines is built alike either way.
  const std::vector<SceneryMesh> tiles{test::tin("100", {})};
  const auto off = buildStaticLod(tiles, test::testFrame(), lines(100, false)),
             on = buildStaticLod(tiles, test::testFrame(), lines(100, true));
  ASSERT_TRUE(off && on);
  EXPECT_EQ((*off)->tiles[0].indices, (*on)->tiles[0].indices);
  // And a source taken out of the trees again gives the same trees.
  const std::vector<SceneryMesh> again{sourceOf(**off, 0)};
  const auto same = buildStaticLod(again, test::testFrame(), lines(100, false));
  ASSERT_TRUE(same);
  EXPECT_EQ((*same)->counts.sourceTriangles, (*off)->counts.sourceTriangles);
  EXPECT_EQ((*same)->counts.faces, (*off)->counts.faces);
}

TEST(StaticLodLines, keepsThoseOfRealTiles) {
  const char* const name = "data/fg-kansai-e135n35/Terrain/e130n30/e135n35/5168995.btg.gz";
  TRIMTAB_NEEDS_SHARED(name);
  const std::vector<SceneryMesh> tiles{*readBtg(test::sharedDir() / name)};
  GeodeticPosition middle = toGeodetic(tiles[0].vertices[0]);
  const LocalFrame frame(middle);
  const auto plain = buildStaticLod(tiles, frame, lines(2000, false));
  const auto kept = buildStaticLod(tiles, frame, lines(2000, true));
  ASSERT_TRUE(plain && kept);
  const auto before = lineShares(**plain, 0), after = lineShares(**kept, 0);
  const StaticLodReport was = reportStaticLod(**plain, 0), is = reportStaticLod(**kept, 0);
  for (std::size_t level = 0; level < after.size(); ++level) {
    std::printf(
        "level %zu: lines %.3f -> %.3f; shores %.3f -> %.3f; triangles %llu -> %llu; RMS %.2f -> %.2f m\n",
        level, before[level].ofLines(), after[level].ofLines(), before[level].ofShores(),
        after[level].ofShores(), static_cast<unsigned long long>(was.facesOfLevel[level]),
        static_cast<unsigned long long>(is.facesOfLevel[level]), was.rmsErrorM[level], is.rmsErrorM[level]);
    EXPECT_GE(after[level].ofLines() + 1e-9, before[level].ofLines()) << level;
  }
  const test::PlacedTrees trees(**kept);
  EXPECT_EQ(test::openCuts(trees, 3, 5), 0);
}

}  // namespace
}  // namespace trimtab::terrain
