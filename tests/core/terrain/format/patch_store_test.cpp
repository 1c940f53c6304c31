#include "trimtab/terrain/format/patch_store.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "core/terrain/bake/patches.h"
#include "tests/core/terrain/elevation/rasters.h"
#include "tests/support.h"
#include "trimtab/terrain/format/patch_layout.h"

namespace trimtab::terrain {
namespace {

HeightGrid groundOf(std::uint32_t columns, std::uint32_t rows, double step, bool whole) {
  HeightGrid grid{{10, 50, step, step, columns, rows}, {}, 0, {}};
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const auto h = static_cast<float>(test::roughGround(static_cast<int>(c), static_cast<int>(r)));
      grid.heights.push_back(whole ? std::round(h) : h);
    }
  return grid;
}

using Corner = std::array<float, 8>;
Corner cornerOf(const PatchVertex& v) {
  return {v.x,         v.y, v.z, v.normal[0] * 1.0f, v.normal[1] * 1.0f, v.normal[2] * 1.0f, v.column * 1.0f,
          v.row * 1.0f};
}
/// Triangles of a variant by what their corners are, the first the least: in any order, wherever they begin.
std::multiset<std::array<Corner, 3>> trianglesOf(const PatchMesh& mesh, std::size_t variant) {
  std::multiset<std::array<Corner, 3>> all;
  for (std::uint32_t i = mesh.firstIndex[variant]; i < mesh.firstIndex[variant + 1]; i += 3) {
    std::array<Corner, 3> t{cornerOf(mesh.vertices[mesh.indices[i]]),
                            cornerOf(mesh.vertices[mesh.indices[i + 1]]),
                            cornerOf(mesh.vertices[mesh.indices[i + 2]])};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    all.insert(t);
  }
  return all;
}

constexpr std::uint32_t kLeafCells[] = {kFineLeafCells, kCoarseLeafCells};

void expectSame(const PatchMesh& a, const PatchMesh& b, std::size_t variants) {
  EXPECT_TRUE(std::equal(a.origin, a.origin + 3, b.origin));
  EXPECT_EQ(a.firstColumn, b.firstColumn);
  EXPECT_EQ(a.firstRow, b.firstRow);
  EXPECT_EQ(a.firstIndex, b.firstIndex);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t v = 0; v < variants; ++v) EXPECT_EQ(trianglesOf(a, v), trianglesOf(b, v));
}

TEST(PatchStore, givesEveryTriangleBackToTheBit) {
  struct Case {
    double step;
    bool whole;
    std::uint32_t leafCells;
  };
  for (const Case& c : {Case{0.0003, false, kFineLeafCells}, Case{0.0003, true, kFineLeafCells},
                        Case{0.02, false, kFineLeafCells}, Case{0.0003, false, kCoarseLeafCells},
                        Case{0.02, false, kCoarseLeafCells}}) {
    const HeightGrid grid = groundOf(300, 200, c.step, c.whole);
    const GridHeights heights(grid);
    const PostGeometry geometry(grid.posts);
    const auto built = buildPatches(heights, 1.0, c.leafCells);
    ASSERT_TRUE(built);
    const PatchIndex& index = built->index();
    for (std::uint32_t page = 0; page < index.pages.size(); ++page) {
      const PatchPage whole = *built->readPage(page);
      const auto bytes = encodePage(whole, index, geometry);
      const auto again = decodePage(bytes, index, page, geometry, "bytes");
      ASSERT_TRUE(again) << toString(again.findings());
      ASSERT_EQ(again->patches.size(), whole.patches.size());
      for (std::size_t p = 0; p < whole.patches.size(); ++p)
        expectSame(whole.patches[p], again->patches[p], index.variants());
    }
  }
}

/// Places that no whole number of height steps gives, and normals of no length.
TEST(PatchStore, keepsWhatItCannotPredict) {
  const HeightGrid grid = groundOf(300, 200, 0.0003, false);
  const GridHeights heights(grid);
  const PostGeometry geometry(grid.posts);
  const auto built = buildPatches(heights, 1.0, kCoarseLeafCells);
  ASSERT_TRUE(built);
  PatchPage page = *built->readPage(0);
  std::mt19937 random(4);
  for (PatchMesh& mesh : page.patches)
    for (PatchVertex& v : mesh.vertices) {
      v.x += static_cast<float>(static_cast<int>(random() % 9) - 4) / 256;
      v.y += static_cast<float>(static_cast<int>(random() % 9) - 4) / 256;
      for (std::int8_t& n : v.normal) n = static_cast<std::int8_t>(static_cast<int>(random() % 255) - 127);
      v.normal[2] = static_cast<std::int8_t>(std::abs(v.normal[2]));
    }
  const auto again =
      decodePage(encodePage(page, built->index(), geometry), built->index(), 0, geometry, "bytes");
  ASSERT_TRUE(again) << toString(again.findings());
  for (std::size_t p = 0; p < page.patches.size(); ++p)
    expectSame(page.patches[p], again->patches[p], built->index().variants());
}

TEST(PatchStore, refusesAnotherPageGridOrCount) {
  const HeightGrid grid = groundOf(300, 600, 0.0003, false);
  const GridHeights heights(grid);
  const PostGeometry geometry(grid.posts);
  const auto built = buildPatches(heights, 1.0);
  ASSERT_TRUE(built && built->index().pages.size() > 1);
  const auto bytes = encodePage(*built->readPage(0), built->index(), geometry);
  EXPECT_FALSE(decodePage(bytes, built->index(), 1, geometry, "bytes"));
  PatchIndex other = built->index();
  other.columns = 20;
  EXPECT_FALSE(decodePage(bytes, other, 0, geometry, "bytes"));
  other = built->index();
  ++other.triangles[0][1];
  const auto refused = decodePage(bytes, other, 0, geometry, "bytes");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.findings().front().where, "bytes");
  EXPECT_NE(refused.findings().front().key.find("page 0"), std::string::npos);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 97)
    EXPECT_FALSE(decodePage(std::span(bytes).first(size), built->index(), 0, geometry, "bytes")) << size;
}

class PatchDamage : public ::testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(LeafCells, PatchDamage, ::testing::ValuesIn(kLeafCells));

/// Damage that a checksum would have caught, had it not been made with it.
TEST_P(PatchDamage, neverPointsBeyondItsOwnArrays) {
  const HeightGrid grid = groundOf(130, 90, 0.0003, false);
  const GridHeights heights(grid);
  const PostGeometry geometry(grid.posts);
  const auto built = buildPatches(heights, 2.0, GetParam());
  ASSERT_TRUE(built);
  const auto bytes = encodePage(*built->readPage(0), built->index(), geometry);
  std::mt19937 random(7);
  int read = 0;
  for (int k = 0; k < 5000; ++k) {
    auto damaged = bytes;
    for (auto edits = 1 + random() % 3; edits > 0; --edits) {
      // Counts, heirs, which come last, and packed streams alike.
      const std::size_t kind = random() % 3;
      const std::size_t at = kind == 0   ? random() % 44
                             : kind == 1 ? damaged.size() - 1 - random() % 64
                                         : random() % damaged.size();
      damaged[at] = static_cast<std::byte>(random());
    }
    if (random() % 8 == 0) damaged.resize(random() % damaged.size());
    const auto page = decodePage(damaged, built->index(), 0, geometry, "bytes");
    ASSERT_EQ(page.ok(), page.findings().empty());
    if (!page) continue;
    ++read;
    for (const PatchMesh& mesh : page->patches) {
      for (const std::uint16_t index : mesh.indices) ASSERT_LT(index, mesh.vertices.size());
      for (const PatchVertex& v : mesh.vertices) {
        ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
        ASSERT_LT(mesh.firstColumn + v.column, grid.posts.columns);
        ASSERT_LT(mesh.firstRow + v.row, grid.posts.rows);
      }
      ASSERT_EQ(mesh.firstIndex.back(), mesh.indices.size());
    }
  }
  EXPECT_GT(read, 0);
  // As one of an index with more or fewer variants.
  const PatchIndex other =
      makePatchIndex(grid.posts, geometry, kFineLeafCells + kCoarseLeafCells - GetParam());
  PatchIndex lying = built->index();
  lying.errorM = VariantTable<float>(other.variants(), lying.size());
  lying.triangles = VariantTable<std::uint16_t>(other.variants(), lying.size());
  for (std::size_t p = 0; p < lying.size(); ++p)
    for (std::size_t v = 0; v < std::min(other.variants(), built->index().variants()); ++v)
      lying.triangles[p][v] = built->index().triangles[p][v];
  EXPECT_FALSE(decodePage(bytes, lying, 0, geometry, "bytes"));
}

class PatchFile : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  /// Of the terrain, with squares of so many cells.
  std::shared_ptr<const PageFile> written() {
    auto writer = PageFileWriter::create(file_);
    for (std::uint32_t page = 0; page < built_->index().pages.size(); ++page)
      EXPECT_TRUE((*writer)->add(
          page, encodePage(*built_->readPage(page), built_->index(), PostGeometry(grid_.posts))));
    EXPECT_TRUE(finishPatchFile(**writer, grid_.posts, built_->index(), built_->facts()));
    return *PageFile::open(file_);
  }
  struct Byte {
    std::size_t at;
    int value;
  };
  /// A file of its index alone, bytes of which are others.
  Findings refusalOf(const PageFile& pages, std::initializer_list<Byte> others) const {
    const auto stored = pages.read(kIndexKey);
    std::vector<std::byte> measured(stored->begin(), stored->end());
    for (const Byte& other : others) measured[other.at] = static_cast<std::byte>(other.value);
    const auto file = dir_ / "other.pages";
    auto writer = PageFileWriter::create(file);
    EXPECT_TRUE((*writer)->add(kIndexKey, measured));
    EXPECT_TRUE((*writer)->finish());
    return openPatches(*PageFile::open(file), file, grid_.posts).findings();
  }

  static constexpr std::uint64_t kIndexKey = std::uint64_t{1} << 32, kFactsKey = kIndexKey + 1;
  test::ScratchDir dir_;
  std::filesystem::path file_ = dir_ / "patches.pages";
  HeightGrid grid_ = groundOf(300, 200, 0.0003, false);
  std::shared_ptr<const PatchTerrain> built_ = buildPatches(GridHeights(grid_), 1.0, GetParam());
};
INSTANTIATE_TEST_SUITE_P(LeafCells, PatchFile, ::testing::ValuesIn(kLeafCells));

TEST_P(PatchFile, isOpenedAsItWasWrittenAndAsNothingElse) {
  const auto pages = written();
  const auto opened = openPatches(pages, file_, grid_.posts);
  ASSERT_TRUE(opened) << toString(opened.findings());
  const PatchIndex& index = (*opened)->index();
  EXPECT_EQ(index.leafCells, GetParam());
  EXPECT_EQ(index.errorM, built_->index().errorM);
  EXPECT_EQ(index.triangles, built_->index().triangles);
  EXPECT_EQ(index.bounds, built_->index().bounds);
  EXPECT_EQ((*opened)->facts(), built_->facts());
  // Of each variant there is, and of no other: a box, errors and triangles; heights and counts, errors.
  const std::size_t variants = GetParam() == kFineLeafCells ? 2 : 3;
  EXPECT_EQ(index.variants(), variants);
  EXPECT_EQ(pages->bytesOf(kIndexKey), 64 + index.size() * (24 + 6 * variants));
  EXPECT_EQ(pages->bytesOf(kFactsKey), index.size() * (24 + 8 * variants));
  EXPECT_FALSE((*opened)->readPage(static_cast<std::uint32_t>(index.pages.size())));
  for (std::uint32_t page = 0; page < index.pages.size(); ++page) {
    ASSERT_TRUE((*opened)->readPage(page));
    EXPECT_GT((*opened)->pageBytes(page), 0u);
  }
  PostGrid other = grid_.posts;
  other.south += 1e-9;
  const auto refused = openPatches(pages, file_, other);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.findings().front().where, file_.string());
}

TEST_P(PatchFile, ofAnotherVersionOrOtherSquaresIsRefused) {
  const auto pages = written();
  const Findings older = refusalOf(*pages, {{0, 1}});
  ASSERT_FALSE(older.empty());
  EXPECT_EQ(older.front().expected, "version 5 (bake it again)");
  EXPECT_EQ(older.front().found, "version 1");
  EXPECT_EQ(older.front().where, (dir_ / "other.pages").string());
  EXPECT_EQ(refusalOf(*pages, {{0, 4}}).front().found, "version 4");
  constexpr std::size_t kLeafCellsAt = 56, kVariantsAt = 60;
  const std::string own = GetParam() == kFineLeafCells ? "2 meshes a patch with squares of 16 cells"
                                                       : "3 meshes a patch with squares of 32 cells";
  for (const int variants : {0, 1, GetParam() == kFineLeafCells ? 3 : 2, 4, 255}) {
    const Findings odd = refusalOf(*pages, {{kVariantsAt, variants}});
    ASSERT_FALSE(odd.empty()) << variants;
    EXPECT_EQ(odd.front().where, (dir_ / "other.pages").string());
    EXPECT_EQ(odd.front().expected, own);
    EXPECT_EQ(odd.front().found, std::to_string(variants));
  }
  for (const int cells : {0, 1, 8, 24, 64}) {
    const Findings odd = refusalOf(*pages, {{kLeafCellsAt, cells}});
    ASSERT_FALSE(odd.empty());
    EXPECT_EQ(odd.front().expected, "squares of 16 or 32 cells");
    EXPECT_EQ(odd.front().found, std::to_string(cells));
  }
  // Those of the other side are more or fewer than it tells of.
  const auto otherCells = static_cast<int>(kFineLeafCells + kCoarseLeafCells - GetParam());
  const Findings other =
      refusalOf(*pages, {{kLeafCellsAt, otherCells}, {kVariantsAt, otherCells == kFineLeafCells ? 2 : 3}});
  ASSERT_FALSE(other.empty());
  // More of them are known at once, without an index as large as they say.
  const char* said = otherCells == kFineLeafCells ? " patches with squares of 16 cells" : " patches in ";
  EXPECT_NE(other.front().expected.find(said), std::string::npos) << toString(other);
}

TEST_P(PatchFile, thatEndsEarlyOrLateIsRefused) {
  const auto pages = written();
  for (const std::uint64_t key : {kIndexKey, kFactsKey})
    for (const int by : {-64, -1, 1}) {
      const auto file = dir_ / "other.pages";
      auto writer = PageFileWriter::create(file);
      for (const std::uint64_t each : {kIndexKey, kFactsKey}) {
        const auto stored = pages->read(each);
        std::vector<std::byte> bytes(stored->begin(), stored->end());
        if (each == key && by > 0) bytes.push_back({});
        if (each == key && by < 0) bytes.erase(bytes.end() + by, bytes.end());
        ASSERT_TRUE((*writer)->add(each, bytes));
      }
      ASSERT_TRUE((*writer)->finish());
      const Findings odd = openPatches(*PageFile::open(file), file, grid_.posts).findings();
      ASSERT_FALSE(odd.empty());
      EXPECT_EQ(odd.front().key, key == kIndexKey ? "index" : "facts");
      EXPECT_NE(odd.front().found.find(" bytes"), std::string::npos);
    }
}

/// Beyond the limit, here lowered to this terrain's 19 x 13 squares, by the coarser side.
TEST(PatchBake, inPartsIsWholeAndOpensWithEitherSideOfSquares) {
  const HeightGrid grid = groundOf(300, 200, 0.0003, false);
  const PostGeometry geometry(grid.posts);
  for (const std::uint64_t mostFine : {247u, 246u}) {
    const test::ScratchDir dir;
    const auto work = WorkFolder::open(dir / "db", "{}", WorkFolder::Use::alone);
    ASSERT_TRUE(work) << toString(work.findings());
    PatchBake bake(**work, grid.posts, geometry, 1.0, mostFine);
    for (std::uint32_t part = 0; part < 2; ++part)
      ASSERT_TRUE(bake.make(GridHeights(grid), part, 2, std::size_t{256} << 20, {}));
    const auto file = dir / "patches.pages";
    ASSERT_TRUE(bake.join(file, {}));
    const auto opened = openPatches(*PageFile::open(file), file, grid.posts);
    ASSERT_TRUE(opened) << toString(opened.findings());
    const PatchIndex& index = (*opened)->index();
    EXPECT_EQ(index.leafCells, mostFine == 247 ? kFineLeafCells : kCoarseLeafCells);
    const auto whole = buildPatches(GridHeights(grid), 1.0, index.leafCells);
    EXPECT_EQ(index.triangles, whole->index().triangles);
    EXPECT_EQ(index.errorM, whole->index().errorM);
    EXPECT_EQ(index.bounds, whole->index().bounds);
    for (std::size_t p = 0; p < index.size(); ++p) {
      const PatchFacts &stored = (*opened)->facts()[p], &made = whole->facts()[p];
      EXPECT_EQ(stored.rmsErrorM, made.rmsErrorM);
      EXPECT_EQ(stored.bilinearErrorM, made.bilinearErrorM);
      EXPECT_EQ(stored.posts, made.posts);
      EXPECT_TRUE(index.cones[p] == whole->index().cones[p]);
    }
    for (std::uint32_t page = 0; page < index.pages.size(); ++page)
      EXPECT_TRUE((*opened)->readPage(page)) << page;
  }
}

}  // namespace
}  // namespace trimtab::terrain
