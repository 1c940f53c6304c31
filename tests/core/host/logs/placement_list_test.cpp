#include "trimtab/host/placement_list.h"

#include <gtest/gtest.h>

namespace trimtab {
namespace {

TEST(PlacementList, readsWhereObjectsStand) {
  const auto list = readPlacementList(
      "model,latitude_deg,longitude_deg,height_m,heading_deg,scale\n"
      "a/tree.obj,46.5,8.25,,90,1.5\n\"the, hut.ac\",-12.25,-77,120.5,-30,\na/tree.obj,46.6,8.3,,,\n",
      "places.csv");
  ASSERT_TRUE(list) << toString(list.findings());
  EXPECT_TRUE(list.findings().empty());
  EXPECT_EQ(list->models, (std::vector<std::string>{"a/tree.obj", "the, hut.ac"}));
  ASSERT_EQ(list->placements.size(), 3u);
  const ListedPlacement &a = list->placements[0], &b = list->placements[1], &c = list->placements[2];
  EXPECT_EQ(a.latitude.value(), 46.5);
  EXPECT_EQ(a.longitude.value(), 8.25);
  EXPECT_FALSE(a.height);
  EXPECT_EQ(a.heading.value(), 90);
  EXPECT_EQ(a.scale, 1.5);
  EXPECT_EQ(a.line, 2u);
  EXPECT_EQ(b.model, 1u);
  EXPECT_EQ(b.height->value(), 120.5);
  EXPECT_EQ(b.scale, 1);
  EXPECT_EQ(c.model, 0u);
  EXPECT_EQ(c.heading.value(), 0);
}

TEST(PlacementList, readsOtherTables) {
  const auto list =
      readPlacementList("Lat;Lng;Model;Height (ft);note\n46,5;8,25;t.obj;100;x\n", "places.csv");
  ASSERT_TRUE(list) << toString(list.findings());
  ASSERT_EQ(list->placements.size(), 1u);
  EXPECT_EQ(list->placements[0].latitude.value(), 46.5);
  EXPECT_NEAR(list->placements[0].height->value(), 30.48, 1e-9);
  EXPECT_EQ(list->placements[0].scale, 1);
}

TEST(PlacementList, namesEveryBadRowAndUsesTheRest) {
  const std::string header = "model,latitude_deg,longitude_deg,height_m,heading_deg,scale\n",
                    good = "a.obj,1,2,,0,1\n";
  for (const auto& [row, said] :
       {std::pair{"a.obj,nan,2,,0,1\n", "places.csv:3: latitude_deg: expected -90 to 90"},
        {"a.obj,91,2,,0,1\n", "latitude_deg"},
        {"a.obj,1,inf,,0,1\n", "longitude_deg"},
        {"a.obj,1,,,0,1\n", "longitude_deg"},
        {"a.obj,1,2,1e9,0,1\n", "height_m: expected -20000 to 20000 m"},
        {"a.obj,1,2,high,0,1\n", "found \"high\""},
        {"a.obj,1,2,,1000,1\n", "heading_deg"},
        {"a.obj,1,2,,0,0\n", "scale: expected 0.001 to 1000"},
        {"a.obj,1,2,,0,-1\n", "scale"},
        {"a.obj,1,2,,0,nan\n", "scale"},
        {"a.obj,1,2,,0,1e9\n", "scale"},
        {",1,2,,0,1\n", "model: expected the file of a model"},
        {"a.obj,1,2\n", "6 cells"}}) {
    const auto list = readPlacementList(header + good + row + good, "places.csv");
    ASSERT_TRUE(list) << row;
    EXPECT_EQ(list->placements.size(), 2u) << row;
    ASSERT_EQ(list.findings().size(), 1u) << row << toString(list.findings());
    EXPECT_NE(toString(list.findings()).find(said), std::string::npos) << toString(list.findings());
    EXPECT_NE(toString(list.findings()).find("places.csv:3"), std::string::npos);
    EXPECT_NE(toString(list.findings()).find("left out"), std::string::npos);
  }
}

TEST(PlacementList, refusesWhatPlacesNothing) {
  for (const auto& [text, said] : {std::pair{"x,y\n1,2\n", "latitude_deg"},
                                   {"model,latitude,longitude,height\na,1,2,3\n", "height_m or height_ft"},
                                   {"model,model,latitude,longitude\na,b,1,2\n", "one column each"},
                                   {"model,latitude,longitude\na,95,2\n", "at least one row"},
                                   {"", "places.csv"}}) {
    const auto list = readPlacementList(text, "places.csv");
    ASSERT_FALSE(list) << text;
    EXPECT_NE(toString(list.findings()).find(said), std::string::npos) << toString(list.findings());
  }
}

TEST(PlacementList, countsBadRowsBeyondTheFirst) {
  std::string text = "model,latitude,longitude\na,1,2\n";
  for (int i = 0; i < 100000; ++i) text += "a,1000,2\n";
  const auto list = readPlacementList(text, "places.csv");
  ASSERT_TRUE(list);
  EXPECT_EQ(list.findings().size(), 21u);
  EXPECT_NE(toString(list.findings()).find("99,980 more warnings"), std::string::npos)
      << toString(list.findings());
}

}  // namespace
}  // namespace trimtab
