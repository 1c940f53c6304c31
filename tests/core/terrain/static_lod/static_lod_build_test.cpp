#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "core/terrain/static_lod/tree.h"
#include "static_lod_check.h"
#include "static_lod_support.h"
#include "tests/support.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::terrain {
namespace {

using test::built;
using test::tin;
using test::TinOptions;

void expectSound(const StaticLodTerrain& terrain, const std::string& what = {}) {
  const test::PlacedTrees trees(terrain);
  EXPECT_TRUE(trees.onLattice()) << what;
  const test::TreeFaults faults = test::faultsOf(trees);
  EXPECT_EQ(faults.cracks, 0u) << what;
  EXPECT_EQ(faults.newFolds, 0u) << what;
  EXPECT_EQ(faults.lostArea, 0u) << what;
  EXPECT_EQ(faults.wrongLeaves, 0u) << what;
  EXPECT_EQ(faults.wrongNodes, 0u) << what;
  EXPECT_EQ(faults.wrongErrors, 0u) << what;
  EXPECT_EQ(faults.wrongBounds, 0u) << what;
  EXPECT_EQ(faults.wrongLocks, 0u) << what;
  EXPECT_EQ(faults.unequalNormals, 0u) << what;
  EXPECT_EQ(faults.distinctFaces, terrain.counts.distinctFaces) << what;
  EXPECT_EQ(faults.lockedMinima, terrain.counts.lockedMinima) << what;
  EXPECT_EQ(test::openCuts(trees, 8, 1), 0) << what;
}

TEST(StaticLodBuild, keepsItsPromisesForAnyNodeSize) {
  const SceneryMesh mesh = tin("A", {});
  for (const std::uint32_t n : {1u, 2u, 3u, 7u, 50u, 51u, 200u, 1000u, 3199u, 3200u, 3201u, 1000000u}) {
    const auto terrain = built({mesh}, n);
    ASSERT_TRUE(terrain) << toString(terrain.findings());
    expectSound(**terrain, "n = " + std::to_string(n));
    EXPECT_EQ((*terrain)->counts.sourceTriangles, 3200u);
    if (n >= 3200) {
      EXPECT_EQ((*terrain)->index.size(), 1u);
      EXPECT_EQ((*terrain)->counts.distinctFaces, 3200u);
    }
  }
}

TEST(StaticLodBuild, reachesTheSizeWhereBordersAllowAndSaysSoWhereNot) {
  const auto wide = built({tin("A", {.columns = 60, .rows = 60})}, 400);
  ASSERT_TRUE(wide);
  EXPECT_EQ((*wide)->counts.lockedMinima, 0u);
  EXPECT_EQ((*wide)->counts.levels, 6u);  // 7200 / 400 = 18 leaves, so 32
  // 240 vertices of border need 238 triangles; sides that are straight keep a vertex or two inside.
  const auto narrow = built({tin("A", {.columns = 60, .rows = 60})}, 100);
  ASSERT_TRUE(narrow);
  EXPECT_TRUE((*narrow)->index.nodes[0].lockedMinimum);
  EXPECT_GE((*narrow)->index.nodes[0].triangles, 238u);
  EXPECT_LE((*narrow)->index.nodes[0].triangles, 244u);
}

TEST(StaticLodBuild, coversEveryPlaceOnceAtEveryLevel) {
  const auto terrain =
      built({tin("A", {.hole = [](auto c, auto r) { return c > 12 && c < 20 && r > 8 && r < 15; }})}, 64);
  ASSERT_TRUE(terrain);
  expectSound(**terrain);
  const test::PlacedTrees trees(**terrain);
  const StaticLodIndex& index = (*terrain)->index;
  std::mt19937 random(4);
  for (std::uint8_t depth = 0; depth < (*terrain)->counts.levels; ++depth) {
    std::vector<test::PlacedTrees::Corners> level;
    for (std::uint32_t i = 0; i < index.size(); ++i)
      if (index.nodes[i].depth == depth ||
          (index.nodes[i].depth < depth && index.nodes[i].children[0] == StaticLodIndex::kNone)) {
        const auto more = trees.triangles(i);
        level.insert(level.end(), more.begin(), more.end());
      }
    for (int k = 0; k < 200; ++k) {
      std::uniform_real_distribution<double> side(0, 1200);
      const double x = side(random), y = side(random);
      int covering = 0;
      for (const auto& t : level) {
        int inside = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          const auto &a = trees.place(t[c]), &b = trees.place(t[(c + 1) % 3]);
          const double ax = double(a[0]) / 256, ay = double(a[1]) / 256, bx = double(b[0]) / 256,
                       by = double(b[1]) / 256;
          inside += (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0;
        }
        covering += inside == 3;
      }
      const bool hole = x > 13 * 30 && x < 20 * 30 && y > 9 * 30 && y < 15 * 30;
      EXPECT_EQ(covering, hole ? 0 : 1) << "level " << int{depth} << " at " << x << " " << y;
    }
  }
}

TEST(StaticLodBuild, measuresTheErrorThatEveryTriangleInTurnShows) {
  const auto terrain = built({tin("A", {.columns = 24, .rows = 24, .seed = 9})}, 60);
  ASSERT_TRUE(terrain);
  const test::PlacedTrees trees(**terrain);
  const StaticLodIndex& index = (*terrain)->index;
  const auto distance = [&](const std::vector<test::PlacedTrees::Corners>& surface, std::uint32_t vertex) {
    const auto& p = trees.place(vertex);
    double nearest = INFINITY;
    for (const auto& t : surface) {
      const auto &a = trees.place(t[0]), &b = trees.place(t[1]), &c = trees.place(t[2]);
      const double area = static_cast<double>(trees.area(t));
      const double s =
          (double(p[0] - a[0]) * double(c[1] - a[1]) - double(p[1] - a[1]) * double(c[0] - a[0])) / area;
      const double w =
          (double(b[0] - a[0]) * double(p[1] - a[1]) - double(b[1] - a[1]) * double(p[0] - a[0])) / area;
      if (s < -1e-12 || w < -1e-12 || s + w > 1 + 1e-12) continue;
      nearest = std::min(
          nearest,
          std::abs(double(a[2]) + s * double(b[2] - a[2]) + w * double(c[2] - a[2]) - double(p[2])) / 256);
    }
    return nearest;
  };
  std::vector<double> rms(index.size()), largest(index.size());
  for (std::uint32_t i = static_cast<std::uint32_t>(index.size()); i-- > 0;) {
    if (index.nodes[i].children[0] == StaticLodIndex::kNone) continue;
    std::vector<test::PlacedTrees::Corners> source;
    for (const std::uint32_t leaf : trees.leavesOf(i)) {
      const auto more = trees.triangles(leaf);
      source.insert(source.end(), more.begin(), more.end());
    }
    const auto node = trees.triangles(i);
    std::set<std::uint32_t> ofSource, ofNode;
    for (const auto& t : source) ofSource.insert(t.begin(), t.end());
    for (const auto& t : node) ofNode.insert(t.begin(), t.end());
    double sum = 0;
    for (const std::uint32_t v : ofSource) {
      const double d = distance(node, v);
      sum += d * d, largest[i] = std::max(largest[i], d);
    }
    std::size_t samples = ofSource.size();
    for (const std::uint32_t v : ofNode)
      if (!ofSource.count(v)) {
        const double d = distance(source, v);
        sum += d * d, largest[i] = std::max(largest[i], d), ++samples;
      }
    rms[i] = std::sqrt(sum / static_cast<double>(samples));
    for (const std::uint32_t child : index.nodes[i].children)
      rms[i] = std::max(rms[i], rms[child]), largest[i] = std::max(largest[i], largest[child]);
    EXPECT_NEAR(index.rmsErrorM[i], rms[i], 1e-5 * (1 + rms[i])) << "node " << i;
    EXPECT_NEAR(index.maxErrorM[i], largest[i], 1e-5 * (1 + largest[i])) << "node " << i;
  }
  EXPECT_GT(rms[0], 1);
}

TEST(StaticLodBuild, closesBordersBetweenTilesThatTellThemAMillimetreApart) {
  std::vector<SceneryMesh> tiles;
  for (std::uint32_t r = 0; r < 2; ++r)
    for (std::uint32_t c = 0; c < 3; ++c)
      tiles.push_back(tin("T" + std::to_string(r) + std::to_string(c), {.x0 = c * 600.0,
                                                                        .y0 = r * 600.0,
                                                                        .columns = 20,
                                                                        .rows = 20,
                                                                        .seed = 7 + r * 3 + c,
                                                                        .noiseM = 0.0009}));
  const auto terrain = built(tiles, 60);
  ASSERT_TRUE(terrain);
  expectSound(**terrain);
  const test::PlacedTrees trees(**terrain);
  // The whole has no open edge but its outer border: 2 x 60 + 2 x 40 edges.
  EXPECT_EQ(trees.border((*terrain)->index.roots).size(), 200u);
  // Two upright borders of 2 x 21 and a level one of 3 x 21, each from both sides; four tiles meet at two
  // corners.
  EXPECT_EQ((*terrain)->counts.joinedVertices, 2u * (2 * 2 * 21 + 3 * 21) - 2 * 4);
}

TEST(StaticLodBuild, givesTheSameBytesEveryTime) {
  const std::vector<SceneryMesh> tiles{tin("A", {}), tin("B", {.x0 = 1200, .seed = 2}),
                                       tin("C", {.x0 = 2400, .columns = 9})};
  const auto first = built(tiles, 100), second = built(tiles, 100);
  ASSERT_TRUE(first && second);
  ASSERT_EQ((*first)->tiles.size(), (*second)->tiles.size());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ((*first)->tiles[i].indices, (*second)->tiles[i].indices);
    EXPECT_EQ((*first)->tiles[i].name, tiles[i].name);
  }
  EXPECT_EQ((*first)->index.rmsErrorM, (*second)->index.rmsErrorM);
}

TEST(StaticLodBuild, holdsTheLineBetweenMaterials) {
  // Flat land: only the shore, a circle of 300 m, can tell one collapse from another.
  SceneryMesh mesh =
      tin("A", {.columns = 60, .rows = 60, .materials = 2}, [](double, double) { return 0.0; });
  const LocalFrame frame = test::testFrame();
  const auto inCircle = [](Vec3 p) { return std::hypot(p.x - 900, p.y - 900) < 300; };
  for (SceneryMesh::Triangle& t : mesh.triangles) {
    Vec3 middle{};
    for (const std::uint32_t v : t.vertex) middle = middle + frame.fromEcef(mesh.vertices[v]) * (1.0 / 3);
    t.material = inCircle(middle) ? 1 : 0;
  }
  const auto terrain = built({mesh}, 600);
  ASSERT_TRUE(terrain);
  const StaticLodTerrain& trees = **terrain;
  const auto areaOf = [&](std::uint16_t material, std::uint32_t first, std::uint32_t count,
                          std::size_t tile) {
    double area = 0;
    for (std::uint32_t t = first; t < first + count; ++t) {
      if (trees.tiles[tile].material[t] != material) continue;
      const auto* i = &trees.tiles[tile].indices[t * 3];
      const StaticLodVertex &a = trees.tiles[tile].vertices[i[0]], &b = trees.tiles[tile].vertices[i[1]],
                            &c = trees.tiles[tile].vertices[i[2]];
      area += 0.5 * (double(b.x - a.x) * double(c.y - a.y) - double(b.y - a.y) * double(c.x - a.x));
    }
    return area;
  };
  const std::uint16_t island = static_cast<std::uint16_t>(
      std::find(trees.materials.begin(), trees.materials.end(), "Material1") - trees.materials.begin());
  double source = 0;
  for (std::size_t i = 0; i < trees.index.size(); ++i)
    if (trees.index.nodes[i].children[0] == StaticLodIndex::kNone)
      source += areaOf(island, trees.ranges[i].firstTriangle, trees.ranges[i].triangles, 0);
  const double root = areaOf(island, trees.ranges[0].firstTriangle, trees.ranges[0].triangles, 0);
  EXPECT_NEAR(root / source, 1, 0.02);
}

TEST(StaticLodBuild, survivesMeshesThatAreNoSurface) {
  SceneryMesh mesh = tin("A", {.columns = 30, .rows = 30});
  const std::size_t plain = mesh.triangles.size();
  mesh.triangles.push_back(mesh.triangles[100]);  // the same again, and turned
  mesh.triangles.push_back(
      {{mesh.triangles[200].vertex[1], mesh.triangles[200].vertex[2], mesh.triangles[200].vertex[0]}, 1});
  mesh.triangles.push_back(
      {{mesh.triangles[300].vertex[1], mesh.triangles[300].vertex[0], mesh.triangles[300].vertex[2]},
       1});  // its back
  const std::uint32_t extra = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(test::testFrame().toEcef({450, 450, 900}));
  const auto& edge = mesh.triangles[800].vertex;
  mesh.triangles.push_back({{edge[0], edge[1], extra}, 0});  // third triangle at an edge
  mesh.triangles.push_back({{edge[0], edge[0], edge[1]}, 0});
  for (const std::uint32_t n : {1u, 10u, 100u, 400u}) {
    const auto terrain = built({mesh}, n);
    ASSERT_TRUE(terrain);
    EXPECT_EQ((*terrain)->counts.repeated, 2u);
    EXPECT_EQ((*terrain)->counts.degenerate, 1u);
    EXPECT_EQ((*terrain)->counts.sourceTriangles, plain + 2);
    EXPECT_GE((*terrain)->counts.folded, 1u);
    expectSound(**terrain, "n = " + std::to_string(n));
  }
  // Triangles at random between a few vertices: nothing about them holds but this.
  std::mt19937 random(2);
  const auto vertex = [&] { return static_cast<std::uint32_t>(random() % 40); };
  for (int i = 0; i < 20; ++i) {
    SceneryMesh heap;
    heap.name = "heap";
    heap.materials = {"a", "b"};
    for (int v = 0; v < 40; ++v)
      heap.vertices.push_back(
          test::testFrame().toEcef({double(random() % 500), double(random() % 500), double(random() % 50)}));
    for (int t = 0; t < 200; ++t)
      heap.triangles.push_back({{vertex(), vertex(), vertex()}, static_cast<std::uint16_t>(random() % 2)});
    const auto terrain = built({heap}, 20);
    ASSERT_TRUE(terrain);
    expectSound(**terrain, "heap " + std::to_string(i));
  }
}

TEST(StaticLodBuild, takesOneTriangleAndLeavesOutTilesWithNone) {
  SceneryMesh one = tin("one", {.columns = 1, .rows = 1}), none = one;
  one.triangles.resize(1);
  none.triangles.clear();
  none.name = "none";
  const auto terrain = built({none, one}, 2000);
  ASSERT_TRUE(terrain);
  EXPECT_EQ((*terrain)->tiles.size(), 1u);
  EXPECT_EQ((*terrain)->counts.faces, 1u);
  ASSERT_EQ(terrain.findings().size(), 1u);
  EXPECT_EQ(terrain.findings()[0].severity, Severity::warning);
  EXPECT_EQ(terrain.findings()[0].where, "none");
  expectSound(**terrain);
  EXPECT_FALSE(built({none}, 2000));
  EXPECT_FALSE(built({}, 2000));
}

TEST(StaticLodBuild, refusesWhatCannotBePlacedAndNamesIt) {
  const SceneryMesh good = tin("A", {.columns = 4, .rows = 4});
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(), INFINITY, -INFINITY, 1e30, -1e9, 0};
  for (const double value : bad) {
    SceneryMesh mesh = good;
    mesh.vertices[7] = {value, value, value};
    const auto terrain = built({good, mesh}, 8);
    ASSERT_FALSE(terrain) << value;
    EXPECT_EQ(terrain.findings()[0].where, "A");
    EXPECT_EQ(terrain.findings()[0].key, "vertex 7");
  }
  SceneryMesh wide = good;
  wide.vertices[3] = test::testFrame().toEcef({300e3, 0, 0});
  EXPECT_FALSE(built({wide}, 8));
  SceneryMesh index = good;
  index.triangles[2].vertex[1] = 25;
  EXPECT_FALSE(built({index}, 8));
  SceneryMesh material = good;
  material.triangles[2].material = 3;
  EXPECT_FALSE(built({material}, 8));
  EXPECT_FALSE(built({good}, 0));
  EXPECT_FALSE(built({good}, kMostTrianglesPerNode + 1));
  EXPECT_TRUE(built({good}, 8));
}

TEST(StaticLodBuild, stopsWhenTold) {
  const std::vector<SceneryMesh> tiles{tin("A", {}), tin("B", {.x0 = 1200})};
  StaticLodOptions options;
  options.trianglesPerNode = 100;
  double last = -1;
  options.progress = [&](double share, const std::string&) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
    return true;
  };
  EXPECT_TRUE(buildStaticLod(tiles, test::testFrame(), options));
  options.progress = [](double share, const std::string&) { return share == 0; };
  const auto stopped = buildStaticLod(tiles, test::testFrame(), options);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.findings()[0].severity, Severity::note);
  options.progress = [](double, const std::string&) { return false; };
  EXPECT_FALSE(buildStaticLod(tiles, test::testFrame(), options));
}

TEST(StaticLodBuild, stopsWithinATile) {
  const std::vector<SceneryMesh> tiles{tin("A", {})};
  StaticLodOptions options;
  options.trianglesPerNode = 100;
  int asked = 0;
  options.progress = [&](double share, const std::string&) {
    EXPECT_TRUE(share == 0 || share == 1) << share;
    ++asked;
    return true;
  };
  const auto whole = buildStaticLod(tiles, test::testFrame(), options);
  ASSERT_TRUE(whole);
  EXPECT_GE(asked, static_cast<int>(2 * (*whole)->index.size())) << "node by node";

  const auto lattice = toLattice(tiles, test::testFrame());
  ASSERT_TRUE(lattice);
  const int nodes = static_cast<int>((*whole)->index.size());
  for (const int last : {1, 2, nodes / 2, nodes, nodes + 1, 2 * nodes}) {
    asked = 0;
    const LodTree tree =
        buildTree(lattice->tiles[0], 100, {}, lattice->materials, [&] { return ++asked < last; });
    EXPECT_TRUE(tree.nodes.empty());
    EXPECT_EQ(asked, last) << "it went on";
  }
}

}  // namespace
}  // namespace trimtab::terrain
