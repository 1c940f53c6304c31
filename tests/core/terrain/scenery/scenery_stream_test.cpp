#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenery_tiles.h"
#include "trimtab/terrain/ground/triangles.h"
#include "trimtab/terrain/scenery/import.h"

/// Scenery whose tiles are not all in memory.
namespace trimtab {
namespace {

using terrain::HeightGrid;
using terrain::PostGrid;
using terrain::Rectangle;
using terrain::SceneryCatalogue;
using terrain::SceneryMesh;

/// Eleven tiles about a bay and a gap in the hills, which no tile covers.
class SceneryStream : public ::testing::Test {
 protected:
  SceneryStream() {
    std::filesystem::create_directory(folder_);
    const auto height = [](double x, double y) {
      return x > 7.45 ? 0 : 300 + 200 * std::sin(x * 80) * std::cos(y * 90);
    };
    int number = 3072816;
    for (const auto& [column, row] :
         {std::pair{0, 0}, {1, 0}, {2, 0}, {0, 1}, {2, 1}, {0, 2}, {1, 2}, {2, 2}, {4, 0}, {4, 1}, {4, 2}}) {
      test::TileRecipe recipe;
      recipe.west = 7 + 0.25 * column, recipe.south = 50.5 + 0.125 * row;
      recipe.heightM = height;
      recipe.cells = 10;
      test::writeFile(folder_ / (std::to_string(number++) + ".btg"), test::gridTile(recipe));
    }
  }
  std::unique_ptr<SceneryCatalogue> catalogue(std::size_t memory) const {
    auto opened = SceneryCatalogue::open(std::span(&folder_, 1), memory, {});
    EXPECT_TRUE(opened) << toString(opened.findings());
    return opened ? std::move(opened).value() : nullptr;
  }

  test::ScratchDir dir_;
  std::filesystem::path folder_ = dir_ / "scenery";
  static constexpr std::size_t kAll = std::size_t{1} << 30;
};

bool same(std::span<const float> a, std::span<const float> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

TEST_F(SceneryStream, givesTheSameTilesWhateverStaysInMemory) {
  const auto all = catalogue(kAll), none = catalogue(0), some = catalogue(9000);
  ASSERT_EQ(all->tiles().size(), 11U);
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    const std::size_t tile = random() % all->tiles().size();
    const auto expected = all->mesh(tile);
    for (const auto* other : {none.get(), some.get()}) {
      const auto found = other->mesh(tile);
      ASSERT_TRUE(found);
      EXPECT_EQ((*found)->mesh.name, all->tiles()[tile].name);
      ASSERT_EQ((*found)->places.size(), (*expected)->places.size());
      for (std::size_t v = 0; v < (*found)->places.size(); ++v)
        EXPECT_TRUE((*found)->places[v] == (*expected)->places[v]);
    }
  }
  EXPECT_EQ(*all->mesh(3), *all->mesh(3)) << "it stays";
  EXPECT_NE(*none->mesh(3), *none->mesh(3));
  // A file that has gone is told of.
  std::filesystem::remove(none->tiles()[3].file);
  const auto gone = none->mesh(3);
  ASSERT_FALSE(gone);
  EXPECT_NE(toString(gone.findings()).find(none->tiles()[3].name), std::string::npos);
  EXPECT_FALSE(none->takeAll());
}

TEST_F(SceneryStream, takesAllOutInTheirOrder) {
  const auto all = catalogue(9000);
  const auto meshes = all->takeAll();
  ASSERT_TRUE(meshes);
  ASSERT_EQ(meshes->size(), 11U);
  const auto read = terrain::readScenery(folder_);
  for (std::size_t i = 0; i < meshes->size(); ++i) {
    EXPECT_EQ((*meshes)[i].name, read->tiles[i].name);
    EXPECT_TRUE((*meshes)[i].vertices == read->tiles[i].vertices);
  }
}

/// Areas by flooding, as a person would.
std::vector<std::uint8_t> flooded(const HeightGrid& grid, const std::vector<std::uint8_t>& reached) {
  const auto columns = static_cast<std::ptrdiff_t>(grid.posts.columns),
             posts = static_cast<std::ptrdiff_t>(grid.posts.size());
  std::vector<std::uint8_t> sea(reached.size()), seen(reached);
  for (std::ptrdiff_t start = 0; start < posts; ++start) {
    if (seen[static_cast<std::size_t>(start)] != 0) continue;
    std::vector<std::ptrdiff_t> area{start};
    seen[static_cast<std::size_t>(start)] = 1;
    int border = 0, level = 0;
    for (std::size_t i = 0; i < area.size(); ++i)
      for (const auto& [right, up] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
        const std::ptrdiff_t next = area[i] + right + up * columns;
        if (next < 0 || next >= posts || next / columns != area[i] / columns + up) continue;
        const auto at = static_cast<std::size_t>(next);
        if (reached[at] != 0) {
          border += !std::isnan(grid.heights[at]);
          level += std::abs(grid.heights[at]) <= 0.5f;
        } else if (seen[at] == 0) {
          seen[at] = 1;
          area.push_back(next);
        }
      }
    if (border > 0 && 2 * level >= border)
      for (const std::ptrdiff_t post : area) sea[static_cast<std::size_t>(post)] = 1;
  }
  return sea;
}

/// The rows in one piece, with the sea by flooding.
HeightGrid atOnce(const SceneryCatalogue& scenery, const PostGrid& posts) {
  const terrain::SceneryRaster raster(scenery, posts);
  HeightGrid grid{posts, std::vector<float>(posts.size()), 0, std::vector<std::uint8_t>(posts.size() * 4)};
  EXPECT_TRUE(raster.read(0, posts.rows, grid.heights, grid.image));
  std::vector<std::uint8_t> reached(posts.size());
  for (std::uint32_t row = 0; row < posts.rows; ++row)
    raster.reached(row, std::span(reached).subspan(std::size_t{row} * posts.columns, posts.columns));
  const auto sea = flooded(grid, reached);
  const auto blue = terrain::materialColour("Ocean");
  for (std::size_t i = 0; i < posts.size(); ++i) {
    grid.outside += reached[i] == 0 && sea[i] == 0;
    if (sea[i] == 0) continue;
    grid.heights[i] = 0;
    std::copy_n(blue.data(), 3, &grid.image[4 * i]);
    grid.image[4 * i + 3] = 255;
  }
  return grid;
}

TEST_F(SceneryStream, hasTheSameHeightsInAnyBands) {
  const auto all = catalogue(kAll), none = catalogue(0);
  const auto posts = terrain::sceneryPosts(*all, Metres{400});
  ASSERT_TRUE(posts);
  // The bay is sea; the gap in the hills is not.
  const HeightGrid grid = atOnce(*all, *posts);
  const auto heights = terrain::SceneryHeights::open(*none, *posts, {});
  ASSERT_TRUE(heights);
  const std::size_t columns = posts->columns;
  std::uint64_t beyondAll = 0, sea = 0;
  std::mt19937 random(4);
  for (std::uint32_t first = 0; first < posts->rows;) {
    const std::uint32_t rows = std::min(1 + static_cast<std::uint32_t>(random() % 9), posts->rows - first);
    std::vector<float> band(rows * columns);
    std::vector<std::uint8_t> beyond(rows * columns, 7);
    ASSERT_TRUE((*heights)->readRows(first, rows, band, beyond));
    EXPECT_TRUE(same(band, std::span(grid.heights).subspan(first * columns, rows * columns))) << first;
    for (std::size_t i = 0; i < band.size(); ++i) {
      beyondAll += beyond[i];
      sea += band[i] == 0;
      if (beyond[i] != 0) {
        EXPECT_TRUE(std::isnan(band[i]));
      }
    }
    first += rows;
  }
  EXPECT_EQ(beyondAll, grid.outside);
  EXPECT_GT(beyondAll, posts->size() / 20);
  EXPECT_GT(sea, posts->size() / 10);
  EXPECT_TRUE(*(*heights)->image({}) == grid.image);
  const auto stopped =
      terrain::SceneryHeights::open(*none, *posts, [](double, const std::string&) { return false; });
  EXPECT_FALSE(stopped);
}

TEST_F(SceneryStream, paintsTheSameTrianglesWhicheverAreaIsAskedFor) {
  const auto none = catalogue(0);
  const terrain::SceneryGround ground(*none, 7.5), turned(*none, 367.5);
  const auto every = ground.over({-180, -90, 180, 90});
  ASSERT_TRUE(every);
  EXPECT_EQ(every->size(), none->counts().triangles);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(6.9, 8.3), y(50.4, 50.9), size(0, 0.3);
  for (int i = 0; i < 50; ++i) {
    const double west = x(random), south = y(random);
    const Rectangle where{west, south, west + size(random), south + size(random)};
    std::vector<terrain::GroundTriangle> expected;
    for (const auto& t : *every) {
      const auto [w, e] = std::minmax_element(t.longitude.begin(), t.longitude.end());
      const auto [s, n] = std::minmax_element(t.latitude.begin(), t.latitude.end());
      if (*w <= where.east && *e >= where.west && *s <= where.north && *n >= where.south)
        expected.push_back(t);
    }
    const auto found = ground.over(where), beyond = turned.over(where.turned(360));
    ASSERT_EQ(found->size(), expected.size());
    ASSERT_EQ(beyond->size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_EQ((*found)[k].longitude, expected[k].longitude);
      EXPECT_EQ((*found)[k].colour, expected[k].colour);
      EXPECT_NEAR((*beyond)[k].longitude[0], expected[k].longitude[0] + 360, 1e-9);
    }
  }
}

TEST(OpenSea, isWhatFloodingFinds) {
  std::mt19937 engine(6);
  const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
  for (int round = 0; round < 300; ++round) {
    HeightGrid grid;
    grid.posts.columns = 1 + random() % 24, grid.posts.rows = 1 + random() % 24;
    std::vector<std::uint8_t> reached(grid.posts.size());
    // From labyrinths to single holes.
    const unsigned share = 1 + random() % 9;
    const bool low = random() % 2 == 0;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      reached[i] = random() % 10 < share;
      const unsigned kind = random() % 6;
      grid.heights.push_back(kind == 0 ? std::nanf("") : kind <= (low ? 4U : 2U) ? 0.0f : 50.0f);
    }
    const std::size_t columns = grid.posts.columns;
    terrain::OpenSea sea;
    for (std::size_t row = 0; row < grid.posts.rows; ++row)
      sea.add(std::span(grid.heights).subspan(row * columns, columns),
              std::span(reached).subspan(row * columns, columns));
    sea.finish();
    std::vector<std::uint8_t> found(reached.size());
    for (std::uint32_t row = 0; row < grid.posts.rows; ++row)
      for (const auto& stretch : sea.stretches(row))
        for (std::size_t c = stretch.first; c < stretch.end; ++c)
          found[row * columns + c] = sea.isSea(stretch);
    const auto expected = flooded(grid, reached);
    EXPECT_TRUE(found == expected) << round;
    EXPECT_EQ(sea.posts(), static_cast<std::uint64_t>(std::count(expected.begin(), expected.end(), 1)));
  }
}

}  // namespace
}  // namespace trimtab
