#include "culling_depth.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "hidden_share.h"
#include "rough_ground.h"
#include "tests/bench/bench_scene.h"
#include "trimtab/culling/depth_map.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/frame/box_union.h"

namespace trimtab::bench {
namespace {

constexpr int kCells = RoughGround::kCells, kSide = kCells + 1, kTiles = RoughGround::kTiles;
constexpr double kPostM = RoughGround::kPostM;

/// The rough ground's tiles as occluders: all its posts, and of each cell's two diagonals the lower one, so
/// that no triangle is above the ground between them; parts of 5 x 5 cells.
class RoughMeshes {
 public:
  struct Tile {
    DepthMesh mesh;
    depth::Triangles triangles;
  };
  explicit RoughMeshes(const RoughGround& ground) : ground_(ground), tiles_(std::size_t{kTiles} * kTiles) {
    for (int row = 0; row < kTiles; ++row)
      for (int column = 0; column < kTiles; ++column)
        make(column, row, tiles_[static_cast<std::size_t>(row * kTiles + column)]);
  }
  const Tile& operator[](std::size_t tile) const { return tiles_[tile]; }

 private:
  double height(int column, int row) const {
    const auto at = [](int i) { return std::clamp(i, 0, RoughGround::kPosts - 1) * kPostM; };
    return ground_.heightAt(at(column), at(row));
  }
  double slope(int column, int row) const {
    double steepest = 0;
    for (int y = row - 3; y <= row + 3; ++y)
      for (int x = column - 3; x <= column + 3; ++x)
        steepest =
            std::max(steepest, std::hypot(std::max(std::abs(height(x + 1, y) - height(x, y)),
                                                   std::abs(height(x + 1, y + 1) - height(x, y + 1))),
                                          std::max(std::abs(height(x, y + 1) - height(x, y)),
                                                   std::abs(height(x + 1, y + 1) - height(x + 1, y)))));
    return steepest / kPostM;
  }
  void make(int column, int row, Tile& tile) const {
    DepthMesh& m = tile.mesh;
    const int c0 = column * kCells, r0 = row * kCells;
    m.origin = {(c0 + 7) * kPostM, (r0 + 7) * kPostM, 500};
    constexpr int kRing = 4 * kCells;
    m.setVertices(kSide * kSide + kRing);
    const auto at = [](int x, int y) { return static_cast<std::uint16_t>(y * kSide + x); };
    for (int y = 0; y <= kCells; ++y)
      for (int x = 0; x <= kCells; ++x)
        m.setVertex(at(x, y), static_cast<float>((x - 7) * kPostM), static_cast<float>((y - 7) * kPostM),
                    static_cast<float>(height(c0 + x, r0 + y) - 500),
                    static_cast<float>(slope(c0 + x, r0 + y)));
    std::vector<std::uint16_t> indices;
    const auto add = [&](int a, int b, int c) {
      for (const int i : {a, b, c}) indices.push_back(static_cast<std::uint16_t>(i));
    };
    for (int y = 0; y < kCells; ++y)
      for (int x = 0; x < kCells; ++x) {
        const int sw = at(x, y), se = at(x + 1, y), nw = at(x, y + 1), ne = at(x + 1, y + 1);
        const auto z = [&](int i) { return m.z[static_cast<std::size_t>(i)]; };
        if (z(sw) + z(ne) < z(se) + z(nw)) {
          add(sw, se, ne);
          add(sw, ne, nw);
        } else {
          add(sw, se, nw);
          add(se, ne, nw);
        }
      }
    for (int i = 0; i < kRing; ++i) {
      const auto on = [&](int k) {
        const int along = k % kCells;
        switch (k / kCells % 4) {
          case 0:
            return at(along, 0);
          case 1:
            return at(kCells, along);
          case 2:
            return at(kCells - along, kCells);
          default:
            return at(0, kCells - along);
        }
      };
      const std::size_t top = on(i);
      const int low = kSide * kSide + i, next = kSide * kSide + (i + 1) % kRing;
      m.setVertex(static_cast<std::size_t>(low), m.x[top], m.y[top], m.z[top] - 30, m.slope[top]);
      add(low, next, on((i + 1) % kRing));
      add(low, on((i + 1) % kRing), on(i));
    }
    m.finishVertices();
    m.reach = m.farReach = static_cast<float>(2 * kPostM);
    m.edge = static_cast<float>(std::sqrt(2.0) * kPostM);
    tile.triangles = depth::Triangles(indices);
    std::vector<Box> parts;
    for (int y = 0; y < kCells; y += kPart)
      for (int x = 0; x < kCells; x += kPart) {
        Box b = kNoBox;
        for (int j = y; j <= y + kPart; ++j)
          for (int i = x; i <= x + kPart; ++i) {
            const std::size_t v = at(i, j);
            b = united(b, m.x[v], m.y[v], m.z[v]);
          }
        parts.push_back(b);
      }
    m.setBoxes(parts);
  }
  static constexpr int kPart = 3;

  const RoughGround& ground_;
  std::vector<Tile> tiles_;
};

/// The tiles in view, nearest first.
std::vector<std::uint32_t> inView(const RoughGround& ground, const EyePose& eye, const ViewShape& view) {
  const Frustum frustum(eye, view);
  std::vector<std::pair<double, std::uint32_t>> order;
  for (std::uint32_t t = 0; t < kTiles * kTiles; ++t) {
    const Box b = ground.boxOf(t);
    if (!frustum.mayShow(b)) continue;
    const auto off = [](double at, float low, float high) {
      return std::max({double{low} - at, at - double{high}, 0.0});
    };
    order.emplace_back(std::hypot(off(eye.position.x, b.minX, b.maxX), off(eye.position.y, b.minY, b.maxY),
                                  off(eye.position.z, b.minZ, b.maxZ)),
                       t);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> tiles;
  for (const auto& [distance, tile] : order) tiles.push_back(tile);
  return tiles;
}

/// 45,000 triangles of the nearest tiles that are not hidden, and rectangles of many sizes.
void rasterRows(Report& report, const RoughGround& ground, const RoughMeshes& meshes, const ViewShape& view) {
  constexpr std::size_t kTriangles = 45000;
  RoughViews eyes(ground, 7);
  DepthMap map;
  double seconds = 0, triangles = 0;
  const int views = report.quick() ? 4 : 12;
  for (int i = 0; i < views; ++i) {
    const EyePose eye = eyes.next(100);
    std::vector<const RoughMeshes::Tile*> drawn;
    map.begin(eye, view, {640, 360});
    for (const std::uint32_t t : inView(ground, eye, view))
      if (map.triangles() < kTriangles && map.draw(meshes[t].mesh, meshes[t].triangles) == DepthFate::seen)
        drawn.push_back(&meshes[t]);
    seconds += leastSeconds(20, [&] {
      map.begin(eye, view, {640, 360});
      for (const RoughMeshes::Tile* tile : drawn) map.draw(tile->mesh, tile->triangles);
    });
    triangles += static_cast<double>(map.triangles());
  }
  map.finish();
  report.add(
      valueAtMost(0.25, {.id = "culling.map_45k",
                         .what = "Depth map of the CPU, 45,000 triangles of fractal ground lowered and "
                                 "drawn at 640 x 360",
                         .value = 1e3 * seconds / views * kTriangles * views / triangles,
                         .unit = "ms",
                         .peer = "masked occlusion culling, the slower of its two figures",
                         .peerValue = 0.25,
                         .peerFrom = "quoted"}));
  report.add(valueAtLeast(162, {.id = "culling.map_triangles",
                                .what = "The same as a rate",
                                .value = triangles / seconds * 1e-6,
                                .unit = "M triangles/s",
                                .peer = "masked occlusion culling",
                                .peerValue = 162,
                                .peerFrom = "quoted"}));
  struct Rectangle {
    int x0, y0, x1, y1;
    float limit;
  };
  std::vector<Rectangle> rectangles(4096);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (Rectangle& r : rectangles) {
    r.x0 = static_cast<int>(600 * unit(random)), r.y0 = static_cast<int>(330 * unit(random));
    r.x1 = r.x0 + static_cast<int>(40 * unit(random)), r.y1 = r.y0 + static_cast<int>(25 * unit(random));
    r.limit = static_cast<float>(1 / (200 + 8000 * unit(random)));
  }
  std::size_t covered = 0;
  const double tests = leastSeconds(20, [&] {
    for (const Rectangle& r : rectangles) covered += map.pyramid().covers(r.x0, r.y0, r.x1, r.y1, r.limit);
  });
  keep(covered);
  report.add(valueAtLeast(90, {.id = "culling.map_rectangles",
                               .what = "Rectangles of up to 40 x 25 texels held against its pyramid",
                               .value = static_cast<double>(rectangles.size()) / tests * 1e-6,
                               .unit = "M/s",
                               .peer = "masked occlusion culling",
                               .peerValue = 90,
                               .peerFrom = "quoted"}));
}

void shareRows(Report& report, const RoughGround& ground, const RoughMeshes& meshes, const ViewShape& view) {
  DepthMap map;
  for (const ShareGoal goal :
       {ShareGoal{100, 0.90, 0.78}, ShareGoal{400, 0.88, 0.65}, ShareGoal{1500, 0.60, 0.19}}) {
    RoughViews eyes(ground, 1);
    double seconds = 0;
    HiddenShare share;
    const int views = report.quick() ? 4 : 20;
    for (int i = 0; i < views; ++i) {
      const EyePose eye = eyes.next(goal.aboveM);
      const std::vector<std::uint32_t> tiles = inView(ground, eye, view);
      std::vector<DepthFate> fates(tiles.size());
      seconds += leastSeconds(5, [&] {
        map.begin(eye, view, {640, 360});
        for (std::size_t k = 0; k < tiles.size(); ++k)
          fates[k] = map.draw(meshes[tiles[k]].mesh, meshes[tiles[k]].triangles);
        map.finish();
        for (std::size_t k = 0; k < tiles.size(); ++k)
          if (fates[k] == DepthFate::seen) fates[k] = map.test(meshes[tiles[k]].mesh);
      });
      const std::vector<std::uint8_t> owns = ground.owners(eye, view);
      for (std::size_t k = 0; k < tiles.size(); ++k)
        share.add(owns[tiles[k]] != 0, fates[k] != DepthFate::seen);
    }
    report.add(
        {.id = "culling.map_" + goal.above() + "m",
         .what = "Depth map of the CPU at 640 x 360 from scratch, a view's tiles of 450 m at the finest "
                 "level drawn and tested, " +
                 goal.above() + " m above fractal ground",
         .value = 1e3 * seconds / views,
         .unit = "ms",
         .peer = "masked occlusion culling, one view of 60 degrees at 71 %",
         .peerValue = 0.97,
         .peerFrom = "quoted"});
    addShareRows(report, "culling.map", "depth map", goal, views, share, "masked occlusion culling");
  }
}

/// The stage's milliseconds by each of the maps, in turn, while the head turns.
void methodRows(Report& report) {
  const auto database = sampleTerrain(30);
  if (!database) return;
  BenchScene scene(database);
  if (!scene.ready()) return;
  auto r = scene.request();
  r.cullingCase = CullingCase::proposed;
  r.levers.drawn.occlusion = OcclusionResolution{640, 480};
  const auto cost = [&](OcclusionMethod method) {
    return [&scene, &r, method](int i) {
      auto now = r;
      now.occlusion = method;
      now.attitude.heading = Degrees{30 + 2.0 * i};
      return scene.draw(now).cost.occlusion;
    };
  };
  const int pairs = report.quick() ? 6 : 30;
  const Pairs maps = inTurn(pairs, cost(OcclusionMethod::cpu_map), cost(OcclusionMethod::depth_map));
  const std::string published = "the published form: drawn, tested and waited for by GL";
  report.add(ratioAtMost(1, rowOf(maps, {.id = "culling.map_cpu_gpu",
                                         .what = "The depth map's stage by the CPU, at 640 x 480 over the "
                                                 "sample",
                                         .peer = published})));
}

}  // namespace

void depthMapRows(Report& report) {
  const RoughGround ground;
  const RoughMeshes meshes(ground);
  const ViewShape view;
  rasterRows(report, ground, meshes, view);
  shareRows(report, ground, meshes, view);
  methodRows(report);
}

}  // namespace trimtab::bench
