#include "trimtab/terrain/static_lod/fans.h"

#include <algorithm>
#include <array>
#include <deque>
#include <random>
#include <set>

#include "static_lod_support.h"
#include "tests/support.h"
#include "trimtab/terrain/static_lod/level.h"

namespace trimtab::terrain {
namespace {

using Corners = std::array<std::uint32_t, 3>;

Corners turned(Corners t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::multiset<Corners> trianglesOf(const std::vector<std::uint32_t>& indices) {
  std::multiset<Corners> triangles;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    triangles.insert(turned({indices[i], indices[i + 1], indices[i + 2]}));
  return triangles;
}

std::multiset<Corners> trianglesOf(const std::vector<VertexRun>& runs, bool fans) {
  std::multiset<Corners> triangles;
  for (const VertexRun& run : runs)
    for (std::size_t i = 0; i + 2 < run.size(); ++i)
      if (fans)
        triangles.insert(turned({run[0], run[i + 1], run[i + 2]}));
      else
        triangles.insert(turned({run[i], run[i + 1 + i % 2], run[i + 2 - i % 2]}));
  return triangles;
}

/// The twin: looks through all triangles for each step, and keeps what it has used in a set.
class Slow {
 public:
  explicit Slow(const std::vector<std::uint32_t>& indices) {
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      triangles_.push_back({indices[i], indices[i + 1], indices[i + 2]});
  }
  std::uint64_t runs(bool fans) const {
    std::set<std::size_t> used;
    std::uint64_t count = 0;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (used.count(t) > 0) continue;
      std::set<std::size_t> best = used;
      for (std::size_t k = 0; k < 3; ++k) {
        std::set<std::size_t> with = used;
        with.insert(t);
        const std::uint32_t a = triangles_[t][k], b = triangles_[t][(k + 1) % 3],
                            c = triangles_[t][(k + 2) % 3];
        if (fans) {
          for (std::uint32_t last = c, next; find(a, last, with, next);) last = next;
          for (std::uint32_t first = b, next; find(first, a, with, next);) first = next;
        } else {
          std::uint32_t p = b, q = c, next;
          for (bool over = true; over ? find(q, p, with, next) : find(p, q, with, next); over = !over)
            p = q, q = next;
        }
        if (with.size() > best.size()) best = with;
      }
      used = best;
      ++count;
    }
    return count;
  }

 private:
  bool find(std::uint32_t a, std::uint32_t b, std::set<std::size_t>& used, std::uint32_t& third) const {
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (triangles_[t][k] == a && triangles_[t][(k + 1) % 3] == b && used.insert(t).second) {
          third = triangles_[t][(k + 2) % 3];
          return true;
        }
    return false;
  }
  std::vector<Corners> triangles_;
};

std::uint64_t slowMisses(const std::vector<std::uint32_t>& indices, std::size_t cache) {
  std::deque<std::uint32_t> held;
  std::uint64_t misses = 0;
  for (const std::uint32_t v : indices) {
    if (std::find(held.begin(), held.end(), v) != held.end()) continue;
    ++misses;
    held.push_back(v);
    if (held.size() > cache) held.pop_front();
  }
  return misses;
}

/// Two rows of quads give a strip each; the triangles around a point give a fan.
TEST(FanStatistics, knowsAStripAndAFan) {
  std::vector<std::uint32_t> band, wheel;
  for (std::uint32_t i = 0; i < 9; ++i) {
    band.insert(band.end(), {2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 2, 2 * i + 1, 2 * i + 3});
    wheel.insert(wheel.end(), {100, i, (i + 1) % 9});
  }
  EXPECT_EQ(greedyStrips(band).size(), 1u);
  EXPECT_EQ(greedyFans(wheel).size(), 1u);
  EXPECT_EQ(greedyFans(wheel)[0].size(), 11u);
  EXPECT_EQ(cacheMisses(band, 16), 20u);
  EXPECT_EQ(cacheMisses(wheel, 16), 10u);
}

TEST(FanStatistics, agreesWithTheTwinAtEveryLevel) {
  test::TinOptions options;
  options.columns = options.rows = 24;
  const auto built = test::built({test::tin("1", options)}, 150);
  ASSERT_TRUE(built);
  const StaticLodTerrain& trees = **built;
  ASSERT_GT(trees.counts.levels, 2u);
  for (std::uint32_t level = 0; level < trees.counts.levels; ++level) {
    FanStatistics slow;
    for (const std::uint32_t node : nodesOfLevel(trees, 0, level)) {
      const StaticLodRange range = trees.ranges[node];
      const auto first = trees.tiles[0].indices.begin() + std::ptrdiff_t{3} * range.firstTriangle;
      const std::vector<std::uint32_t> indices(first, first + std::ptrdiff_t{3} * range.triangles);
      EXPECT_TRUE(trianglesOf(greedyStrips(indices), false) == trianglesOf(indices));
      EXPECT_TRUE(trianglesOf(greedyFans(indices), true) == trianglesOf(indices));
      slow.triangles += range.triangles;
      slow.strips += Slow(indices).runs(false);
      slow.fans += Slow(indices).runs(true);
      slow.misses16 += slowMisses(indices, 16);
      slow.misses32 += slowMisses(indices, 32);
    }
    const FanStatistics ours = fanStatistics(trees, 0, level);
    EXPECT_EQ(ours.triangles, slow.triangles);
    EXPECT_EQ(ours.strips, slow.strips);
    EXPECT_EQ(ours.fans, slow.fans);
    EXPECT_EQ(ours.misses16, slow.misses16);
    EXPECT_EQ(ours.misses32, slow.misses32);
    EXPECT_GT(ours.trianglesPerStrip(), 1.5);
    EXPECT_GT(ours.trianglesPerFan(), 1.5);
    EXPECT_GE(ours.acmr16(), ours.acmr32());
    EXPECT_GT(ours.acmr32(), 0.5);
    EXPECT_LT(ours.acmr16(), 3);
  }
}

TEST(FanStatistics, agreesWithTheTwinOnTrianglesWithoutAnyOrder) {
  std::mt19937 random(3);
  std::uniform_int_distribution<std::uint32_t> vertex(0, 19);
  std::vector<std::uint32_t> indices;
  while (indices.size() < 900) {
    const std::uint32_t a = vertex(random), b = vertex(random), c = vertex(random);
    if (a != b && b != c && c != a) indices.insert(indices.end(), {a, b, c});
  }
  EXPECT_TRUE(trianglesOf(greedyStrips(indices), false) == trianglesOf(indices));
  EXPECT_TRUE(trianglesOf(greedyFans(indices), true) == trianglesOf(indices));
  EXPECT_EQ(greedyStrips(indices).size(), Slow(indices).runs(false));
  EXPECT_EQ(greedyFans(indices).size(), Slow(indices).runs(true));
  for (const std::size_t cache : {1u, 3u, 16u, 32u})
    EXPECT_EQ(cacheMisses(indices, cache), slowMisses(indices, cache));
}

}  // namespace
}  // namespace trimtab::terrain
