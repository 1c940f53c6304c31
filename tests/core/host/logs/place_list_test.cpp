#include "trimtab/host/place_list.h"

#include <gtest/gtest.h>

namespace trimtab {
namespace {

TEST(PlaceList, isReadByTheNamesOfItsColumns) {
  for (const char* text :
       {"latitude_deg,longitude_deg\n46.5,8.25\n-12.25,-77\n", "name;Lng;Lat\nA;8,25;46,5\nB;-77;-12,25\n",
        "# points\nlat\tlon\theight\n46.5\t8.25\t0\n-12.25\t-77\t1\n"}) {
    const auto places = readPlaceList(text, "points.csv");
    ASSERT_TRUE(places) << text << toString(places.findings());
    ASSERT_EQ(places->size(), 2u) << text;
    EXPECT_EQ((*places)[0].latitude.value(), 46.5) << text;
    EXPECT_EQ((*places)[0].longitude.value(), 8.25) << text;
    EXPECT_EQ((*places)[1].latitude.value(), -12.25) << text;
    EXPECT_EQ((*places)[1].longitude.value(), -77) << text;
  }
}

TEST(PlaceList, refusesWhatNamesNoPlaces) {
  for (const auto& [text, said] : {std::pair{"x,y\n1,2\n", "points.csv"},
                                   {"lat,lat,lon\n1,2,3\n", "latitude_deg"},
                                   {"lat,lon\n1,2\n91,3\n", "points.csv:3"},
                                   {"lat,lon\n1,2\n1,361\n", "-360 to 360"},
                                   {"lat,lon\n1,2\n1\n", "number of cells"},
                                   {"lat,lon\n1,east\n", "points.csv:2"}}) {
    const auto places = readPlaceList(text, "points.csv");
    ASSERT_FALSE(places) << text;
    EXPECT_NE(toString(places.findings()).find(said), std::string::npos) << toString(places.findings());
  }
}

}  // namespace
}  // namespace trimtab
