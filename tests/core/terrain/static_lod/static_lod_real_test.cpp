#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>

#include "static_lod_check.h"
#include "static_lod_support.h"
#include "tests/support.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::terrain {
namespace {

struct RealStaticLod : testing::TestWithParam<const char*> {};

LocalFrame frameOf(const std::vector<SceneryMesh>& tiles) {
  Vec3 sum{};
  double count = 0;
  for (const SceneryMesh& tile : tiles)
    for (const Vec3 v : tile.vertices) sum = sum + v, ++count;
  GeodeticPosition middle = toGeodetic(sum * (1 / count));
  middle.height = Metres{0};
  return LocalFrame(middle);
}

/// From above; a triangle that the file has twice counts once.
double areaOf(const SceneryMesh& mesh, const LocalFrame& frame) {
  std::set<std::array<std::array<long, 3>, 3>> seen;
  double area = 0;
  for (const SceneryMesh::Triangle& t : mesh.triangles) {
    std::array<Vec3, 3> p;
    std::array<std::array<long, 3>, 3> rounded;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = frame.fromEcef(mesh.vertices[t.vertex[k]]);
      rounded[k] = {std::lround(p[k].x * 64), std::lround(p[k].y * 64), std::lround(p[k].z * 64)};
    }
    std::rotate(rounded.begin(), std::min_element(rounded.begin(), rounded.end()), rounded.end());
    if (seen.insert(rounded).second) area += 0.5 * cross(p[1] - p[0], p[2] - p[0]).z;
  }
  return area;
}

TEST_P(RealStaticLod, hasNoCrackNoNewFoldAndTheSameBordersAtAllLevels) {
  TRIMTAB_NEEDS_SHARED(std::string("data/") + GetParam());
  const auto scenery = readScenery(test::sharedDir() / "data" / GetParam());
  ASSERT_TRUE(scenery) << toString(scenery.findings());
  const std::vector<SceneryMesh>& tiles = scenery->tiles;
  const LocalFrame frame = frameOf(tiles);
  const auto built = buildStaticLod(tiles, frame, {});
  ASSERT_TRUE(built) << toString(built.findings());
  const StaticLodTerrain& terrain = **built;
  const test::PlacedTrees trees(terrain);
  EXPECT_TRUE(trees.onLattice());
  const test::TreeFaults faults = test::faultsOf(trees);
  EXPECT_EQ(faults.cracks, 0u);
  EXPECT_EQ(faults.newFolds, 0u);
  EXPECT_EQ(faults.lostArea, 0u);  // to the last digit from leaves to root
  EXPECT_EQ(faults.wrongLeaves, 0u);
  EXPECT_EQ(faults.wrongNodes, 0u);
  EXPECT_EQ(faults.wrongErrors, 0u);
  EXPECT_EQ(faults.wrongBounds, 0u);
  EXPECT_EQ(faults.wrongLocks, 0u);
  EXPECT_EQ(faults.unequalNormals, 0u);
  EXPECT_EQ(faults.distinctFaces, terrain.counts.distinctFaces);
  EXPECT_EQ(test::openCuts(trees, 3, 5), 0);

  // And from the files to the leaves.
  ASSERT_EQ(terrain.tiles.size(), tiles.size());
  std::uint64_t triangles = 0;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    ASSERT_EQ(terrain.tiles[i].name, tiles[i].name);
    triangles += tiles[i].triangles.size();
    double area = 0;
    for (const auto& t : trees.triangles(terrain.index.roots[i]))
      area += static_cast<double>(trees.area(t)) / 131072;
    const double source = areaOf(tiles[i], frame);
    EXPECT_NEAR(area / source, 1, 1e-4) << tiles[i].name << " of " << source << " m^2";
  }
  EXPECT_EQ(terrain.counts.sourceTriangles + terrain.counts.degenerate + terrain.counts.repeated, triangles);
  std::printf(
      "%s: %zu tiles, %llu triangles, %u levels, %llu faces (%.2f times), %llu of %zu nodes are locked "
      "minima\n",
      GetParam(), tiles.size(), static_cast<unsigned long long>(terrain.counts.sourceTriangles),
      terrain.counts.levels, static_cast<unsigned long long>(terrain.counts.faces),
      static_cast<double>(terrain.counts.faces) / static_cast<double>(terrain.counts.sourceTriangles),
      static_cast<unsigned long long>(terrain.counts.lockedMinima), terrain.index.size());
}

INSTANTIATE_TEST_SUITE_P(Sets, RealStaticLod,
                         testing::Values("fg-cologne", "fg-debian-hawaii-bigisland",
                                         "fg-debian-iceland-reykjanes", "fg-kansai-e135n35"),
                         [](const auto& set) {
                           std::string name = set.param;
                           std::erase_if(name,
                                         [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

TEST(StaticLodReport, comparesTheTileNearestToThePublishedOne) {
  TRIMTAB_NEEDS_SHARED("data/fg-cologne");
  // Of all sets the tile nearest to 30,987 triangles lies in this one or in the next.
  constexpr std::uint64_t kPublished = 30987, kPublishedFaces = 126520;
  std::vector<SceneryMesh> nearest;
  for (const char* folder :
       {"fg-cologne", "fg-debian-hawaii-bigisland", "fg-debian-iceland-reykjanes", "fg-kansai-e135n35"}) {
    auto scenery = readScenery(test::sharedDir() / "data" / folder);
    if (!scenery) continue;
    for (SceneryMesh& tile : scenery.value().tiles) {
      const auto away = [](const SceneryMesh& m) {
        return std::abs(double(m.triangles.size()) - double(kPublished));
      };
      if (nearest.empty() || away(tile) < away(nearest[0])) nearest = {std::move(tile)};
    }
  }
  const auto terrain = buildStaticLod(nearest, frameOf(nearest), {});
  ASSERT_TRUE(terrain);
  const StaticLodReport ours = reportStaticLod(**terrain, tileNearest(**terrain, kPublished));
  const StaticLodLimits limits = staticLodLimits(kPublished, 2000);
  EXPECT_EQ(limits.levels, 5u);
  // With n as the least of a leaf, eight leaves of 3,874 at most make the published 4 levels.
  EXPECT_EQ(staticLodLimits(kPublished, 2000, LeafReading::atLeast).levels, 4u);
  const HalvedTree most = halvedTree(kPublished, 2000, LeafReading::atMost);
  EXPECT_EQ(most.leaves, 16u);
  EXPECT_EQ(most.largestLeaf, 1937u);
  EXPECT_EQ(most.levels, 5u);
  EXPECT_EQ(most.faces, kPublished + 15u * 2000);
  const HalvedTree least = halvedTree(kPublished, 2000, LeafReading::atLeast);
  EXPECT_EQ(least.leaves, 8u);
  EXPECT_EQ(least.largestLeaf, 3874u);
  EXPECT_EQ(least.levels, 4u);
  EXPECT_EQ(least.faces, kPublished + 7u * 2000);
  // The published faces are beyond both.
  EXPECT_LT(staticLodLimits(kPublished, 2000, LeafReading::atLeast).mostFaces, kPublishedFaces);
  EXPECT_NEAR(double(limits.leastFaces) / kPublished, 2.0, 0.04);
  EXPECT_NEAR(double(limits.mostFaces) / kPublished, 2.9, 0.04);
  EXPECT_LT(limits.mostFaces, kPublishedFaces);
  EXPECT_EQ(ours.distinctFaces, (*terrain)->counts.distinctFaces);
  std::printf("                 tile  triangles     n  levels    faces  times\n");
  std::printf("published     3105386  %9d  2000       4  %7d   %.2f\n", 30987, 126520, 126520 / 30987.0);
  std::printf("its rule               %9d  2000     %u  %llu to %llu   %.2f to %.2f\n", 30987, limits.levels,
              static_cast<unsigned long long>(limits.leastFaces),
              static_cast<unsigned long long>(limits.mostFaces), double(limits.leastFaces) / kPublished,
              double(limits.mostFaces) / kPublished);
  std::printf("ours       %10s  %9llu  %u       %u  %7llu   %.2f (%llu of them distinct)\n",
              ours.tile.c_str(), static_cast<unsigned long long>(ours.triangles), ours.trianglesPerNode,
              ours.levels, static_cast<unsigned long long>(ours.faces),
              double(ours.faces) / double(ours.triangles),
              static_cast<unsigned long long>((*terrain)->counts.distinctFaces));
  EXPECT_GE(ours.levels, ours.limits.levels);
  if (ours.lockedMinima == 0) {
    EXPECT_GE(ours.faces, ours.limits.leastFaces);
    EXPECT_LE(ours.faces, ours.limits.mostFaces);
  }
}

TEST(StaticLodLimits, readNAsTheMostOrTheLeastOfALeaf) {
  for (const LeafReading reading : {LeafReading::atMost, LeafReading::atLeast}) {
    const HalvedTree one = halvedTree(100, 100, reading);
    EXPECT_EQ(one.leaves, 1u);
    EXPECT_EQ(one.levels, 1u);
    EXPECT_EQ(one.faces, 100u);
  }
  // 401 triangles: leaves of 51 at most are needed for n = 100 at most, and 101 are no leaf of it.
  const HalvedTree most = halvedTree(401, 100, LeafReading::atMost);
  EXPECT_EQ(most.leaves, 8u);
  EXPECT_EQ(most.largestLeaf, 51u);
  const HalvedTree least = halvedTree(401, 100, LeafReading::atLeast);
  EXPECT_EQ(least.leaves, 4u);
  EXPECT_EQ(least.largestLeaf, 101u);
  EXPECT_EQ(least.levels, 3u);
  // The builder splits as the first reading says.
  const auto terrain = *test::built({test::tin("100", {.columns = 64, .rows = 64})}, 100);
  const StaticLodReport report = reportStaticLod(*terrain, 0);
  EXPECT_EQ(report.levels, halvedTree(report.triangles, 100, LeafReading::atMost).levels);
  EXPECT_EQ(report.distinctFaces, terrain->counts.distinctFaces);
  EXPECT_LT(report.distinctFaces, report.faces);
  // A face stays the same whichever of its corners comes first.
  StaticLodTerrain turned = *terrain;
  std::vector<std::uint32_t>& indices = turned.tiles[0].indices;
  for (std::size_t t = 0; t + 6 <= indices.size(); t += 6)
    std::rotate(indices.begin() + std::ptrdiff_t(t), indices.begin() + std::ptrdiff_t(t + 1),
                indices.begin() + std::ptrdiff_t(t + 3));
  EXPECT_EQ(reportStaticLod(turned, 0).distinctFaces, report.distinctFaces);
}

TEST(StaticLodLimits, allowOneTriangleEitherSideOfN) {
  // Four leaves of 100 at n = 100 have three nodes above them; eight of 50 have seven.
  const StaticLodLimits limits = staticLodLimits(400, 100);
  EXPECT_EQ(limits.levels, 3u);
  EXPECT_EQ(limits.leastFaces, 400u + 3 * 99);
  EXPECT_EQ(limits.mostFaces, 400u + 7 * 101);
  // Builder and limits agree: a node that is no leaf has n - 1 to n + 1 triangles.
  for (const std::uint32_t n : {37u, 100u, 101u, 256u}) {
    const auto terrain = *test::built({test::tin("100", {.columns = 64, .rows = 64})}, n);
    const StaticLodReport report = reportStaticLod(*terrain, 0);
    for (const StaticLodIndex::Node& node : terrain->index.nodes) {
      if (node.children[0] == StaticLodIndex::kNone || node.lockedMinimum) continue;
      EXPECT_NEAR(double(node.triangles), n, 1);
    }
    if (report.lockedMinima > 0) continue;
    EXPECT_GE(report.faces, report.limits.leastFaces);
    EXPECT_LE(report.faces, report.limits.mostFaces);
  }
}

}  // namespace
}  // namespace trimtab::terrain
