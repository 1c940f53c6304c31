#include "trimtab/terrain/elevation/height_unit.h"

#include <gtest/gtest.h>

#include "rasters.h"
#include "read_elevation.h"

/// Heights come to metres whatever unit they are in, and a unit that is not known is asked for.
namespace trimtab::terrain {
namespace {

TEST(HeightUnit, isKnownByTheNamesOfEachProgram) {
  const double us = 1200.0 / 3937;
  for (const auto& [name, metres] : {std::pair{"m", 1.0},
                                     {"Meters", 1.0},
                                     {"metre", 1.0},
                                     {"[m]", 1.0},
                                     {"US_survey_feet", us},
                                     {"US survey foot", us},
                                     {"Foot_US", us},
                                     {"ftUS", us},
                                     {"us-ft", us},
                                     {"sfoot", us},
                                     {"Foot (US survey)", us},
                                     {"Foot (International)", 0.3048},
                                     {"international_foot", 0.3048},
                                     {"FEET", 0.3048},
                                     {"ft", 0.3048},
                                     {"decimeters", 0.1},
                                     {"dm", 0.1},
                                     {"centimetre", 0.01},
                                     {"mm", 0.001},
                                     {"kilometers", 1000.0},
                                     {"yards", 0.9144},
                                     {"fathom", 1.8288},
                                     {"0.25 m", 0.25},
                                     {"10 ft", 3.048}})
    EXPECT_DOUBLE_EQ(metresPerUnit(name).value_or(-1), metres) << name;
  for (const char* name : {"", "degree", "percent", "K", "gpm", "footballs", "-1 m", "nan m", "m/s", "5"})
    EXPECT_FALSE(metresPerUnit(name)) << name;
}

class HeightsInUnits : public ::testing::Test {
 protected:
  /// The height of a post whose number is 1234, or what is refused.
  Result<double> heightOf(const std::string& unit, const std::string& crs,
                          std::optional<double> told = {}) const {
    test::RasterRecipe recipe;
    recipe.unit = unit;
    recipe.crs = crs;
    if (crs != "EPSG:4326") recipe.west = 1'000'000, recipe.north = 300'000, recipe.step = 100;
    recipe.value = [](int, int, int) { return 1234.0; };
    const auto file = test::writeRaster(dir_ / "heights.tif", recipe);
    ElevationOptions options;
    options.reading.heightUnit = told;
    auto source = openElevation(std::span(&file, 1), options);
    if (!source) return source.findings();
    const auto grid = test::allRows(**source);
    if (!grid) return grid.findings();
    const PostGrid& posts = grid->posts;
    return Result<double>(
        double{grid->heights[std::size_t{posts.rows / 2} * posts.columns + posts.columns / 2]},
        source.findings());
  }
  void expectAsked(const Result<double>& height, const std::string& found) const {
    ASSERT_FALSE(height) << *height;
    const std::string text = toString(height.findings());
    EXPECT_NE(text.find("--height-unit"), std::string::npos) << text;
    EXPECT_NE(text.find("heights.tif"), std::string::npos) << text;
    EXPECT_NE(text.find(found), std::string::npos) << text;
  }
  test::ScratchDir dir_;
};

constexpr const char* kStatePlaneFeet = "EPSG:2263";  // US survey feet, Long Island
constexpr double kUsFoot = 1200.0 / 3937;

TEST_F(HeightsInUnits, areThoseOfTheBandOrOfTheVerticalCrs) {
  for (const auto& [unit, crs, metres] : {std::tuple{"decimetre", "EPSG:4326", 123.4},
                                          {"Foot (International)", kStatePlaneFeet, 1234 * 0.3048},
                                          {"", "EPSG:2263+6360", 1234 * kUsFoot},
                                          {"", "EPSG:32118+5703", 1234.0},
                                          {"", "EPSG:32118", 1234.0},
                                          {"", "EPSG:4326", 1234.0}}) {
    const auto height = heightOf(unit, crs);
    ASSERT_TRUE(height) << unit << crs << toString(height.findings());
    EXPECT_NEAR(*height, metres, 2e-3) << unit << crs;
  }
}

TEST_F(HeightsInUnits, areAskedForWhereNothingSaysThem) {
  expectAsked(heightOf("", kStatePlaneFeet), "found none");
  expectAsked(heightOf("cubit", "EPSG:4326"), "\"cubit\"");
  expectAsked(heightOf("metre", "EPSG:2263+6360"), "\"metre\"");
}

TEST_F(HeightsInUnits, areWhatTheUserSaysWhereTheFileDoesNot) {
  for (const auto& [unit, crs] :
       {std::pair{"", kStatePlaneFeet}, {"cubit", "EPSG:4326"}, {"", "EPSG:4326"}}) {
    const auto height = heightOf(unit, crs, 0.4572);
    ASSERT_TRUE(height) << toString(height.findings());
    EXPECT_NEAR(*height, 1234 * 0.4572, 1e-3) << unit << crs;
  }
  const auto kept = heightOf("dm", "EPSG:4326", 0.3048);
  ASSERT_TRUE(kept);
  EXPECT_NEAR(*kept, 123.4, 1e-3);
  EXPECT_NE(toString(kept.findings()).find("kept"), std::string::npos) << toString(kept.findings());
}

}  // namespace
}  // namespace trimtab::terrain
