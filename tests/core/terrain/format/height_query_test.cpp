#include "trimtab/terrain/format/height_query.h"

#include <cmath>

#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/terrain/format/patch_terrain.h"

/// Heights at places of a database, with the file that each comes from and the error of what is drawn.
namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;

class Heights : public ::testing::Test {
 protected:
  /// A rough square of 129 x 129 posts, and coarser ground around it and in its hole.
  void bakeTwo() {
    test::RasterRecipe fine;
    fine.columns = fine.rows = 129;
    fine.noData = -1;
    fine.value = [](int c, int r, int) {
      return c > 20 && c < 30 && r > 20 && r < 30 ? -1 : test::roughGround(c, r);
    };
    fine_ = test::writeRaster(dir_ / "fine.tif", fine);
    test::RasterRecipe coarse;
    coarse.step = 0.004, coarse.west = 9.998, coarse.north = 50.002;
    coarse.columns = 60, coarse.rows = 40;
    coarse.noData = -1;
    coarse.value = [](int c, int r, int) { return c > 55 && r > 35 ? -1 : 600; };
    coarse_ = test::writeRaster(dir_ / "coarse.tif", coarse);
    BakeOptions options;
    options.sources = {coarse_, fine_};
    options.output = dir_ / "db";
    const auto database = bake(options);
    ASSERT_TRUE(database) << toString(database.findings());
  }
  test::ScratchDir dir_;
  fs::path fine_, coarse_;
};

TEST_F(Heights, nameTheFileThatEachComesFrom) {
  bakeTwo();
  const auto query = HeightQuery::open(dir_ / "db");
  ASSERT_TRUE(query) << toString(query.findings());
  using Names = std::vector<std::string>;
  const auto ofFine = query->at(Degrees{50 - 0.0805}, Degrees{10.0805});
  ASSERT_TRUE(ofFine);
  EXPECT_EQ(ofFine->sources, Names{fine_.string()});
  EXPECT_NEAR(ofFine->height.value(), test::roughGround(80, 80), 1e-3);
  const auto inHole = query->at(Degrees{50 - 0.0255}, Degrees{10.0255});
  ASSERT_TRUE(inHole);
  EXPECT_EQ(inHole->sources, Names{coarse_.string()});
  EXPECT_NEAR(inHole->height.value(), 600, 1e-3);
  const auto beside = query->at(Degrees{49.95}, Degrees{10.2});
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->sources, Names{coarse_.string()});
  const auto filled = query->at(Degrees{49.85}, Degrees{10.23});
  ASSERT_TRUE(filled);
  EXPECT_TRUE(filled->filled);
  EXPECT_TRUE(filled->sources.empty());
  EXPECT_FALSE(query->at(Degrees{51}, Degrees{10.05}));
}

TEST_F(Heights, stateTheErrorOfTheSmallestPatchThere) {
  bakeTwo();
  const auto query = HeightQuery::open(dir_ / "db");
  ASSERT_TRUE(query);
  const auto patches = query->database().patches();
  const PatchIndex& index = patches->index();
  for (int k = 0; k <= 200; ++k) {
    const double column = (index.columns - 1) * (k % 15) / 14.0, row = (index.rows - 1) * k / 200.0;
    const std::uint32_t patch = leafPatchAt(index, column, row);
    ASSERT_LT(patch, index.size());
    EXPECT_EQ(index.children[patch][0], PatchIndex::kNone);
    // Its own mesh reaches the point: some triangle of the finest variant has it inside or on its side.
    const auto page = patches->readPage(index.page[patch]);
    ASSERT_TRUE(page);
    const PatchMesh& mesh = page->patches[patch - index.pages[index.page[patch]].firstPatch];
    bool inside = false;
    for (std::uint32_t i = 0; i < mesh.firstIndex[1]; i += 3) {
      const auto at = [&](std::uint32_t corner) {
        const PatchVertex& v = mesh.vertices[mesh.indices[i + corner]];
        return std::pair{mesh.firstColumn + v.column - column, mesh.firstRow + v.row - row};
      };
      const auto a = at(0), b = at(1), c = at(2);
      const auto turn = [](auto p, auto q) { return p.first * q.second - p.second * q.first; };
      inside = inside || (turn(a, b) >= -1e-9 && turn(b, c) >= -1e-9 && turn(c, a) >= -1e-9);
    }
    EXPECT_TRUE(inside) << column << ' ' << row;
  }
  const auto ground = query->at(Degrees{49.97}, Degrees{10.03});
  ASSERT_TRUE(ground && ground->error);
  EXPECT_GT(ground->error->value(), 0);
  EXPECT_LT(ground->error->value(), 50);
}

TEST_F(Heights, areGivenFromDatabasesWithoutAListOfSources) {
  bakeTwo();
  const auto whole = readPostSources(dir_ / "db");
  ASSERT_TRUE(whole && whole.value()) << toString(whole.findings());
  EXPECT_EQ(whole.value()->names(), (std::vector<std::string>{fine_.string(), coarse_.string()}));
  std::string bytes = test::readFile(dir_ / "db" / kSourcesName);
  bytes[bytes.size() / 2] ^= 1;
  test::writeFile(dir_ / "db" / kSourcesName, bytes);
  const auto damaged = HeightQuery::open(dir_ / "db");
  ASSERT_FALSE(damaged);
  EXPECT_NE(toString(damaged.findings()).find(kSourcesName), std::string::npos);
}

TEST(PostSources, areReadAsTheyWereWrittenAndNeverWorse) {
  PostSources sources({"a, b.tif", ""});
  sources.addRow(std::vector<std::uint16_t>{0, 0, 1, 1, kNoSource, 0});
  sources.addRow(std::vector<std::uint16_t>{1, 1, 1, 1, 1, 1});
  const std::string bytes = sources.encoded();
  const auto again = PostSources::decoded(bytes);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->names(), sources.names());
  for (std::uint32_t c = 0; c < 6; ++c)
    for (std::uint32_t r = 0; r < 3; ++r) EXPECT_EQ(again->at(r, c), sources.at(r, c));
  EXPECT_EQ(again->at(0, 3), 1);
  EXPECT_EQ(again->at(0, 4), kNoSource);
  EXPECT_EQ(again->at(0, 5), 0);
  EXPECT_EQ(again->at(2, 0), kNoSource);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_FALSE(PostSources::decoded(std::string_view(bytes).substr(0, i)));
    for (const int pattern : {0x01, 0x80, 0xff}) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ pattern);
      if (const auto read = PostSources::decoded(changed)) read->at(1, 3);
    }
  }
}

}  // namespace
}  // namespace trimtab::terrain
