#include "core/terrain/static_lod/borders.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "static_lod_check.h"
#include "static_lod_support.h"
#include "tests/support.h"
#include "trimtab/culling/select_static.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

/// Static trees keep the outlines of airports within the pixels that the LOD cut allows.
namespace trimtab::terrain {
namespace {

using Place = std::array<long, 2>;  ///< seen from above, steps of 1/256 m
using Line = std::array<Place, 2>;

/// What nodes draw of some materials: the outline and the area in m^2.
struct Shape {
  std::set<Line> outline;
  double area = 0;
};

Shape shapeOf(const StaticLodTerrain& terrain, std::size_t tile, const std::vector<std::uint32_t>& nodes,
              const std::vector<std::uint8_t>& wanted) {
  std::map<Line, int> edges;
  Shape shape;
  const StaticLodTile& from = terrain.tiles[tile];
  for (const std::uint32_t node : nodes) {
    if (terrain.index.nodes[node].tile != tile) continue;
    const StaticLodRange range = terrain.ranges[node];
    for (std::uint32_t t = range.firstTriangle; t < range.firstTriangle + range.triangles; ++t) {
      if (!wanted[from.material[t]]) continue;
      std::array<Place, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        const StaticLodVertex& v = from.vertices[from.indices[3 * t + k]];
        p[k] = {std::lround(v.x * 256), std::lround(v.y * 256)};
      }
      shape.area += 0.5 / 65536 *
                    (double(p[1][0] - p[0][0]) * double(p[2][1] - p[0][1]) -
                     double(p[1][1] - p[0][1]) * double(p[2][0] - p[0][0]));
      for (std::size_t k = 0; k < 3; ++k) {
        Line line{p[k], p[(k + 1) % 3]};
        if (line[1] < line[0]) std::swap(line[0], line[1]);
        ++edges[line];
      }
    }
  }
  for (const auto& [line, uses] : edges)
    if (uses == 1) shape.outline.insert(line);
  return shape;
}

double metresTo(const Line& line, double x, double y) {
  const double ax = double(line[0][0]), ay = double(line[0][1]);
  const double dx = double(line[1][0]) - ax, dy = double(line[1][1]) - ay;
  const double t = std::clamp(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(ax + t * dx - x, ay + t * dy - y) / 256;
}

double one(double, double) {
  return 1;
}

/// Returns the largest distance from places 1 m apart on one outline to the other, by trying every pair.
/// `weight` scales it by place.
double farthest(const Shape& from, const Shape& to,
                const std::function<double(double x, double y)>& weight = one) {
  double worst = 0;
  for (const Line& line : from.outline) {
    if (to.outline.count(line)) continue;
    const double dx = double(line[1][0] - line[0][0]), dy = double(line[1][1] - line[0][1]);
    const int pieces = 1 + int(std::hypot(dx, dy) / 256);
    for (int i = 0; i <= pieces; ++i) {
      const double x = double(line[0][0]) + dx * i / pieces, y = double(line[0][1]) + dy * i / pieces;
      const double scale = weight(x / 256, y / 256);
      double nearest = INFINITY;
      for (const Line& other : to.outline) {
        nearest = std::min(nearest, scale * metresTo(other, x, y));
        if (nearest <= worst) break;
      }
      worst = std::max(worst, nearest);
    }
  }
  return worst;
}

struct Drawn {
  double outlinePx = 0, areaShare = 1;
  std::uint64_t triangles = 0;
};

/// Compares what is drawn of a tile from 1 km above its middle, where a pixel is 1 m wide, with its source.
Drawn fromAKilometre(const StaticLodTerrain& terrain, std::size_t tile, ErrorMeasure measure,
                     const std::vector<std::uint8_t>& wanted) {
  const StaticLodIndex& index = terrain.index;
  const Box& box = index.bounds[index.roots[tile]];
  const Vec3 eye{(box.minX + box.maxX) / 2.0, (box.minY + box.maxY) / 2.0, box.maxZ + 1000.0};
  LevelCut cut, source;
  selectStatic(index, staticLodError(index, measure), {1000}, eye, cut);
  selectStaticDepth(index, 255, source);
  const Shape is = shapeOf(terrain, tile, *cut.nodes, wanted),
              was = shapeOf(terrain, tile, *source.nodes, wanted);
  // An outline further away may be off by more metres: it is off by as many pixels.
  const Vec3 origin{terrain.tiles[tile].origin[0] * 16.0, terrain.tiles[tile].origin[1] * 16.0, 0};
  const auto pixels = [&](double x, double y) {
    return 1000 / std::hypot(origin.x + x - eye.x, origin.y + y - eye.y, 1000.0);
  };
  Drawn drawn{std::max(farthest(is, was, pixels), farthest(was, is, pixels)), is.area / was.area, 0};
  for (const std::uint32_t node : *cut.nodes)
    if (index.nodes[node].tile == tile) drawn.triangles += index.nodes[node].triangles;
  return drawn;
}

/// A flat airport: a runway of 45 m with a threshold of bars, a taxiway and an apron in grass.
SceneryMesh flatAirport() {
  SceneryMesh mesh = test::tin("EDXX", {.cell = 15, .columns = 180, .rows = 60, .jitter = 0},
                               [](double, double) { return 0.0; });
  mesh.materials = {"Grass", "pa_rwy", "pa_taxiway", "pa_threshold"};
  const LocalFrame frame = test::testFrame();
  for (SceneryMesh::Triangle& t : mesh.triangles) {
    Vec3 p{};
    for (const std::uint32_t v : t.vertex) p = p + frame.fromEcef(mesh.vertices[v]) * (1.0 / 3);
    const auto in = [&](double west, double south, double east, double north) {
      return p.x > west && p.x < east && p.y > south && p.y < north;
    };
    t.material = 0;
    if (in(300, 300, 2400, 315) || in(300, 300, 330, 540) || in(1200, 300, 1500, 405)) t.material = 2;
    if (in(150, 540, 2550, 585)) t.material = in(180, 540, 240, 555) || in(180, 570, 240, 585) ? 3 : 1;
  }
  return mesh;
}

TEST(StaticLodBorders, ofAFlatAirportStayWithinAPixel) {
  const auto terrain = *test::built({flatAirport()}, 400);
  const std::vector<std::uint8_t> runway{0, 1, 0, 1}, taxiway{0, 0, 1, 0};
  for (const ErrorMeasure measure : {ErrorMeasure::rms, ErrorMeasure::maximum})
    for (const auto& wanted : {runway, taxiway}) {
      const Drawn drawn = fromAKilometre(*terrain, 0, measure, wanted);
      EXPECT_LE(drawn.outlinePx, 1);
      EXPECT_NEAR(drawn.areaShare, 1, 0.02);
    }
  // Vertical error alone sees nothing on flat ground.
  const Drawn published = fromAKilometre(*terrain, 0, ErrorMeasure::as_published, runway);
  EXPECT_GT(published.outlinePx, 1);
  std::printf("as published: outline %.1f px off, %.1f %% of the area; root states %.1f m\n",
              published.outlinePx, 100 * published.areaShare, double(terrain->index.borderErrorM[0]));
}

TEST(StaticLodBorders, errorOfEveryNodeHoldsWhatItDraws) {
  const auto terrain = *test::built({flatAirport()}, 400);
  const StaticLodIndex& index = terrain->index;
  LevelCut cut, source;
  selectStaticDepth(index, 255, source);
  for (int depth = 0; depth < 4; ++depth) {
    selectStaticDepth(index, depth, cut);
    float stated = 0;
    for (const std::uint32_t node : *cut.nodes) stated = std::max(stated, index.borderErrorM[node]);
    for (const std::vector<std::uint8_t>& wanted :
         {std::vector<std::uint8_t>{1, 0, 0, 0}, {0, 1, 0, 1}, {0, 0, 1, 0}}) {
      const Shape is = shapeOf(*terrain, 0, *cut.nodes, wanted),
                  was = shapeOf(*terrain, 0, *source.nodes, wanted);
      EXPECT_LE(farthest(is, was), stated) << "depth " << depth;
    }
  }
  for (std::uint32_t i = 0; i < index.size(); ++i)
    for (const std::uint32_t child : index.nodes[i].children) {
      if (child != StaticLodIndex::kNone) {
        EXPECT_GE(index.borderErrorM[i], index.borderErrorM[child]);
      }
    }
}

/// A square of 400 m with a strip of 20 x 200 m, and a node that draws it as two triangles of one material.
struct Strip {
  Strip() {
    const auto step = [](int m) { return m * 256; };
    for (int r = 0; r <= 20; ++r)
      for (int c = 0; c <= 20; ++c) tile.vertices.push_back({step(20 * c), step(20 * r), 0});
    for (int r = 0; r < 20; ++r)
      for (int c = 0; c < 20; ++c) {
        const auto a = static_cast<std::uint32_t>(r * 21 + c);
        tile.triangles.push_back({a, a + 1, a + 22});
        tile.triangles.push_back({a, a + 22, a + 21});
        tile.material.insert(tile.material.end(), 2, r == 10 && c >= 5 && c < 15 ? 1 : 0);
      }
    for (std::uint32_t i = 0; i < tile.triangles.size(); ++i) tree.order.push_back(i);
    tree.vertices = tile.vertices;
    node.last = static_cast<std::uint32_t>(tile.triangles.size());
  }
  double errorOf(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                 const std::vector<std::uint16_t>& material) {
    node.triangles = triangles;
    node.material = material;
    return BorderMeasure(tile, tree, std::vector<std::uint8_t>{1, 1}).of(node, 0);
  }
  LatticeTile tile;
  LodTree tree;
  LodTree::Node node;
};

TEST(BorderMeasure, chargesAVanishedStripHalfItsWidthAndAMovedOneItsDistance) {
  Strip strip;
  EXPECT_EQ(strip.errorOf(strip.tile.triangles, strip.tile.material), 0);
  const std::uint32_t sw = 0, se = 20, ne = 440, nw = 420;
  EXPECT_NEAR(strip.errorOf({{sw, se, ne}, {sw, ne, nw}}, {0, 0}), 10, 0.1);
  // Half of the land is drawn as strip: the corner of the land is 200 m from the strip and as far from an
  // end.
  EXPECT_GT(strip.errorOf({{sw, se, ne}, {sw, ne, nw}}, {0, 1}), 190);
  // The strip moves north by a row.
  std::vector<std::uint16_t> moved = strip.tile.material;
  std::rotate(moved.begin(), moved.end() - 40, moved.end());
  EXPECT_NEAR(strip.errorOf(strip.tile.triangles, moved), 20, 0.1);
  // The strip is twice as long as it was.
  std::vector<std::uint16_t> longer = strip.tile.material;
  for (std::size_t c = 0; c < 30; ++c) longer[10 * 40 + c] = 1;
  EXPECT_NEAR(strip.errorOf(strip.tile.triangles, longer), 100, 15);
}

TEST(StaticLodBorders, ofOrdinaryLandDoNotCount) {
  const auto land = *test::built({test::tin("100", {})}, 100);
  for (const float error : land->index.borderErrorM) EXPECT_EQ(error, 0);
}

struct RealBorders : testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(RealBorders, ofAnAirportsPavementStayWithinAPixel) {
  const auto [folder, name] = GetParam();
  TRIMTAB_NEEDS_SHARED(std::string("data/") + folder);
  auto scenery = readScenery(test::sharedDir() / "data" / folder);
  ASSERT_TRUE(scenery);
  std::vector<SceneryMesh> airport;
  for (SceneryMesh& tile : scenery.value().tiles)
    if (tile.name == name) airport.push_back(std::move(tile));
  ASSERT_EQ(airport.size(), 1u);
  GeodeticPosition middle = toGeodetic(airport[0].vertices[0]);
  middle.height = Metres{0};
  const auto terrain = *buildStaticLod(airport, LocalFrame(middle), {});
  std::vector<std::uint8_t> pavement;
  for (const std::string& material : terrain->materials)
    pavement.push_back(material.starts_with("pa_") || material.starts_with("pc_") || material == "Asphalt");
  const Drawn published = fromAKilometre(*terrain, 0, ErrorMeasure::as_published, pavement),
              drawn = fromAKilometre(*terrain, 0, ErrorMeasure::rms, pavement);
  std::printf(
      "%s: %.2f px off and %.2f %% of the area by %llu triangles; as published %.2f px, %.2f %%, %llu\n",
      name, drawn.outlinePx, 100 * drawn.areaShare, static_cast<unsigned long long>(drawn.triangles),
      published.outlinePx, 100 * published.areaShare, static_cast<unsigned long long>(published.triangles));
  EXPECT_LE(drawn.outlinePx, 1);
  EXPECT_NEAR(drawn.areaShare, 1, 0.02);
  EXPECT_GT(published.outlinePx, 1);
}

INSTANTIATE_TEST_SUITE_P(Airports, RealBorders,
                         testing::Values(std::pair{"fg-debian-iceland-reykjanes", "BIKF"},
                                         std::pair{"fg-cologne", "EDDK"}),
                         [](const auto& set) { return std::string(set.param.second); });

}  // namespace
}  // namespace trimtab::terrain
