#include <cmath>
#include <map>
#include <numbers>

#include "tests/core/terrain/elevation/rasters.h"
#include "tests/core/terrain/elevation/read_elevation.h"
#include "trimtab/host/placement_list.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::terrain {
namespace {

class World : public ::testing::Test {
 protected:
  std::string make(std::uint32_t seed) {
    SampleOptions options;
    options.seed = seed, options.sizeKm = 60, options.postM = 200, options.objects = true;
    const auto done = writeSample(dir_ / "some.tif", options);
    EXPECT_TRUE(done) << toString(done.findings());
    return test::readFile(sampleObjects(dir_ / "some.tif"));
  }
  test::ScratchDir dir_;
};

TEST_F(World, isTheSameForASeedAndAnotherForAnother) {
  const std::string first = make(3);
  EXPECT_TRUE(make(3) == first);
  EXPECT_FALSE(make(4) == first);
  EXPECT_EQ(test::namesIn(dir_.path()),
            (std::vector<std::string>{"some-objects", "some-objects.csv", "some.tif"}));
}

TEST_F(World, standsOnDryGroundOffTheRunwayWithPylonsInALine) {
  const auto list = readPlacementList(make(2), "list");
  ASSERT_TRUE(list);
  EXPECT_TRUE(list.findings().empty()) << toString(list.findings());
  const auto grid = test::readElevation(dir_ / "some.tif");
  ASSERT_TRUE(grid);
  std::map<std::string, int> counts;
  std::vector<const ListedPlacement*> pylons;
  for (const ListedPlacement& p : list->placements) {
    const std::string name = std::filesystem::path(list->models[p.model]).stem().string();
    ++counts[name];
    if (name == "pylon") pylons.push_back(&p);
    const double column = grid->posts.columnOf(p.longitude.value()),
                 row = grid->posts.rowOf(p.latitude.value());
    ASSERT_TRUE(column > 0 && row > 0 && column < grid->posts.columns - 1 && row < grid->posts.rows - 1);
    const std::size_t i =
        static_cast<std::size_t>(row) * grid->posts.columns + static_cast<std::size_t>(column);
    for (const std::size_t k : {i, i + 1, i + grid->posts.columns, i + grid->posts.columns + 1})
      ASSERT_GT(grid->heights[k], 0) << name << " in line " << p.line;
    const double east = (p.longitude.value() - 128.35) * 89450, north = (p.latitude.value() - 36.63) * 110970;
    const double turn = 100 * std::numbers::pi / 180;
    const bool along = std::abs(east * std::sin(turn) + north * std::cos(turn)) < 1500,
               across = std::abs(east * std::cos(turn) - north * std::sin(turn)) < 200;
    const bool light = name.ends_with("-light");
    ASSERT_TRUE(light || !(along && across)) << name << " on the runway, line " << p.line;
  }
  EXPECT_EQ(counts.size(), 18u);
  EXPECT_NEAR(static_cast<double>(list->placements.size()), 197000, 6000);
  EXPECT_GT(counts["house"] + counts["large-house"] + counts["flats"], 700);
  EXPECT_EQ(counts["church"], 1);
  EXPECT_EQ(counts["hangar"], 6);
  EXPECT_EQ(counts["runway-light"], 92);
  EXPECT_EQ(counts["threshold-light"], 10);
  EXPECT_EQ(counts["runway-end-light"], 10);
  EXPECT_GT(counts["street-light"], 300);
  EXPECT_EQ(counts["control-tower"], 1);
  ASSERT_GT(pylons.size(), 40u);
  const auto bearing = [](const ListedPlacement& a, const ListedPlacement& b) {
    return std::atan2((b.longitude.value() - a.longitude.value()) * 89450,
                      (b.latitude.value() - a.latitude.value()) * 110970) *
           180 / std::numbers::pi;
  };
  for (std::size_t i = 1; i < pylons.size(); ++i)
    EXPECT_NEAR(bearing(*pylons[i - 1], *pylons[i]), pylons[i]->heading.value(), 1);
}

}  // namespace
}  // namespace trimtab::terrain
