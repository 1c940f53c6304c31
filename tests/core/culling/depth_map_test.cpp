#include "trimtab/culling/depth_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "trimtab/culling/frustum.h"

namespace trimtab {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kStepM = 40;

/// A square of posts with its triangles as drawn, in tiles that may hide each other: all in double.
class Ground {
 public:
  static constexpr int kTiles = 6, kCells = 8, kPosts = kTiles * kCells + 1;
  explicit Ground(unsigned seed) : heights_(std::size_t{kPosts} * kPosts) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const double phase = 6 * unit(random), rough = 60 * unit(random);
    for (int y = 0; y < kPosts; ++y)
      for (int x = 0; x < kPosts; ++x)
        heights_[at(x, y)] =
            std::round(256 * (150 * std::sin(0.5 * x + phase) * std::cos(0.37 * y) + rough * unit(random))) /
            256;
  }
  Vec3 post(int x, int y) const { return {x * kStepM, y * kStepM, heights_[at(x, y)]}; }
  double heightNear(double x, double y) const {
    double highest = -1e9;
    for (int j = -1; j <= 2; ++j)
      for (int i = -1; i <= 2; ++i)
        highest = std::max(highest, post(std::clamp(static_cast<int>(x / kStepM) + i, 0, kPosts - 1),
                                         std::clamp(static_cast<int>(y / kStepM) + j, 0, kPosts - 1))
                                        .z);
    return highest;
  }
  /// Beside the border a texel's ray may pass by the ground.
  static bool mayOcclude(int tile) {
    const auto inside = [](int i) { return i > 0 && i + 1 < kTiles; };
    return inside(tile % kTiles) && inside(tile / kTiles);
  }
  using Triangle = std::array<Vec3, 3>;
  std::vector<Triangle> triangles(int tile) const {
    std::vector<Triangle> all;
    const int c = tile % kTiles * kCells, r = tile / kTiles * kCells;
    for (int y = r; y < r + kCells; ++y)
      for (int x = c; x < c + kCells; ++x) {
        all.push_back({post(x, y), post(x + 1, y), post(x + 1, y + 1)});
        all.push_back({post(x, y), post(x + 1, y + 1), post(x, y + 1)});
      }
    return all;
  }
  DepthMesh mesh(int tile) const {
    const int c = tile % kTiles * kCells, r = tile / kTiles * kCells;
    DepthMesh m;
    m.origin = {(c + 3) * kStepM, (r + 5) * kStepM, 16};
    m.setVertices(std::size_t{kCells + 1} * (kCells + 1));
    std::vector<Box> parts;
    const auto f = [](double v) { return static_cast<float>(v); };
    for (int y = 0; y <= kCells; ++y)
      for (int x = 0; x <= kCells; ++x) {
        const Vec3 p = post(c + x, r + y) - m.origin;
        m.setVertex(static_cast<std::size_t>(y * (kCells + 1) + x), f(p.x), f(p.y), f(p.z),
                    f(steepest(c + x, r + y)));
        if (x == kCells || y == kCells) continue;
        Box b{1e30f, 1e30f, 1e30f, -1e30f, -1e30f, -1e30f};
        for (const int j : {0, 1})
          for (const int i : {0, 1}) {
            const Vec3 q = post(c + x + i, r + y + j) - m.origin;
            b = {std::min(b.minX, f(q.x)), std::min(b.minY, f(q.y)), std::min(b.minZ, f(q.z)),
                 std::max(b.maxX, f(q.x)), std::max(b.maxY, f(q.y)), std::max(b.maxZ, f(q.z))};
          }
        parts.push_back(b);
      }
    m.finishVertices();
    m.setBoxes(parts);
    m.reach = f(2 * kStepM);
    m.farReach = f(4 * kStepM);
    m.farSlope = f(steepestOfAll());
    m.edge = f(1.42 * kStepM);
    return m;
  }
  static depth::Triangles indices() {
    std::vector<std::uint16_t> all;
    const auto add = [&](int x, int y) { all.push_back(static_cast<std::uint16_t>(y * (kCells + 1) + x)); };
    for (int y = 0; y < kCells; ++y)
      for (int x = 0; x < kCells; ++x) {
        for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
          add(x + i, y + j);
      }
    return depth::Triangles(all);
  }

 private:
  static std::size_t at(int x, int y) {
    return static_cast<std::size_t>(y) * kPosts + static_cast<std::size_t>(x);
  }
  double slopeOf(int x, int y) const {
    if (x < 0 || y < 0 || x + 1 >= kPosts || y + 1 >= kPosts) return 0;
    const double a = post(x, y).z, b = post(x + 1, y).z, c = post(x + 1, y + 1).z, d = post(x, y + 1).z;
    return std::max(std::hypot(b - a, c - b), std::hypot(d - a, c - d)) / kStepM;
  }
  double steepest(int x, int y) const {
    double most = 0;
    for (int j = y - 4; j <= y + 3; ++j)
      for (int i = x - 4; i <= x + 3; ++i) most = std::max(most, slopeOf(i, j));
    return most;
  }
  double steepestOfAll() const {
    double most = 0;
    for (int j = 0; j < kPosts; ++j)
      for (int i = 0; i < kPosts; ++i) most = std::max(most, slopeOf(i, j));
    return most;
  }
  std::vector<double> heights_;
};

EyePose pose(Vec3 position, double heading, double pitch, double roll) {
  const double h = heading, p = pitch;
  const Vec3 forward{std::cos(p) * std::sin(h), std::cos(p) * std::cos(h), std::sin(p)};
  const Vec3 side{std::cos(h), -std::sin(h), 0}, above = cross(side, forward);
  const Vec3 right = side * std::cos(roll) + above * std::sin(roll),
             up = above * std::cos(roll) - side * std::sin(roll);
  return {position, {{right, up, -forward}}};
}

/// For each pixel of the picture the nearest surface's depth, infinite where there is none, and whose it is.
struct Truth {
  std::vector<double> depth;
  std::vector<int> owner;
  int width, height;
  Truth(const Ground& ground, const EyePose& eye, const ViewShape& view)
      : depth(static_cast<std::size_t>(view.widthPx * view.heightPx),
              std::numeric_limits<double>::infinity()),
        owner(depth.size(), -1),
        width(view.widthPx),
        height(view.heightPx) {
    for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile)
      for (const Ground::Triangle& t : ground.triangles(tile)) add(t, tile, eye, view);
  }

 private:
  void add(const Ground::Triangle& t, int tile, const EyePose& eye, const ViewShape& view) {
    std::array<Vec3, 3> c;
    int x0 = 0, x1 = width - 1, y0 = 0, y1 = height - 1;
    double lowX = 1e9, highX = -1e9, lowY = 1e9, highY = -1e9, nearest = 1e9;
    for (std::size_t k = 0; k < 3; ++k) {
      c[k] = eye.axes * (t[k] - eye.position);
      nearest = std::min(nearest, -c[k].z);
      const double x = c[k].x / -c[k].z, y = c[k].y / -c[k].z;
      lowX = std::min(lowX, x), highX = std::max(highX, x), lowY = std::min(lowY, y),
      highY = std::max(highY, y);
    }
    if (nearest > 0.1) {
      const auto pixel = [](double v, double from, double to, int n, int more) {
        return static_cast<int>(std::clamp(std::floor((v - from) / (to - from) * n) + more, 0.0, n - 1.0));
      };
      x0 = pixel(lowX, view.left, view.right, width, -1), x1 = pixel(highX, view.left, view.right, width, 1);
      y0 = pixel(lowY, view.bottom, view.top, height, -1),
      y1 = pixel(highY, view.bottom, view.top, height, 1);
    }
    const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const Vec3 ray{view.left + (view.right - view.left) * (x + 0.5) / width,
                       view.bottom + (view.top - view.bottom) * (y + 0.5) / height, -1};
        const double z = dot(n, c[0]) / dot(n, ray);
        if (!(z > view.nearM)) continue;
        const Vec3 p = ray * z;
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k)
          inside = inside && dot(cross(c[(k + 1) % 3] - c[k], p - c[k]), n) >= 0;
        const auto i = static_cast<std::size_t>(y * width + x);
        if (inside && z < depth[i]) depth[i] = z, owner[i] = tile;
      }
  }
};

struct View {
  EyePose eye;
  ViewShape shape;
  int width, height;  ///< of the map
};
View randomView(const Ground& ground, std::mt19937& random, int i) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double side = (Ground::kPosts - 1) * kStepM, x = side * (0.25 + 0.5 * unit(random)),
               y = side * (0.25 + 0.5 * unit(random));
  View v{pose({x, y, ground.heightNear(x, y) + 3 + 250 * unit(random) * unit(random)}, 6.28 * unit(random),
              i % 4 == 3 ? -1.2 + 0.5 * unit(random) : -0.35 + 0.4 * unit(random),
              i % 3 == 2 ? 6.28 * unit(random) : 0),
         {},
         0,
         0};
  v.shape.widthPx = 200, v.shape.heightPx = 112;
  if (i % 5 == 4) v.shape.left = -0.2, v.shape.right = 0.9, v.shape.bottom = -0.6, v.shape.top = 0.1;
  constexpr std::array<std::pair<int, int>, 6> kSizes{
      {{100, 56}, {50, 28}, {64, 48}, {200, 112}, {33, 77}, {320, 240}}};
  std::tie(v.width, v.height) = kSizes[static_cast<std::size_t>(i) % kSizes.size()];
  return v;
}

struct Tally {
  std::size_t nearer = 0, covered = 0, coverable = 0, hidden = 0, wrong = 0, trulyHidden = 0;
};
Box boxOf(const DepthMesh& m) {
  const auto f = [&](std::size_t side, double origin) {
    return static_cast<float>(double{m.boxes[side][0]} + origin);
  };
  return {f(0, m.origin.x), f(1, m.origin.y), f(2, m.origin.z),
          f(3, m.origin.x), f(4, m.origin.y), f(5, m.origin.z)};
}
Tally fly(int views, double lowering) {
  Tally tally;
  std::mt19937 random(5);
  const depth::Triangles indices = Ground::indices();
  DepthMap map;
  for (int i = 0; i < views; ++i) {
    const Ground ground(static_cast<unsigned>(i));
    const View v = randomView(ground, random, i);
    const Truth truth(ground, v.eye, v.shape);
    map.begin(v.eye, v.shape, {v.width, v.height, lowering});
    std::vector<DepthMesh> meshes;
    for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile) meshes.push_back(ground.mesh(tile));
    std::vector<DepthFate> fates(meshes.size(), DepthFate::seen);
    for (std::size_t t = 0; t < meshes.size(); ++t)
      if (Ground::mayOcclude(static_cast<int>(t))) fates[t] = map.draw(meshes[t], indices);
    map.finish();
    for (std::size_t t = 0; t < meshes.size(); ++t)
      if (fates[t] == DepthFate::seen) fates[t] = map.test(meshes[t]);
    const Frustum frustum(v.eye, v.shape);
    std::vector<bool> owns(meshes.size());
    for (int y = 0; y < truth.height; ++y)
      for (int x = 0; x < truth.width; ++x) {
        const auto pixel = static_cast<std::size_t>(y * truth.width + x);
        const int tx = static_cast<int>((x + 0.5) * v.width / truth.width),
                  ty = static_cast<int>((y + 0.5) * v.height / truth.height);
        const double shown = double{map.pyramid().depths()[static_cast<std::size_t>(ty * v.width + tx)]};
        const bool there = std::isfinite(truth.depth[pixel]);
        if (there) owns[static_cast<std::size_t>(truth.owner[pixel])] = true;
        tally.coverable += there;
        tally.covered += shown > 0;
        tally.nearer += shown > 0 && !(truth.depth[pixel] <= v.shape.nearM / shown * 1.0001);
      }
    for (std::size_t t = 0; t < meshes.size(); ++t) {
      const bool left = fates[t] != DepthFate::seen;
      tally.wrong += left && owns[t];
      if (!frustum.mayShow(boxOf(meshes[t]))) continue;
      tally.hidden += left;
      tally.trulyHidden += !owns[t];
    }
  }
  return tally;
}

TEST(DepthMap, isNowhereNearerThanAnyPixelOfItsTexels) {
  const Tally tally = fly(24, 1);
  EXPECT_EQ(tally.nearer, 0u) << "of " << tally.covered;
  EXPECT_EQ(tally.wrong, 0u) << "of " << tally.hidden;
  EXPECT_GT(tally.covered * 10, tally.coverable * 5) << "it covers hardly anything";
  EXPECT_GT(tally.hidden * 10, tally.trulyHidden * 3) << "it hides hardly anything";
}

// Without this, the test above might pass because nothing can go wrong where it looks.
TEST(DepthMap, isNearerWhereNothingIsLowered) {
  EXPECT_GT(fly(6, 0).nearer, 20u);
}

TEST(DepthMap, isTheSameWhateverTheProcessorHas) {
  std::mt19937 random(9);
  const depth::Triangles indices = Ground::indices();
  for (int i = 0; i < 24; ++i) {
    const Ground ground(static_cast<unsigned>(i));
    const View v = randomView(ground, random, i);
    std::vector<float> first;
    std::vector<DepthFate> fates;
    for (const SimdLevel level : {SimdLevel::portable, SimdLevel::avx2, SimdLevel::avx512}) {
      DepthMap map;
      map.begin(v.eye, v.shape, {v.width, v.height, 1, level});
      std::vector<DepthFate> now;
      for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile)
        now.push_back(map.draw(ground.mesh(tile), indices));
      map.finish();
      for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile)
        now.push_back(map.test(ground.mesh(tile)));
      const std::vector<float> depths(map.pyramid().depths().begin(), map.pyramid().depths().end());
      if (level == SimdLevel::portable) first = depths, fates = now;
      ASSERT_EQ(depths, first) << i;
      ASSERT_EQ(now, fates) << i;
    }
  }
}

/// Triangles by themselves, looked at along +y from the origin with a texel at a depth of 1 being 1/50.
class DepthRaster : public testing::Test {
 protected:
  static constexpr int kWidth = 100, kHeight = 60;
  DepthRaster() {
    view.left = -1, view.right = 1, view.bottom = -0.6, view.top = 0.6;
    view.widthPx = kWidth, view.heightPx = kHeight;
  }
  using Corners = std::array<Vec3, 3>;  ///< texel x and y, depth in metres
  static Vec3 place(Vec3 c) {
    return {(c.x - kWidth / 2.0) / 50 * c.z, c.z, (c.y - kHeight / 2.0) / 50 * c.z};
  }
  void draw(const std::vector<Corners>& triangles) {
    DepthMesh mesh;
    mesh.setVertices(3 * triangles.size());
    std::vector<std::uint16_t> indices;
    for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
      const Vec3 p = place(triangles[i / 3][i % 3]);
      mesh.setVertex(i, static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 0);
      indices.push_back(static_cast<std::uint16_t>(i));
    }
    mesh.finishVertices();
    mesh.reach = mesh.farReach = 1e9f;
    mesh.setBoxes(std::vector<Box>{{-1e6f, 0, -1e6f, 1e6f, 1e6f, 1e6f}});
    map.begin(pose({0, 0, 0}, 0, 0, 0), view, {kWidth, kHeight, 0});
    map.draw(mesh, depth::Triangles(indices));
    map.finish();
  }
  double at(int x, int y) const {
    return double{map.pyramid().depths()[static_cast<std::size_t>(y * kWidth + x)]};
  }
  std::size_t covered() const {
    return static_cast<std::size_t>(std::count_if(
        map.pyramid().depths().begin(), map.pyramid().depths().end(), [](float d) { return d > 0; }));
  }

  /// near / depth of the triangle's nearest point to a place, if that is within `reach` texels; else 0.
  static double twin(const Corners& t, double x, double y, double reach) {
    const auto w = [&](std::size_t k) { return 1 / t[k].z; };
    const double area = (t[1].x - t[0].x) * (t[2].y - t[0].y) - (t[2].x - t[0].x) * (t[1].y - t[0].y);
    if (!(area > 0)) return 0;
    double best = 1e9, depth = 0;
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = t[k], &b = t[(k + 1) % 3];
      const double dx = b.x - a.x, dy = b.y - a.y, size = dx * dx + dy * dy;
      inside = inside && dx * (y - a.y) - dy * (x - a.x) >= 0;
      const double along = size > 0 ? std::clamp(((x - a.x) * dx + (y - a.y) * dy) / size, 0.0, 1.0) : 0;
      const double off = std::hypot(a.x + along * dx - x, a.y + along * dy - y);
      if (off < best) best = off, depth = w(k) + along * (w((k + 1) % 3) - w(k));
    }
    if (!inside) return best <= reach ? depth : 0;
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
      sum += ((b.x - x) * (c.y - y) - (c.x - x) * (b.y - y)) / area * w(k);
    }
    return sum;
  }

  ViewShape view;
  DepthMap map;
};

TEST_F(DepthRaster, isNowhereNearerThanATwinInDoublePrecision) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t shown = 0, missed = 0, shouldBe = 0;
  for (int round = 0; round < 150; ++round) {
    std::vector<Corners> triangles;
    for (int i = 0; i < 12; ++i) {
      Corners t;
      const double size = std::pow(10, -1 + 3.5 * unit(random));
      const Vec3 middle{140 * unit(random) - 20, 90 * unit(random) - 15, 0};
      for (Vec3& c : t)
        c = middle + Vec3{size * (unit(random) - 0.5), size * (unit(random) - 0.5),
                          std::pow(10, 0.5 + 3.5 * unit(random))};
      // Slivers, and edge-on ones.
      if (i % 4 == 1)
        t[2] = t[0] + (t[1] - t[0]) * unit(random) + Vec3{1e-3 * unit(random), 1e-3 * unit(random), 0};
      if (i % 4 == 2) t[1].z = t[0].z * (1 + 1e-3 * unit(random)), t[2].z = t[0].z;
      triangles.push_back(t);
    }
    draw(triangles);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        double nearest = 0, certain = 0;
        for (const Corners& t : triangles) {
          nearest = std::max(nearest, twin(t, x + 0.5, y + 0.5, 0.02));
          certain = std::max(certain, twin(t, x + 0.5, y + 0.5, 0));
        }
        ASSERT_LE(at(x, y), nearest * (1 + 1e-5)) << round << ": " << x << ", " << y;
        shown += at(x, y) > 0;
        shouldBe += certain > 0;
        missed += certain > 0 && !(at(x, y) > 0);
      }
  }
  EXPECT_GT(shown, 100000u);
  EXPECT_LT(missed * 1000, shouldBe) << "there are holes";
}

TEST_F(DepthRaster, cutsWhatReachesBehindTheEye) {
  // A floor 2 m under the eye, from behind it to 200 m ahead.
  DepthMesh floor;
  floor.setVertices(4);
  floor.setVertex(0, -500, -300, -2, 0);
  floor.setVertex(1, 500, -300, -2, 0);
  floor.setVertex(2, 500, 200, -2, 0);
  floor.setVertex(3, -500, 200, -2, 0);
  floor.finishVertices();
  floor.reach = floor.farReach = 1e9f;
  floor.setBoxes(std::vector<Box>{{-500, -300, -2, 500, 200, -2}});
  map.begin(pose({0, 0, 0}, 0, 0, 0), view, {kWidth, kHeight, 0});
  EXPECT_EQ(map.draw(floor, depth::Triangles(std::array<std::uint16_t, 6>{0, 1, 2, 0, 2, 3})),
            DepthFate::seen);
  map.finish();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double down = (kHeight / 2.0 - y - 0.5) / 50, depth = 2 / down;
      if (down <= 0 || depth > 198) {
        EXPECT_LE(at(x, y), 1 / 198.0) << x << ", " << y;
      } else {
        EXPECT_LE(at(x, y), 1.00001 / depth) << x << ", " << y;
        EXPECT_GT(at(x, y), 0.9 / depth - 0.001) << x << ", " << y;
      }
    }
}

TEST_F(DepthRaster, coversNothingWithWhatIsNoTriangle) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Corners good{Vec3{10, 10, 100}, Vec3{90, 10, 100}, Vec3{50, 50, 100}};
  draw({good});
  EXPECT_GT(covered(), 1000u);
  for (const Vec3& bad : {Vec3{nan, 10, 100}, Vec3{50, nan, 100}, Vec3{50, 50, nan}, Vec3{inf, 10, 100},
                          Vec3{50, 50, inf}, Vec3{50, 50, -inf}, Vec3{1e30, 1e30, 1e9}}) {
    for (std::size_t k = 0; k < 3; ++k) {
      Corners t = good;
      t[k] = bad;
      draw({t});
      EXPECT_EQ(covered(), 0u) << bad.x << ", " << bad.y << ", " << bad.z << " at " << k;
    }
  }
  draw({{good[0], good[0], good[1]},
        {good[0], good[1], good[1]},
        {good[0], good[1], (good[0] + good[1]) * 0.5}});
  EXPECT_EQ(covered(), 0u) << "a triangle without a surface";
  draw({{good[0], good[2], good[1]}});
  EXPECT_EQ(covered(), 0u) << "from behind";
  draw({{Vec3{10, 10, -100}, Vec3{90, 10, -100}, Vec3{50, 50, -100}}});
  EXPECT_EQ(covered(), 0u) << "behind the eye";
}

TEST(DepthMap, hidesNothingForViewsThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Ground ground(1);
  const depth::Triangles indices = Ground::indices();
  const EyePose good = pose({640, 640, 400}, 0.3, -0.3, 0);
  struct Case {
    const char* what;
    std::function<void(EyePose&, ViewShape&, DepthMap::Settings&)> change;
  };
  const std::vector<Case> cases{
      {"an eye that is no place", [&](auto& e, auto&, auto&) { e.position.x = nan; }},
      {"an infinite eye",
       [&](auto& e, auto&, auto&) { e.position.z = std::numeric_limits<double>::infinity(); }},
      {"no direction",
       [&](auto& e, auto&, auto&) {
         e.axes.row[0] = e.axes.row[1] = e.axes.row[2] = {nan, nan, nan};
       }},
      {"half a direction",
       [&](auto& e, auto&, auto&) {
         e.axes.row[0] = {nan, nan, nan};
       }},
      {"no field of view", [&](auto&, auto& v, auto&) { v.left = v.right = 0; }},
      {"none either way", [&](auto&, auto& v, auto&) { v.left = v.right = v.bottom = v.top = 0; }},
      {"sides that are no numbers",
       [&](auto&, auto& v, auto&) { v.left = v.right = v.bottom = v.top = nan; }},
      {"no near plane", [&](auto&, auto& v, auto&) { v.nearM = nan; }},
      {"no map", [&](auto&, auto&, auto& s) { s.width = 0; }},
      {"less than none", [&](auto&, auto&, auto& s) { s.width = -5, s.height = -7; }},
  };
  for (const Case& c : cases) {
    EyePose eye = good;
    ViewShape view;
    DepthMap::Settings settings{100, 60};
    c.change(eye, view, settings);
    DepthMap map;
    map.begin(eye, view, settings);
    for (int pass = 0; pass < 2; ++pass)
      for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile)
        EXPECT_NE(map.draw(ground.mesh(tile), indices), DepthFate::hidden) << c.what;
    map.finish();
    for (int tile = 0; tile < Ground::kTiles * Ground::kTiles; ++tile)
      EXPECT_NE(map.test(ground.mesh(tile)), DepthFate::hidden) << c.what;
  }
}

TEST(DepthMap, neverHidesAMeshThatIsNotOfNumbers) {
  const Ground ground(2);
  const depth::Triangles indices = Ground::indices();
  // A wall before everything.
  DepthMesh wall;
  wall.setVertices(4);
  wall.setVertex(0, -1e4f, 20, -1e4f, 0);
  wall.setVertex(1, 1e4f, 20, -1e4f, 0);
  wall.setVertex(2, 1e4f, 20, 1e4f, 0);
  wall.setVertex(3, -1e4f, 20, 1e4f, 0);
  wall.finishVertices();
  wall.reach = wall.farReach = 1e9f;
  wall.setBoxes(std::vector<Box>{{-1e4f, 20, -1e4f, 1e4f, 20, 1e4f}});
  DepthMap map;
  map.begin(pose({640, -200, 100}, 0, 0, 0), {}, {200, 100, 0});
  wall.origin = {640, -200, 100};
  map.draw(wall, depth::Triangles(std::array<std::uint16_t, 6>{0, 1, 2, 0, 2, 3}));
  map.finish();
  DepthMesh mesh = ground.mesh(14);
  ASSERT_EQ(map.test(mesh), DepthFate::hidden);
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, inf, -inf}) {
    std::vector<Box> parts{{0, 0, 0, 1, 1, 1}, {0, 0, 0, 1, 1, bad}};
    mesh.setBoxes(parts);
    EXPECT_EQ(map.test(mesh), DepthFate::seen) << bad;
    EXPECT_EQ(map.draw(mesh, indices), DepthFate::seen) << bad;
  }
  mesh.setBoxes({});
  EXPECT_EQ(map.test(mesh), DepthFate::seen) << "nothing is known of it";
  mesh = ground.mesh(14);
  mesh.origin.y = -400;
  EXPECT_NE(map.test(mesh), DepthFate::hidden) << "the eye is in its box";
}

}  // namespace
}  // namespace trimtab
