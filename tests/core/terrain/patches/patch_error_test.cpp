#include <GeographicLib/LocalCartesian.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>

#include "core/terrain/patches/scan.h"
#include "patch_support.h"
#include "trimtab/terrain/format/patch_layout.h"

namespace trimtab::terrain {
namespace {

/// Where a post is, and its vertical, by GeographicLib.
struct Truth {
  GeographicLib::LocalCartesian frame;
  const HeightGrid& grid;
  explicit Truth(const HeightGrid& of, const LocalFrame& at)
      : frame(at.origin().latitude.value(), at.origin().longitude.value(), 0), grid(of) {}
  Vec3 at(std::uint32_t column, std::uint32_t row, double above) const {
    const double height = grid.heights[std::size_t{row} * grid.posts.columns + column];
    Vec3 p;
    frame.Forward(grid.posts.latitude(row), grid.posts.longitude(column), height + above, p.x, p.y, p.z);
    return p;
  }
};

/// How far along the vertical of a post a patch's variant is; negative: the vertical misses it.
double offAlongVertical(const PatchMesh& mesh, std::size_t variant, Vec3 post, Vec3 up) {
  const auto place = [&](std::uint32_t i) {
    const PatchVertex& v = mesh.vertices[i];
    return Vec3{mesh.origin[0] * 16.0 + v.x, mesh.origin[1] * 16.0 + v.y, mesh.origin[2] * 16.0 + v.z} - post;
  };
  for (std::uint32_t i = mesh.firstIndex[variant]; i < mesh.firstIndex[variant + 1]; i += 3) {
    const Vec3 a = place(mesh.indices[i]), b = place(mesh.indices[i + 1]), c = place(mesh.indices[i + 2]);
    // Volumes of the vertical with each edge: of one sign where it goes through.
    const double u = dot(up, cross(a, b)), v = dot(up, cross(b, c)), w = dot(up, cross(c, a));
    if (u < 0 || v < 0 || w < 0 || u + v + w <= 0) continue;
    const Vec3 normal = cross(b - a, c - a);
    return std::abs(dot(a, normal) / dot(up, normal));
  }
  return -1;
}

constexpr std::uint32_t kLeafCells[] = {kFineLeafCells, kCoarseLeafCells};

/// Holds stated errors against posts, all of small patches and some of large ones.
void expectBound(const char* what, const HeightGrid& grid, std::uint32_t leafCells, double tightness) {
  const GridHeights heights(grid);
  const PostGeometry geometry(grid.posts);
  const PatchIndex index = makePatchIndex(grid.posts, geometry, leafCells);
  const std::vector<double> tolerances = patchTolerances(index, defaultLeafToleranceM(grid.posts));
  const Truth truth(grid, index.frame);
  std::mt19937 random(5);
  std::size_t hits = 0, misses = 0;
  double sumStated = 0, sumTrue = 0;
  for (std::uint32_t page = 0; page < index.pages.size(); ++page) {
    const BuiltPage built = buildPage(index, page, heights, geometry, tolerances);
    const auto places = placesOfPage(index, index.pages[page]);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (index.size() > 200 && random() % (index.size() / 100) != 0) continue;
      const auto edges = patchEdges(index, places[i]);
      std::vector<PatchPoint> posts;
      std::uint32_t c0 = ~0u, c1 = 0, r0 = ~0u, r1 = 0;
      for (const PatchEdge& e : edges) {
        c0 = std::min(c0, e.from.column), c1 = std::max(c1, e.from.column);
        r0 = std::min(r0, e.from.row), r1 = std::max(r1, e.from.row);
      }
      const auto inside = [&](PatchPoint p) {
        for (const PatchEdge& e : edges)
          if ((std::int64_t{e.to.column} - e.from.column) * (std::int64_t{p.row} - e.from.row) <
              (std::int64_t{e.to.row} - e.from.row) * (std::int64_t{p.column} - e.from.column))
            return false;
        return true;
      };
      const bool small = std::size_t{c1 - c0 + 1} * (r1 - r0 + 1) < 1200;
      if (small) {
        for (std::uint32_t r = r0; r <= r1; ++r)
          for (std::uint32_t c = c0; c <= c1; ++c)
            if (inside({c, r})) posts.push_back({c, r});
      } else {
        while (posts.size() < 500) {
          const PatchPoint p{c0 + static_cast<std::uint32_t>(random() % (c1 - c0 + 1)),
                             r0 + static_cast<std::uint32_t>(random() % (r1 - r0 + 1))};
          if (inside(p)) posts.push_back(p);
        }
      }
      for (std::size_t v = 0; v < index.variants(); ++v) {
        double worst = 0;
        for (const PatchPoint& p : posts) {
          const Vec3 post = truth.at(p.column, p.row, 0);
          const double off = offAlongVertical(built.meshes.patches[i], v, post,
                                              normalized(truth.at(p.column, p.row, 1000) - post));
          ++(off < 0 ? misses : hits);
          worst = std::max(worst, off);
        }
        ASSERT_LE(worst, built.errorM[i][v]) << what << " page " << page << " patch " << i << " variant " << v
                                             << " depth " << places[i].depth();
        if (small) sumStated += built.errorM[i][v], sumTrue += worst;
      }
    }
  }
  // Verticals of posts on a border may pass it by: by millimetres.
  EXPECT_LT(misses, hits / 4) << what;
  if (tightness > 0) {
    EXPECT_LT(sumStated, tightness * sumTrue) << what;
  }
}

/// No post can be farther from a patch's surface than its posts differ in height, plus the sag of its
/// triangles below the curved earth: a chord triangle with edges up to e metres sags by at most e^2 / 6R.
/// Coasts of ice that rise within one post once made large patches state far more.
TEST(PatchErrors, neverExceedReliefAndSagOfAnIceCap) {
  for (const PostGrid& posts : {PostGrid{-50, 60, 0.25, 0.1, 121, 131}, PostGrid{-60, 40, 0.2, 0.2, 141, 101},
                                PostGrid{-20, 63.5, 0.01, 0.005, 401, 401}})
    for (const std::uint32_t leafCells : kLeafCells) {
      const HeightGrid grid = test::gridOf(posts, [&](std::uint32_t c, std::uint32_t r) {
        const double x = 2.0 * c / posts.columns - 1, y = 2.0 * r / posts.rows - 1, d = x * x + y * y;
        return d >= 0.8 ? 0.0 : 3673 * std::sqrt(1 - d);
      });
      const PostGeometry geometry(grid.posts);
      const PatchIndex index = makePatchIndex(grid.posts, geometry, leafCells);
      for (std::uint32_t page = 0; page < index.pages.size(); ++page) {
        const BuiltPage built = buildPage(index, page, GridHeights(grid), geometry,
                                          patchTolerances(index, defaultLeafToleranceM(posts)));
        const auto places = placesOfPage(index, index.pages[page]);
        for (std::size_t i = 0; i < places.size(); ++i) {
          const PatchMesh& mesh = built.meshes.patches[i];
          const auto place = [&](std::uint32_t v) {
            return Vec3{mesh.vertices[v].x, mesh.vertices[v].y, mesh.vertices[v].z};
          };
          double longest = 0;
          for (std::size_t v = 0; v < index.variants(); ++v) {
            for (std::uint32_t k = mesh.firstIndex[v]; k < mesh.firstIndex[v + 1]; k += 3)
              for (std::uint32_t e = 0; e < 3; ++e) {
                const Vec3 edge = place(mesh.indices[k + e]) - place(mesh.indices[k + (e + 1) % 3]);
                longest = std::max(longest, dot(edge, edge));
              }
            const double relief = double{built.facts[i].highestM} - built.facts[i].lowestM;
            EXPECT_LE(built.errorM[i][v], relief + 2 * longest / (6 * 6.35e6) + 1)
                << posts.south << " degrees, depth " << places[i].depth() << " variant " << v << " relief "
                << relief << " sag " << longest / (6 * 6.35e6);
          }
        }
      }
    }
}

TEST(PatchErrors, boundTheTrueDistanceAlongTheVerticalOnEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest/N27E086.hgt");
  const HeightGrid grid = test::imported("data/dem-srtm3-everest/N27E086.hgt");
  for (const std::uint32_t leafCells : kLeafCells) expectBound("Everest", grid, leafCells, 1.03);
}
TEST(PatchErrors, boundItOnBigTujunga) {
  TRIMTAB_NEEDS_SHARED("data/dem-30m-bigtujunga/bigtujunga.tif");
  const HeightGrid grid = test::imported("data/dem-30m-bigtujunga/bigtujunga.tif");
  for (const std::uint32_t leafCells : kLeafCells) expectBound("Big Tujunga", grid, leafCells, 1.03);
}
TEST(PatchErrors, boundItWhereTheEarthIsAwkward) {
  const auto cliff = [](std::uint32_t c, std::uint32_t r) {
    return c > 90 && r > 40 + c % 7 ? 8000.0 : c > 80 ? (c * 131 + r * 57) % 97 : 0.0;
  };
  const struct {
    const char* what;
    PostGrid posts;
    bool sea;
  } cases[] = {
      {"the pole", {-10, -90, 0.1, 0.01, 201, 101}, false},
      {"near the pole", {100, 89, 0.05, 0.005, 131, 121}, false},
      {"across the date line", {179.5, -20, 0.01, 0.01, 101, 101}, false},
      {"far from the origin", {-3, 45, 0.004, 0.003, 1001, 701}, false},
      {"a sea with cliffs", {5, 55, 0.001, 0.001, 201, 201}, true},
      {"a wide sea", {5, 55, 0.01, 0.01, 401, 301}, true},
  };
  for (const auto& at : cases)
    for (const std::uint32_t leafCells : kLeafCells)
      expectBound(at.what, at.sea ? test::gridOf(at.posts, cliff) : test::fractal(at.posts, 9, 6000),
                  leafCells, 0);
}

class PatchErrorsOf : public ::testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(EitherSide, PatchErrorsOf, ::testing::ValuesIn(kLeafCells));

TEST_P(PatchErrorsOf, areNoneWithoutATolerance) {
  const PostGrid posts{10, 45, 0.001, 0.001, 70, 50};
  const HeightGrid grid = test::fractal(posts, 4);
  const test::WholeTerrain terrain = test::built(grid, 0, GetParam());
  const PatchIndex& index = terrain.index();
  for (std::uint32_t p = 0; p < index.size(); ++p) {
    if (index.children[p][0] != PatchIndex::kNone) continue;
    // Posts that are linear between their neighbours need not be vertices: nearly none here.
    const PatchFacts& facts = terrain.terrain->facts()[p];
    EXPECT_LT(index.errorM[p][0], 0.1) << p;  // the rounding of places, on slopes
    EXPECT_GE(facts.vertices, facts.posts * 9 / 10);
  }
}

TEST_P(PatchErrorsOf, riseWithVariantAndUpTheTree) {
  const PostGrid posts{10, 45, 0.001, 0.001, 400, 300};
  const test::WholeTerrain terrain =
      test::built(test::fractal(posts, 4), defaultLeafToleranceM(posts), GetParam());
  const PatchIndex& index = terrain.index();
  const std::size_t variants = index.variants();
  std::vector<std::uint64_t> triangles(variants);
  for (std::uint32_t p = 0; p < index.size(); ++p) {
    const PatchFacts& facts = terrain.terrain->facts()[p];
    for (std::size_t v = 0; v < variants; ++v) {
      triangles[v] += index.triangles[p][v];
      EXPECT_GE(facts.bilinearErrorM[v], facts.rmsErrorM[v]);
      EXPECT_GT(facts.bilinearErrorM[v], 0);
      if (v == 0) continue;
      EXPECT_LE(index.errorM[p][v - 1], index.errorM[p][v]);
      EXPECT_LE(index.triangles[p][v], index.triangles[p][v - 1]);
      EXPECT_LE(facts.bilinearErrorM[v - 1], facts.bilinearErrorM[v]);
    }
    for (std::size_t v = variants; v < PatchIndex::kMostVariants; ++v)
      EXPECT_EQ(std::pair(facts.rmsErrorM[v], facts.bilinearErrorM[v]), std::pair(0.0f, 0.0f));
    EXPECT_EQ(terrain.mesh(p).firstIndex.back(), terrain.mesh(p).indices.size());
    const std::uint32_t parent = index.parent[p];
    if (parent == PatchIndex::kNone) continue;
    for (std::size_t v = 0; v < variants; ++v) EXPECT_LE(index.errorM[p][v], index.errorM[parent][v]);
    const Box &own = index.bounds[p], &up = index.bounds[parent];
    EXPECT_TRUE(own.minX >= up.minX && own.minY >= up.minY && own.minZ >= up.minZ && own.maxX <= up.maxX &&
                own.maxY <= up.maxY && own.maxZ <= up.maxZ);
  }
  // Each is a mesh of its own.
  for (std::size_t v = 1; v < variants; ++v) EXPECT_LT(triangles[v], triangles[v - 1] * 19 / 20) << v;
}

TEST(PatchPages, areTheSameInAnyOrder) {
  const HeightGrid grid = test::fractal({10, 45, 0.001, 0.001, 300, 200}, 6);
  const test::WholeTerrain terrain = test::built(grid, defaultLeafToleranceM(grid.posts));
  const GridHeights heights(grid);
  const PostGeometry geometry(grid.posts);
  const PatchIndex& index = terrain.index();
  const auto tolerances = patchTolerances(index, defaultLeafToleranceM(grid.posts));
  for (std::uint32_t page = static_cast<std::uint32_t>(index.pages.size()); page-- > 0;) {
    const BuiltPage built = buildPage(index, page, heights, geometry, tolerances);
    for (std::size_t i = 0; i < built.meshes.patches.size(); ++i) {
      const PatchMesh &a = built.meshes.patches[i], &b = terrain.pages[page].patches[i];
      ASSERT_EQ(a.indices, b.indices);
      ASSERT_EQ(a.vertices.size(), b.vertices.size());
      ASSERT_EQ(std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(PatchVertex)),
                0);
    }
  }
}

TEST(PatchPages, stopBeingMadeWheneverTheyAreToldTo) {
  const HeightGrid grid = test::fractal({10, 45, 0.001, 0.001, 300, 200}, 6);
  const GridHeights heights(grid);
  const PostGeometry geometry(grid.posts);
  const PatchIndex index = makePatchIndex(grid.posts, geometry, kFineLeafCells);
  const auto tolerances = patchTolerances(index, defaultLeafToleranceM(grid.posts));
  const std::size_t patches = buildPage(index, 0, heights, geometry, tolerances).meshes.patches.size();
  std::size_t asked = 0;
  const BuiltPage whole = buildPage(index, 0, heights, geometry, tolerances, [&] {
    ++asked;
    return true;
  });
  EXPECT_EQ(whole.meshes.patches.size(), patches);
  EXPECT_GE(asked, 2 * patches);
  for (std::size_t last = 0; last < asked; last += 1 + asked / 5) {
    std::size_t left = last;
    const BuiltPage stopped = buildPage(index, 0, heights, geometry, tolerances, [&] { return left-- > 0; });
    EXPECT_TRUE(stopped.meshes.patches.empty());
    EXPECT_TRUE(stopped.facts.empty());
  }
}

/// Of a line between two posts, by many places along it, those where it leaves a cell among them.
double sampledEdge(const std::vector<float>& z, std::int32_t columns, const ScanVertex& a,
                   const ScanVertex& b) {
  constexpr int kPlaces = 1800;
  double worst = 0;
  for (int i = 0; i <= kPlaces; ++i) {
    const double t = static_cast<double>(i) / kPlaces, x = a.x + t * (b.x - a.x), y = a.y + t * (b.y - a.y);
    const auto column = std::min(static_cast<std::int32_t>(x), columns - 2),
               row = std::min(static_cast<std::int32_t>(y), columns - 2);
    const auto at = [&](std::int32_t c, std::int32_t r) {
      return static_cast<double>(z[static_cast<std::size_t>(r * columns + c)]);
    };
    const double u = x - column, v = y - row;
    const double surface = (1 - v) * ((1 - u) * at(column, row) + u * at(column + 1, row)) +
                           v * ((1 - u) * at(column, row + 1) + u * at(column + 1, row + 1));
    worst = std::max(worst, std::abs(surface - (a.z + t * (b.z - a.z))));
  }
  return worst;
}

TEST(EdgeError, isTheLargestAlongAnEdge) {
  constexpr std::int32_t kColumns = 6;
  std::mt19937 random(5);
  std::vector<float> z(kColumns * kColumns);
  for (int land = 0; land < 3; ++land) {
    for (float& height : z) height = static_cast<float>(random() % 1000) / 10;
    const PostStrip strip{z.data(), kColumns, 0, 0};
    const auto vertex = [&](std::int32_t i) {
      return ScanVertex{i % kColumns, i / kColumns, z[static_cast<std::size_t>(i)]};
    };
    for (std::int32_t from = 0; from < kColumns * kColumns; ++from)
      for (std::int32_t to = 0; to < kColumns * kColumns; ++to) {
        const ScanVertex a = vertex(from), b = vertex(to);
        if (a.x == b.x || a.y == b.y) continue;
        const double truth = sampledEdge(z, kColumns, a, b);
        const double whole = edgeError(a, b, strip, 0, kColumns, 0);
        ASSERT_NEAR(whole, truth, 1e-3) << from << " to " << to;
        // What was worse before stays, and nothing that is worse is taken for less.
        for (const double share : {0.5, 0.999, 1.001})
          ASSERT_DOUBLE_EQ(edgeError(a, b, strip, 0, kColumns, share * whole), std::max(share, 1.0) * whole)
              << from << " to " << to;
        // Strip by strip it is the same.
        double parts = 0;
        for (std::int32_t row = 0; row + 1 < kColumns; ++row)
          parts = edgeError(a, b, strip, row, row + 1, parts);
        ASSERT_NEAR(parts, whole, 1e-9) << from << " to " << to;
      }
  }
}

}  // namespace
}  // namespace trimtab::terrain
