#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "rasters.h"
#include "read_elevation.h"

/// Voids that no tag names, beside a tag, in a deep sea, and numbers that are no heights at all.
namespace trimtab::terrain {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class VoidNumbers : public ::testing::Test {
 protected:
  Result<HeightGrid> read(const test::RasterRecipe& recipe) {
    return test::readElevation(test::writeRaster(dir_ / "a.tif", recipe));
  }
  static std::size_t voids(const HeightGrid& grid) {
    return static_cast<std::size_t>(
        std::count_if(grid.heights.begin(), grid.heights.end(), [](float h) { return std::isnan(h); }));
  }
  static float lowest(const HeightGrid& grid) {
    float low = std::numeric_limits<float>::max();
    for (const float h : grid.heights)
      if (!std::isnan(h)) low = std::min(low, h);
    return low;
  }
  test::ScratchDir dir_;
};

double land(int c, int r) {
  return 700 + 3 * c + 40 * std::sin(r * 0.2);
}
bool isHole(int c, int r) {
  return c >= 30 && c < 41 && r >= 12 && r < 19;
}

TEST_F(VoidNumbers, besideATagAreVoids) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double tag : {-32768.0, nan, -3.4028234663852886e38, 0.0})
    for (const double number : {-9999.0, -32767.0, -8123.25, 32767.0, 9000.0}) {
      test::RasterRecipe recipe;
      recipe.noData = tag;
      recipe.value = [&](int c, int r, int) {
        return isHole(c, r) ? number : c == 3 && r == 4 ? tag : land(c, r);
      };
      const auto grid = read(recipe);
      ASSERT_TRUE(grid) << tag << ", " << number;
      EXPECT_EQ(voids(*grid), 78u) << tag << ", " << number;
      EXPECT_GT(lowest(*grid), 650) << tag << ", " << number;
      EXPECT_THAT(toString(grid.findings()), HasSubstr("77 ")) << tag << ", " << number;
    }
}

TEST_F(VoidNumbers, ofRowsOfZerosInMountainsAreVoids) {
  test::RasterRecipe recipe;
  recipe.noData = -32768;
  recipe.value = [](int c, int r, int) { return r == 20 ? 0 : r == 41 ? -7321.5 : 900 + 2 * land(c, r); };
  const auto grid = read(recipe);
  ASSERT_TRUE(grid);
  EXPECT_EQ(voids(*grid), 130u);
  EXPECT_THAT(toString(grid.findings()), AllOf(HasSubstr("65 of 0"), HasSubstr("65 of -7321.5")));
}

TEST_F(VoidNumbers, areNeitherTheSeaNorALevelTopNorMostOfAFile) {
  const std::function<double(int, int)> grounds[] = {
      [](int c, int) { return c < 20 ? 0.0 : 420.0 + c; },                             // a sea below cliffs
      [](int c, int r) { return c > 50 && r > 50 ? 1700.0 : 20.0 + c; },               // a table mountain
      [](int c, int r) { return c == 5 && r < 40 ? 900.0 : 250.0; },                   // level land
      [](int c, int r) { return r < 6 ? -180.0 + (c % 2) : 100.0 + 0.5 * (c + r); }};  // a pit
  for (const auto& ground : grounds) {
    test::RasterRecipe recipe;
    recipe.value = [&](int c, int r, int) { return ground(c, r); };
    const auto grid = read(recipe);
    ASSERT_TRUE(grid);
    EXPECT_EQ(voids(*grid), 0u) << toString(grid.findings());
  }
}

TEST_F(VoidNumbers, leaveADeepSeaAsItIs) {
  const auto sea = [](int c, int r) { return 250.0 - 82 * c - 3 * (r % 9); };  // to -5,000 m
  for (const double number : {-32768.0, -9999.0, 1e30, 32767.0}) {
    test::RasterRecipe recipe;
    recipe.value = [&](int c, int r, int) { return c == 50 && r > 3 && r < 9 ? number : sea(c, r); };
    const auto grid = read(recipe);
    ASSERT_TRUE(grid) << number;
    EXPECT_EQ(voids(*grid), 5u) << number;
    EXPECT_EQ(lowest(*grid), static_cast<float>(sea(64, 8))) << number;
  }
}

TEST_F(VoidNumbers, thatWereResampledAreNoSeaFloor) {
  // A hole whose border was mixed with the land, in other parts at each post.
  test::RasterRecipe recipe;
  recipe.value = [](int c, int r, int) {
    const int inside = std::min({c - 20, 45 - c, r - 20, 45 - r});
    const double share = 0.1 + 0.8 * ((c * 37 + r * 61) % 97) / 97.0;
    return inside > 0 ? -32768.0 : inside == 0 ? land(c, r) * (1 - share) - 32768 * share : land(c, r);
  };
  const auto grid = read(recipe);
  ASSERT_TRUE(grid);
  EXPECT_EQ(voids(*grid), 26u * 26);
  EXPECT_GT(lowest(*grid), 600);
}

TEST_F(VoidNumbers, thatFillMostOfAFileAreRefused) {
  struct Case {
    const char* name;
    GDALDataType type;
    std::function<double(double)> value;
    const char* says;
  };
  const Case cases[] = {
      {"two bytes exchanged", GDT_Int16,
       [](double h) {
         const auto bits = static_cast<std::uint16_t>(static_cast<int>(h));
         return static_cast<double>(
             static_cast<std::int16_t>(static_cast<std::uint16_t>(bits << 8 | bits >> 8)));
       },
       "the file has the wrong byte order"},
      {"centimetres", GDT_Int32, [](double h) { return std::round(h * 100); }, "in another unit"},
  };
  for (const Case& c : cases) {
    test::RasterRecipe recipe;
    recipe.type = c.type;
    recipe.value = [&](int column, int r, int) { return c.value(land(column, r)); };
    const auto grid = read(recipe);
    ASSERT_FALSE(grid) << c.name;
    EXPECT_THAT(toString(grid.findings()),
                AllOf(HasSubstr("a.tif"), HasSubstr("% of the numbers outside"), HasSubstr(c.says)));
  }
}

TEST_F(VoidNumbers, ofAFewImpossiblePostsAreVoids) {
  test::RasterRecipe recipe;
  recipe.value = [](int c, int r, int) { return (c + 65 * r) % 16 == 0 ? 20000.0 + 10 * c + r : land(c, r); };
  const auto grid = read(recipe);
  ASSERT_TRUE(grid) << toString(grid.findings());
  EXPECT_EQ(voids(*grid), 265u);
}

}  // namespace
}  // namespace trimtab::terrain
