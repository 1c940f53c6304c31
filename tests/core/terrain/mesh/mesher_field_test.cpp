#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "mesher_check.h"
#include "trimtab/terrain/mesh/mesher.h"

namespace trimtab {
namespace {

using terrain::FieldMesh;
using terrain::meshField;
using terrain::MeshOptions;
using test::checkMesh;
using test::Field;
using test::MeshFacts;

void expectTrue(const Field& field, const FieldMesh& mesh) {
  const MeshFacts facts = checkMesh(field.view(), mesh);
  EXPECT_EQ(facts.wrong, "");
  EXPECT_EQ(facts.posts, field.z.size());
  EXPECT_NEAR(mesh.maxErrorM, facts.maxM, 1e-6);
  EXPECT_NEAR(mesh.rmsErrorM, facts.rmsM, 1e-6);
}

void expectSame(const FieldMesh& a, const FieldMesh& b) {
  EXPECT_EQ(a.indices, b.indices);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    ASSERT_EQ(a.vertices[i].column, b.vertices[i].column);
    ASSERT_EQ(a.vertices[i].row, b.vertices[i].row);
    ASSERT_EQ(a.vertices[i].z, b.vertices[i].z);
  }
  EXPECT_EQ(a.maxErrorM, b.maxErrorM);
  EXPECT_EQ(a.rmsErrorM, b.rmsErrorM);
}

TEST(MeshField, keepsTheBoundAtEveryPost) {
  const Field field = test::fractal(333, 251, 1);
  for (const double bound : {500.0, 60.0, 20.0, 4.0})
    for (const bool fit : {false, true}) {
      const FieldMesh mesh = meshField(field.view(), {.maxErrorM = bound, .fitHeights = fit});
      SCOPED_TRACE(bound);
      expectTrue(field, mesh);
      EXPECT_LE(mesh.maxErrorM, bound * (1 + 1e-6));
    }
}

TEST(MeshField, fittingTakesAFifthOfTheRmsAndNoTriangle) {
  const Field field = test::fractal(401, 401, 2);
  const FieldMesh plain = meshField(field.view(), {.maxErrorM = 30, .fitHeights = false});
  const FieldMesh fitted = meshField(field.view(), {.maxErrorM = 30, .fitHeights = true});
  EXPECT_EQ(plain.triangles(), fitted.triangles());
  EXPECT_LE(fitted.rmsErrorM, 0.8 * plain.rmsErrorM);
  EXPECT_LE(fitted.maxErrorM, 30 * (1 + 1e-6));
}

TEST(MeshField, fittingOfABudgetTakesTwentyThreeHundredthsOfTheRms) {
  const Field field = test::fractal(401, 401, 2);
  for (const std::size_t most : {32000u, 3200u}) {
    const FieldMesh plain = meshField(field.view(), {.mostTriangles = most, .fitHeights = false});
    const FieldMesh fitted = meshField(field.view(), {.mostTriangles = most});
    EXPECT_LE(fitted.triangles(), most);
    EXPECT_LE(fitted.rmsErrorM, 0.77 * plain.rmsErrorM);
  }
}

TEST(MeshField, fittingBringsTheFurthestPostsNearer) {
  const Field field = test::fractal(401, 401, 2);
  for (const auto& [most, share] : {std::pair{32000u, 0.97}, {8000u, 0.75}, {3200u, 0.75}}) {
    const FieldMesh plain = meshField(field.view(), {.mostTriangles = most, .fitHeights = false});
    const FieldMesh fitted = meshField(field.view(), {.mostTriangles = most});
    SCOPED_TRACE(most);
    EXPECT_LE(fitted.maxErrorM, share * plain.maxErrorM);
  }
}

/// The least squares about a post that stands out are far from it, and no triangle has it.
TEST(MeshField, fittingLeavesVerticesNearTheirPosts) {
  const Field field = test::fractal(301, 301, 3, 1000, 0.7);
  const FieldMesh plain = meshField(field.view(), {.mostTriangles = 4530, .fitHeights = false});
  const FieldMesh fitted = meshField(field.view(), {.mostTriangles = 4530});
  EXPECT_LE(fitted.maxErrorM, 0.75 * plain.maxErrorM);
}

TEST(MeshField, isTheSameOnAnyNumberOfThreads) {
  const Field field = test::fractal(500, 300, 3);
  for (const std::size_t most : {std::size_t{0}, std::size_t{15000}, std::size_t{3000}}) {
    const MeshOptions options{.maxErrorM = most == 0 ? 25.0 : 0.0, .mostTriangles = most};
    const FieldMesh one = meshField(field.view(), options);
    for (const unsigned threads : {2u, 3u, 8u}) {
      MeshOptions more = options;
      more.threads = threads;
      expectSame(one, meshField(field.view(), more));
    }
  }
}

TEST(MeshField, spendsABudgetAndNoMore) {
  const Field field = test::fractal(401, 301, 4);
  for (const std::size_t most : {100u, 1000u, 2400u, 24000u, 120000u}) {
    const FieldMesh mesh = meshField(field.view(), {.mostTriangles = most});
    SCOPED_TRACE(most);
    expectTrue(field, mesh);
    EXPECT_LE(mesh.triangles(), most);
    EXPECT_GE(static_cast<double>(mesh.triangles()), 0.985 * static_cast<double>(most));
  }
}

TEST(MeshField, hasTwoTrianglesAtTheLeast) {
  const Field field = test::fractal(250, 250, 8);
  for (const std::size_t most : {1u, 2u, 3u, 9u}) {
    const FieldMesh mesh = meshField(field.view(), {.mostTriangles = most});
    expectTrue(field, mesh);
    EXPECT_LE(mesh.triangles(), std::max<std::size_t>(most, 2));
  }
}

/// Posts of which none can go, beside hills.
TEST(MeshField, takesOutElsewhereWhatATileHasNotToGive) {
  const Field hills = test::fractal(401, 401, 2);
  const Field field(401, 401, [&](int x, int y) {
    return x < 200 ? static_cast<double>(hills.z[static_cast<std::size_t>(y * 401 + x)])
           : x > 250 && x < 290 && y > 250 && y < 290 ? 3000.0 * ((x * 7 + y * 13) % 29)
                                                      : 0.0;
  });
  const FieldMesh plain = meshField(field.view(), {.mostTriangles = 8000, .fitHeights = false});
  const FieldMesh fitted = meshField(field.view(), {.mostTriangles = 8000});
  expectTrue(field, fitted);
  EXPECT_LE(fitted.triangles(), 8000u);
  EXPECT_LE(fitted.rmsErrorM, 0.72 * plain.rmsErrorM);
}

TEST(MeshField, spendsABudgetWhereManyPostsAreOffByTheSame) {
  const Field field(301, 301, [](int x, int y) { return (x * 7 + y * 13) % 29 == 0 ? 10.0 : 0.0; });
  for (const std::size_t most : {500u, 5000u, 9000u}) {
    const FieldMesh mesh = meshField(field.view(), {.mostTriangles = most});
    SCOPED_TRACE(most);
    expectTrue(field, mesh);
    EXPECT_LE(mesh.triangles(), most);
  }
}

/// Memory that may not be read stands right before the first post, or right after the last.
TEST(MeshField, readsNothingBesideTheField) {
  constexpr std::uint32_t kSide = 301;
  const Field field(kSide, kSide, [](int x, int y) { return (x * 7 + y * 13) % 29 == 0 ? 10.0 : 0.0; });
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)), bytes = field.z.size() * sizeof(float);
  const std::size_t inside = (bytes + page - 1) / page * page;
  void* const all = ::mmap(nullptr, inside + 2 * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(all, MAP_FAILED);
  char* const begin = static_cast<char*>(all) + page;
  ASSERT_EQ(::mprotect(begin, inside, PROT_READ | PROT_WRITE), 0);
  for (char* const first : {begin, begin + (inside - bytes)}) {
    std::memcpy(first, field.z.data(), bytes);
    for (const std::size_t most : {500u, 5000u, 9000u})
      expectSame(meshField({reinterpret_cast<float*>(first), kSide, kSide, kSide}, {.mostTriangles = most}),
                 meshField(field.view(), {.mostTriangles = most}));
  }
  ::munmap(all, inside + 2 * page);
}

TEST(MeshField, stopsAtTheBoundWhereTheBudgetAllowsMore) {
  const Field field = test::fractal(201, 201, 5);
  const FieldMesh bound = meshField(field.view(), {.maxErrorM = 50});
  const FieldMesh both = meshField(field.view(), {.maxErrorM = 50, .mostTriangles = 79000});
  EXPECT_LE(both.maxErrorM, 50 * (1 + 1e-6));
  EXPECT_NEAR(static_cast<double>(both.triangles()), static_cast<double>(bound.triangles()),
              0.15 * static_cast<double>(bound.triangles()));
}

TEST(MeshField, takesTheSmallestFlatHugeAndSteppedFields) {
  for (const auto& [columns, rows] : {std::pair{2u, 2u}, {2u, 400u}, {400u, 2u}, {3u, 150u}}) {
    const Field field = test::fractal(columns, rows, 6);
    const FieldMesh mesh = meshField(field.view(), {.maxErrorM = 10});
    expectTrue(field, mesh);
    EXPECT_LE(mesh.maxErrorM, 10 * (1 + 1e-6));
  }
  const Field flat(300, 200, [](int, int) { return 1234.5; });
  const FieldMesh plane = meshField(flat.view(), {});
  expectTrue(flat, plane);
  EXPECT_EQ(plane.maxErrorM, 0);
  EXPECT_LE(plane.triangles(), 12u);
  const Field stepped(300, 200, [](int x, int y) { return x + y < 250 ? 0 : 1e7; });
  const FieldMesh cliff = meshField(stepped.view(), {.maxErrorM = 100});
  expectTrue(stepped, cliff);
  EXPECT_LE(cliff.maxErrorM, 100 * (1 + 1e-6));
  EXPECT_EQ(meshField({nullptr, 1, 1, 1}, {}).triangles(), 0u);
  EXPECT_EQ(meshField({}, {}).triangles(), 0u);
}

#ifndef NDEBUG
TEST(MeshField, takesNoPostWithoutAHeight) {
  for (const double none : {std::nan(""), HUGE_VAL}) {
    const Field field(40, 30, [none](int x, int y) { return x == 21 && y == 13 ? none : 5.0 * x; });
    EXPECT_DEATH(meshField(field.view(), {}), "allFinite");
  }
}
#endif

TEST(MeshField, needsAboutAsFewTrianglesAsOneMeshOfAll) {
  const Field field = test::fractal(401, 401, 7);
  terrain::PolygonMesher whole;
  std::vector<test::Point> border, side;
  const std::vector<test::Point> corners{{0, 0}, {400, 0}, {400, 400}, {0, 400}};
  for (std::size_t i = 0; i < 4; ++i) {
    terrain::simplifySide(field.view(), corners[i], corners[(i + 1) % 4], 30, side);
    border.insert(border.end(), side.begin(), side.end() - 1);
  }
  whole.begin(field.view(), border);
  whole.refine(30, std::size_t{1} << 40);
  std::vector<std::uint32_t> indices;
  whole.triangles(indices);
  const FieldMesh tiles = meshField(field.view(), {.maxErrorM = 30, .fitHeights = false});
  EXPECT_LE(static_cast<double>(tiles.triangles()), 1.02 * static_cast<double>(indices.size()) / 3);
}

/// Registers differ in width from machine to machine, and test_mesher_plain has none but the narrow ones.
TEST(MeshField, isTheSameToTheBitOnEveryMachine) {
  const Field field(301, 263, [](int x, int y) {
    const auto noise =
        static_cast<std::uint32_t>(x) * 0x9e3779b1u ^ static_cast<std::uint32_t>(y) * 0x85ebca77u;
    const int far = (x - 140) * (x - 140) + (y - 90) * (y - 90);
    return far / 64 + static_cast<double>((noise ^ noise >> 15) % 1024) / 16;
  });
  for (const auto& [most, expected] :
       {std::pair{9000u, 3058735493083210849u}, {1500u, 16401976083998510116u}}) {
    const FieldMesh mesh = meshField(field.view(), {.mostTriangles = most});
    std::uint64_t sum = 0xcbf29ce484222325u;
    const auto add = [&](std::uint32_t word) { sum = (sum ^ word) * 0x100000001b3u; };
    for (const terrain::MeshVertex& v : mesh.vertices) {
      add(v.column);
      add(v.row);
      add(std::bit_cast<std::uint32_t>(v.z));
    }
    for (const std::uint32_t index : mesh.indices) add(index);
    EXPECT_EQ(sum, expected);
  }
}

}  // namespace
}  // namespace trimtab
