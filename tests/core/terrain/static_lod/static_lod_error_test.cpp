#include "trimtab/terrain/static_lod/error.h"

#include <algorithm>
#include <random>

#include "tests/support.h"

namespace trimtab::terrain {
namespace {

/// The same by solving for the plane's height in floating point; `margin` is how far inside the place lies.
std::optional<double> direct(const Lattice& a, const Lattice& b, const Lattice& c, const Lattice& p,
                             double& margin) {
  const auto side = [](const Lattice& u, const Lattice& v, const Lattice& w) {
    return (double(v.x) - u.x) * (double(w.y) - u.y) - (double(v.y) - u.y) * (double(w.x) - u.x);
  };
  const double area = side(a, b, c);
  if (area == 0) return std::nullopt;
  const double s = side(a, p, c) / area, t = side(a, b, p) / area;
  margin = std::min({s, t, 1 - s - t});
  if (margin < 0) return std::nullopt;
  return std::abs(a.z + s * (double(b.z) - a.z) + t * (double(c.z) - a.z) - p.z) / 256;
}

TEST(VerticalDistance, isWhatEveryTriangleInTurnSays) {
  std::mt19937 random(11);
  std::vector<Lattice> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // Overlapping, sliver-like and upright triangles, some across everything.
  for (std::uint32_t i = 0; i < 900; ++i) {
    const int reach = i % 30 == 0 ? 400000 : 30000;
    const auto about = [&](int at, int by) {
      return at + static_cast<int>(random() % (2u * unsigned(by) + 1)) - by;
    };
    const int x = about(-700000, 300000), y = about(123456, 300000);
    for (int k = 0; k < 3; ++k)
      vertices.push_back({about(x, reach), about(y, i % 7 == 0 ? 20 : reach), about(0, 60000)});
    if (i % 50 == 0) vertices.back() = {vertices[3 * i].x, vertices[3 * i].y, 5000};
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const VerticalDistance distance(vertices, triangles);
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    Lattice p{-700000 + static_cast<int>(random() % 700000) - 350000,
              123456 + static_cast<int>(random() % 700000) - 350000, 77};
    if (i % 3 == 0) p = vertices[random() % vertices.size()];
    const std::uint32_t first = i % 2 ? 0 : static_cast<std::uint32_t>(random() % 900);
    const std::uint32_t last = i % 2 ? 900 : first + static_cast<std::uint32_t>(random() % (900 - first + 1));
    std::optional<double> nearest;
    bool close = false;
    for (std::uint32_t t = first; t < last; ++t) {
      double margin = 1;
      const auto d = direct(vertices[3 * t], vertices[3 * t + 1], vertices[3 * t + 2], p, margin);
      close = close || std::abs(margin) < 1e-9;
      if (d && (!nearest || *d < *nearest)) nearest = d;
    }
    const auto found = distance.metres(p, first, last);
    if (close) continue;  // on a border: only whole numbers decide there
    ASSERT_EQ(found.has_value(), nearest.has_value()) << "place " << i;
    if (!found) continue;
    EXPECT_NEAR(*found, *nearest, 1e-6 * (1 + *nearest));
    ++hits;
  }
  EXPECT_GT(hits, 500);
}

TEST(VerticalDistance, countsBordersAsInside) {
  const std::vector<Lattice> vertices{{0, 0, 0}, {3000, 1000, 256}, {1000, 3000, 512}, {90, 30, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
  const VerticalDistance distance(vertices, triangles);
  for (const Lattice& v : {vertices[0], vertices[1], vertices[2]}) EXPECT_EQ(distance.metres(v, 0, 1), 0.0);
  EXPECT_TRUE(distance.metres({1500, 500, 0}, 0, 1));
  EXPECT_NEAR(*distance.metres({1500, 500, 128}, 0, 1), 0, 1e-12);
  EXPECT_FALSE(distance.metres({1500, 499, 0}, 0, 1));
  EXPECT_FALSE(distance.metres({1500, 500, 0}, 1, 1));
  EXPECT_FALSE(distance.metres({-2000000000, 2000000000, 0}, 0, 1));
  EXPECT_FALSE(VerticalDistance({}, {}).metres({0, 0, 0}, 0, 1));
}

}  // namespace
}  // namespace trimtab::terrain
