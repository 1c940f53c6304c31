#include <cstring>

#include "static_lod_check.h"
#include "static_lod_support.h"
#include "tests/support.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {
namespace {

std::shared_ptr<const StaticLodTerrain> example(std::uint32_t cells = 12, std::uint32_t n = 40) {
  return *test::built({test::tin("A", {.columns = cells, .rows = cells}),
                       test::tin("B", {.x0 = cells * 30.0, .columns = 3, .rows = 3})},
                      n);
}

TEST(StaticLodFile, bringsBackWhatWasWritten) {
  const test::ScratchDir dir;
  const auto terrain = example();
  ASSERT_TRUE(writeStaticLod(dir / "trees", *terrain));
  const auto again = readStaticLod(dir / "trees");
  ASSERT_TRUE(again) << toString(again.findings());
  const StaticLodTerrain &a = *terrain, &b = **again;
  EXPECT_EQ(a.trianglesPerNode, b.trianglesPerNode);
  EXPECT_EQ(a.index.frame.origin(), b.index.frame.origin());
  EXPECT_EQ(a.index.frame.ecefToLocal(), b.index.frame.ecefToLocal());
  EXPECT_EQ(a.index.roots, b.index.roots);
  EXPECT_EQ(a.index.rmsErrorM, b.index.rmsErrorM);
  EXPECT_EQ(a.index.maxErrorM, b.index.maxErrorM);
  EXPECT_EQ(a.index.borderErrorM, b.index.borderErrorM);
  EXPECT_EQ(a.index.slopeMax, b.index.slopeMax);
  ASSERT_EQ(a.index.size(), b.index.size());
  EXPECT_EQ(std::memcmp(a.index.bounds.data(), b.index.bounds.data(), a.index.size() * sizeof(Box)), 0);
  for (std::size_t i = 0; i < a.index.size(); ++i) {
    EXPECT_EQ(a.index.nodes[i].children, b.index.nodes[i].children);
    EXPECT_EQ(a.index.nodes[i].triangles, b.index.nodes[i].triangles);
    EXPECT_EQ(a.index.nodes[i].depth, b.index.nodes[i].depth);
    EXPECT_EQ(a.index.nodes[i].lockedMinimum, b.index.nodes[i].lockedMinimum);
    EXPECT_EQ(a.ranges[i].firstTriangle, b.ranges[i].firstTriangle);
    EXPECT_EQ(a.ranges[i].triangles, b.ranges[i].triangles);
  }
  ASSERT_EQ(a.tiles.size(), b.tiles.size());
  for (std::size_t i = 0; i < a.tiles.size(); ++i) {
    EXPECT_EQ(a.tiles[i].name, b.tiles[i].name);
    EXPECT_EQ(a.tiles[i].indices, b.tiles[i].indices);
    EXPECT_EQ(a.tiles[i].locked, b.tiles[i].locked);
    EXPECT_EQ(a.tiles[i].material, b.tiles[i].material);
    EXPECT_EQ(std::memcmp(a.tiles[i].origin, b.tiles[i].origin, sizeof a.tiles[i].origin), 0);
    EXPECT_EQ(
        std::memcmp(a.tiles[i].vertices.data(), b.tiles[i].vertices.data(), a.tiles[i].vertices.size() * 20),
        0);
  }
  EXPECT_EQ(a.materials, b.materials);
  EXPECT_EQ(a.counts.facesOfLevel, b.counts.facesOfLevel);
  EXPECT_EQ(a.counts.faces, b.counts.faces);
  EXPECT_EQ(a.counts.distinctFaces, b.counts.distinctFaces);
  EXPECT_EQ(a.counts.bytes, b.counts.bytes);
}

TEST(StaticLodFile, refusesEveryFlippedByteAndEveryCut) {
  const test::ScratchDir dir;
  ASSERT_TRUE(writeStaticLod(dir / "trees", *example(3, 8)));
  const std::string whole = test::readFile(dir / "trees");
  for (std::size_t i = 0; i < whole.size(); i += i < 200 ? 1 : 23) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ (1 << (i % 8)));
    test::writeFile(dir / "flipped", bytes);
    EXPECT_FALSE(readStaticLod(dir / "flipped")) << "byte " << i;
    test::writeFile(dir / "cut", whole.substr(0, i));
    EXPECT_FALSE(readStaticLod(dir / "cut")) << "cut at " << i;
  }
  test::writeFile(dir / "longer", whole + "x");
  EXPECT_FALSE(readStaticLod(dir / "longer"));
  EXPECT_FALSE(readStaticLod(dir / "absent"));
  EXPECT_FALSE(readStaticLod(dir.path()));
  EXPECT_TRUE(readStaticLod(dir / "trees"));
}

TEST(StaticLodFile, survivesDamageWhoseChecksumWasMadeToFit) {
  const test::ScratchDir dir;
  ASSERT_TRUE(writeStaticLod(dir / "trees", *example(3, 8)));
  const std::string whole = test::readFile(dir / "trees");
  int refused = 0, tried = 0;
  for (std::size_t i = 28; i < whole.size(); i += i < 600 ? 4 : 19)
    for (const int with : {0xff, 0x80}) {
      std::string bytes = whole;
      bytes[i] = static_cast<char>(bytes[i] ^ with);
      const std::uint64_t sum = checksum(std::string_view(bytes).substr(28));
      std::memcpy(&bytes[20], &sum, 8);
      test::writeFile(dir / "forged", bytes);
      const auto read = readStaticLod(dir / "forged");
      ++tried;
      refused += !read;
      if (read)  // whatever was let through can be walked
        test::faultsOf(test::PlacedTrees(**read));
    }
  EXPECT_GT(refused, tried / 4);
}

TEST(StaticLodFile, replacesAFileWholeOrNotAtAll) {
  const test::ScratchDir dir;
  ASSERT_TRUE(writeStaticLod(dir / "trees", *example(3)));
  ASSERT_TRUE(writeStaticLod(dir / "trees", *example(6)));
  EXPECT_EQ((*readStaticLod(dir / "trees"))->counts.sourceTriangles, 2u * 36 + 18);
  EXPECT_FALSE(writeStaticLod(dir / "no" / "folder", *example(3)));
  std::filesystem::create_directories(dir / "taken" / "inside");
  EXPECT_FALSE(writeStaticLod(dir / "taken", *example(3)));
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(dir.path())) files += entry.is_regular_file();
  EXPECT_EQ(files, 1);  // nothing half-written is left
}

}  // namespace
}  // namespace trimtab::terrain
