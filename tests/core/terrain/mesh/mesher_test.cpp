#include "trimtab/terrain/mesh/mesher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "mesher_check.h"
#include "trimtab/terrain/mesh/triangulation.h"

namespace trimtab {
namespace {

using terrain::HeightField;
using terrain::PolygonMesher;
using test::checkMesh;
using test::Field;
using test::MeshFacts;
using test::Point;

constexpr std::size_t kAny = std::size_t{1} << 40;

/// Corners joined by sides simplified to `tolerance`.
std::vector<Point> outline(const HeightField& field, const std::vector<Point>& corners, double tolerance) {
  std::vector<Point> border, side;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    terrain::simplifySide(field, corners[i], corners[(i + 1) % corners.size()], tolerance, side);
    border.insert(border.end(), side.begin(), side.end() - 1);
  }
  return border;
}

std::vector<Point> box(const HeightField& field) {
  const std::uint32_t x = field.columns - 1, y = field.rows - 1;
  return {{0, 0}, {x, 0}, {x, y}, {0, y}};
}

void expectStated(const MeshFacts& facts, const PolygonMesher& mesher, double scale) {
  EXPECT_EQ(facts.wrong, "");
  EXPECT_EQ(mesher.posts(), facts.posts);
  EXPECT_NEAR(mesher.maxErrorM(), facts.maxM, 1e-9 * scale);
  EXPECT_NEAR(mesher.rmsErrorM(), facts.rmsM, 1e-9 * scale);
}

/// Convex hull of random posts, with random posts of its sides as vertices too.
std::vector<Point> randomPolygon(std::uint32_t columns, std::uint32_t rows, std::mt19937& random) {
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  for (;;) {
    std::vector<Point> points(3 + below(12));
    for (Point& p : points) p = {below(columns), below(rows)};
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
      return a.column != b.column ? a.column < b.column : a.row < b.row;
    });
    const auto turn = [](const Point& a, const Point& b, const Point& c) {
      return (std::int64_t{b.column} - a.column) * (std::int64_t{c.row} - a.row) -
             (std::int64_t{b.row} - a.row) * (std::int64_t{c.column} - a.column);
    };
    std::vector<Point> hull;
    for (int pass = 0; pass < 2; ++pass) {
      const std::size_t base = hull.size();
      for (const Point& p : points) {
        while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
        hull.push_back(p);
      }
      hull.pop_back();
      std::reverse(points.begin(), points.end());
    }
    if (hull.size() < 3) continue;
    std::vector<Point> border;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Point a = hull[i], b = hull[(i + 1) % hull.size()];
      const std::int64_t dx = std::int64_t{b.column} - a.column, dy = std::int64_t{b.row} - a.row;
      const std::int64_t steps = std::gcd(dx, dy);
      border.push_back(a);
      const std::uint32_t share = below(4);
      for (std::int64_t k = 1; k < steps; ++k)
        if (below(4) < share)
          border.push_back({static_cast<std::uint32_t>(a.column + dx / steps * k),
                            static_cast<std::uint32_t>(a.row + dy / steps * k)});
    }
    return border;
  }
}

TEST(PolygonMesher, coversASquareOnceWithinTheTolerance) {
  const Field field = test::fractal(90, 70, 1);
  const auto border = outline(field.view(), box(field.view()), 20);
  PolygonMesher mesher;
  mesher.begin(field.view(), border);
  for (const double tolerance : {300.0, 80.0, 20.0, 5.0, 0.0}) {
    mesher.refine(tolerance, kAny);
    expectStated(checkMesh(field.view(), border, mesher), mesher, 1000);
    EXPECT_LE(mesher.maxErrorM(), std::max(tolerance, 20.0));
  }
  // Every post but those of the border.
  EXPECT_EQ(mesher.vertices().size(), 88u * 68u + border.size());
}

/// Registers differ in width from machine to machine; test_mesher_plain has none but the narrow ones.
TEST(PolygonMesher, isTheSameToTheBitOnEveryMachine) {
  const Field field(301, 263, [](int x, int y) {
    const auto noise =
        static_cast<std::uint32_t>(x) * 0x9e3779b1u ^ static_cast<std::uint32_t>(y) * 0x85ebca77u;
    const int far = (x - 140) * (x - 140) + (y - 90) * (y - 90);
    return far / 64 + static_cast<double>((noise ^ noise >> 15) % 1024) / 16;
  });
  PolygonMesher mesher;
  mesher.begin(field.view(), box(field.view()));
  for (const auto& [most, expected] : {std::pair{1500u, 11298926142334469123u}, {9000u, 14305671758051090356u}}) {
    mesher.refine(0, most);
    std::vector<std::uint32_t> indices;
    mesher.triangles(indices);
    std::uint64_t sum = 0xcbf29ce484222325u;
    const auto add = [&](std::uint32_t word) { sum = (sum ^ word) * 0x100000001b3u; };
    for (const Point& p : mesher.vertices()) add(p.column), add(p.row);
    for (const std::uint32_t index : indices) add(index);
    EXPECT_EQ(sum, expected);
  }
}

TEST(PolygonMesher, readsNothingBesideTheField) {
  // What lies between the rows of the field would be the worst error by far.
  const Field field = test::fractal(60, 50, 3);
  std::vector<float> wide(61 * 50, 1e9f);
  for (std::uint32_t y = 0; y < 50; ++y)
    for (std::uint32_t x = 0; x < 60; ++x) wide[y * 61 + x] = field.view().at(x, y);
  const HeightField view{wide.data(), 60, 50, 61};
  PolygonMesher mesher;
  mesher.begin(view, box(view));
  mesher.refine(1, kAny);
  expectStated(checkMesh(field.view(), box(view), mesher), mesher, 1000);
}

TEST(PolygonMesher, keepsAnyConvexBorder) {
  std::mt19937 random(7);
  PolygonMesher mesher;
  for (int round = 0; round < 300; ++round) {
    const std::uint32_t columns = 2 + static_cast<std::uint32_t>(random() % 40),
                        rows = 2 + static_cast<std::uint32_t>(random() % 40);
    const Field field = test::fractal(columns, rows, static_cast<std::uint32_t>(round));
    const auto border = randomPolygon(columns, rows, random);
    mesher.begin(field.view(), border);
    const double tolerance = std::ldexp(256.0, -static_cast<int>(random() % 10));
    mesher.refine(tolerance, kAny);
    SCOPED_TRACE(round);
    expectStated(checkMesh(field.view(), border, mesher), mesher, 1000);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(PolygonMesher, takesPostsFurtherApartThanBorderVertices) {
  // Every third post of a field, and border vertices at all of its places.
  std::mt19937 random(21);
  for (int round = 0; round < 100; ++round) {
    const Field field = test::fractal(64, 55, static_cast<std::uint32_t>(round));
    HeightField thin = field.view();
    thin.step = 3;
    thin.columns = 22;
    thin.rows = 19;
    std::vector<float> posts;
    for (std::uint32_t y = 0; y < 55; y += 3)
      for (std::uint32_t x = 0; x < 64; x += 3) posts.push_back(field.view().at(x, y));
    thin.z = posts.data();
    thin.stride = 22;
    const auto border = randomPolygon(64, 55, random);
    std::vector<float> borderZ;
    for (const Point& p : border) borderZ.push_back(field.view().at(p.column, p.row));
    PolygonMesher mesher;
    mesher.begin(thin, border, borderZ);
    mesher.refine(20, kAny);
    std::vector<std::uint32_t> indices;
    mesher.triangles(indices);
    std::vector<float> z = borderZ;
    for (std::size_t i = border.size(); i < mesher.vertices().size(); ++i)
      z.push_back(field.view().at(mesher.vertices()[i].column, mesher.vertices()[i].row));
    SCOPED_TRACE(round);
    expectStated(checkMesh(field.view(), border, mesher.vertices(), z, indices, 3), mesher, 1000);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(PolygonMesher, coarserMeshesAreTheFirstVerticesOfFinerOnes) {
  const Field field = test::fractal(65, 65, 3);
  const std::vector<Point> border = outline(field.view(), {{0, 0}, {64, 0}, {0, 64}}, 30);
  PolygonMesher mesher;
  mesher.begin(field.view(), border);
  std::vector<Point> before;
  for (const double tolerance : {200.0, 100.0, 50.0, 25.0}) {
    mesher.refine(tolerance, kAny);
    const std::vector<Point>& now = mesher.vertices();
    ASSERT_GE(now.size(), before.size());
    EXPECT_TRUE(std::equal(before.begin(), before.end(), now.begin()));
    before = now;
  }
  PolygonMesher again;
  again.begin(field.view(), border);
  for (const double tolerance : {200.0, 100.0, 50.0, 25.0}) again.refine(tolerance, kAny);
  EXPECT_EQ(again.vertices(), before);
}

TEST(PolygonMesher, stopsAtTheMostVertices) {
  const Field field = test::fractal(65, 65, 4);
  const auto border = outline(field.view(), box(field.view()), 30);
  PolygonMesher mesher;
  mesher.begin(field.view(), border);
  mesher.refine(0, 500);
  EXPECT_EQ(mesher.vertices().size(), 500u);
  expectStated(checkMesh(field.view(), border, mesher), mesher, 1000);
  mesher.refine(0, 600);
  EXPECT_EQ(mesher.vertices().size(), 600u);
  mesher.refine(0, 10);
  EXPECT_EQ(mesher.vertices().size(), 600u);
}

TEST(PolygonMesher, needsNoPostWhereLandIsPlane) {
  for (const double tilt : {0.0, 0.1, 1.0 / 3}) {
    const Field field(
        50, 40, [&](int x, int y) { return std::floor(1e4 + 3 * x * (tilt > 0) - 2 * y * (tilt > 0.2)); });
    PolygonMesher mesher;
    mesher.begin(field.view(), box(field.view()));
    mesher.refine(0, kAny);
    EXPECT_EQ(mesher.vertices().size(), 4u);
    EXPECT_EQ(mesher.maxErrorM(), 0);
    EXPECT_EQ(mesher.rmsErrorM(), 0);
  }
}

TEST(PolygonMesher, takesTheSmallestAndThinnestFields) {
  for (const auto& [columns, rows] : {std::pair{2u, 2u}, {2u, 300u}, {300u, 2u}, {3u, 3u}, {2u, 3u}}) {
    const Field field = test::fractal(columns, rows, 5);
    for (const double side : {0.0, 1e9}) {
      const auto border = outline(field.view(), box(field.view()), side);
      PolygonMesher mesher;
      mesher.begin(field.view(), border);
      mesher.refine(0, kAny);
      expectStated(checkMesh(field.view(), border, mesher), mesher, 1000);
    }
  }
}

TEST(PolygonMesher, takesHugeHeights) {
  std::mt19937 random(9);
  const Field field(30, 30, [&](int, int) { return (static_cast<double>(random() % 3) - 1) * 3.4e38; });
  const auto border = outline(field.view(), box(field.view()), 0);
  PolygonMesher mesher;
  mesher.begin(field.view(), border);
  mesher.refine(1e30, kAny);
  EXPECT_EQ(checkMesh(field.view(), border, mesher).wrong, "");
  EXPECT_LE(mesher.maxErrorM(), 1e30);
}

TEST(PolygonMesher, neverWrapsInAFieldOf32768Posts) {
  // Slivers across all of it, and circles far larger than it.
  const std::uint32_t size = 32768;
  std::vector<float> row(size);
  for (std::uint32_t x = 0; x < size; ++x) row[x] = static_cast<float>((x * 2654435761u) >> 22);
  // One row of heights serves as all rows.
  const HeightField field{row.data(), size, size, 0};
  const std::uint32_t last = size - 1;
  const std::vector<std::vector<Point>> polygons{
      {{0, 0}, {last, 0}, {last, 1}, {0, 1}},
      {{0, 0}, {1, 0}, {1, last}, {0, last}},
      {{0, 0}, {last, last - 1}, {last, last}},
      {{0, 0}, {last, last - 2}, {last, last}, {1, 2}},
  };
  for (const auto& border : polygons) {
    PolygonMesher mesher;
    mesher.begin(field, border);
    mesher.refine(0, 3000);
    std::vector<std::uint32_t> indices;
    mesher.triangles(indices);
    std::int64_t area = 0, wanted = 0;
    const auto& v = mesher.vertices();
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const Point &a = v[indices[i]], &b = v[indices[i + 1]], &c = v[indices[i + 2]];
      const std::int64_t here = (std::int64_t{b.column} - a.column) * (std::int64_t{c.row} - a.row) -
                                (std::int64_t{b.row} - a.row) * (std::int64_t{c.column} - a.column);
      ASSERT_GT(here, 0);
      area += here;
    }
    for (std::size_t i = 0; i < border.size(); ++i) {
      const Point &a = border[i], &b = border[(i + 1) % border.size()];
      wanted += std::int64_t{a.column} * b.row - std::int64_t{b.column} * a.row;
    }
    EXPECT_EQ(area, wanted);
  }
}

TEST(Triangulation, circleTestsDoNotWrap) {
  using Vertex = terrain::Triangulation::Vertex;
  for (const std::int32_t s : {3, 1 << 14, 32767, 1 << 20, 1 << 28}) {
    const Vertex a{0, 0, 0}, b{s, 0, 0}, c{s, s, 0};
    EXPECT_FALSE(terrain::Triangulation::inCircle(a, b, c, {0, s, 0}));
    EXPECT_TRUE(terrain::Triangulation::inCircle(a, b, c, {1, s, 0}));
    EXPECT_FALSE(terrain::Triangulation::inCircle(a, b, c, {-1, s, 0}));
    EXPECT_TRUE(terrain::Triangulation::inCircle(a, b, c, {1, 1, 0}));
  }
}

TEST(SimplifySide, keepsAllPostsWithinTheToleranceTheSameFromEitherEnd) {
  const Field field = test::fractal(129, 129, 11);
  const std::vector<std::pair<Point, Point>> sides{
      {{0, 0}, {128, 0}}, {{5, 100}, {5, 3}}, {{0, 0}, {128, 128}}, {{128, 0}, {0, 128}}, {{9, 9}, {10, 9}}};
  for (const auto& [from, to] : sides)
    for (const double tolerance : {0.0, 1.0, 30.0, 1e6}) {
      std::vector<Point> there, back;
      terrain::simplifySide(field.view(), from, to, tolerance, there);
      terrain::simplifySide(field.view(), to, from, tolerance, back);
      std::reverse(back.begin(), back.end());
      EXPECT_EQ(there, back);
      EXPECT_EQ(there.front(), from);
      EXPECT_EQ(there.back(), to);
      for (std::size_t i = 0; i + 1 < there.size(); ++i) {
        const int dx = static_cast<int>(there[i + 1].column) - static_cast<int>(there[i].column),
                  dy = static_cast<int>(there[i + 1].row) - static_cast<int>(there[i].row);
        const int steps = std::max(std::abs(dx), std::abs(dy));
        ASSERT_GT(steps, 0);
        const double a = field.view().at(there[i].column, there[i].row),
                     b = field.view().at(there[i + 1].column, there[i + 1].row);
        for (int k = 0; k <= steps; ++k) {
          const auto x = static_cast<std::uint32_t>(static_cast<int>(there[i].column) + dx / steps * k),
                     y = static_cast<std::uint32_t>(static_cast<int>(there[i].row) + dy / steps * k);
          EXPECT_LE(std::fabs(field.view().at(x, y) - (a + (b - a) * k / steps)), tolerance + 1e-9);
        }
      }
    }
}

}  // namespace
}  // namespace trimtab
