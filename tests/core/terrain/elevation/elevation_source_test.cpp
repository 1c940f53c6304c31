#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "elevation_fixture.h"

namespace trimtab::terrain {
namespace {

TrueRaster inLambert(double step, int columns, int rows) {
  // 11.88 E, 47.6 N.
  return {"EPSG:3034", test::lambertEurope, 4137000, 2329000, step, columns, rows};
}

struct Mixture {
  const char* name;
  std::vector<TrueRaster> rasters;
  double coarsestM;
};

TEST_F(Elevation, ofMixedSourcesIsTheGroundItself) {
  auto feet = inUtm(32, 47.59, 11.92, 40, 160, 400);
  feet.unit = 0.3048;
  auto old = degrees(11.95, 47.58, 0.0005, 300, 250);
  old.crs = test::kEd50, old.toDegrees = test::ed50;
  const Mixture mixtures[] = {
      {"two zones", {inUtm(32, 47.59, 11.9, 40, 220, 400), inUtm(33, 47.59, 12.02, 40, 200, 400)}, 40},
      {"degrees and metres",
       {degrees(11.9, 47.6, 0.0005, 200, 400), inUtm(33, 47.59, 11.97, 40, 220, 400)},
       56},
      {"half a post aside",
       {degrees(11.9, 47.6, 0.0005, 220, 400), degrees(12.00025, 47.60025, 0.0005, 200, 400)},
       56},
      {"half the resolution",
       {degrees(11.9, 47.6, 0.0005, 220, 400), degrees(11.98, 47.6, 0.001, 120, 200)},
       112},
      {"a cone", {inLambert(50, 200, 420), degrees(12.0, 47.6, 0.0005, 200, 400)}, 56},
      {"another datum", {old, degrees(11.9, 47.6, 0.0005, 220, 400)}, 56},
      {"feet", {feet, inUtm(33, 47.59, 12, 40, 160, 400)}, 40},
      {"all of them",
       {degrees(11.9, 47.6, 0.0005, 100, 400), inUtm(32, 47.59, 11.93, 40, 220, 400), feet, old,
        inUtm(33, 47.59, 12.02, 40, 200, 400), inLambert(50, 200, 420), degrees(11.9, 47.6, 0.001, 200, 200)},
       112},
  };
  for (const Mixture& mixture : mixtures) {
    const auto source = open(mixture.rasters);
    ASSERT_TRUE(source) << mixture.name;
    const auto [worst, count] = error(source->posts(), test::readBands(*source, 64));
    EXPECT_LT(worst, test::bilinearLimit(mixture.coarsestM)) << mixture.name;
    EXPECT_GT(count, source->posts().size() / 2) << mixture.name;
    std::printf("%-22s %9zu posts, worst %.3f m; bilinear might be %.3f m\n", mixture.name, count, worst,
                test::bilinearLimit(mixture.coarsestM));
  }
}

TEST_F(Elevation, knowsAnOldDatum) {
  auto old = degrees(-105.1, 40.1, 0.0005, 400, 400);
  old.crs = "EPSG:4267";  // NAD27: some 50 m aside there
  const auto source = open({old});
  ASSERT_TRUE(source);
  const auto heights = test::readBands(*source, 64);
  // The raster was written as if it were WGS84: so the ground must be found some 50 m to the east of itself.
  const auto misfit = [&](double eastM, double northM) {
    double sum = 0;
    const PostGrid& p = source->posts();
    for (std::size_t i = 0; i < heights.size(); i += 7)
      if (!std::isnan(heights[i]))
        sum += std::pow(static_cast<double>(heights[i]) -
                            test::trueHeight(p.latitude(static_cast<double>(i / p.columns)) - northM / 111000,
                                             p.longitude(static_cast<double>(i % p.columns)) - eastM / 85200),
                        2);
    return sum;
  };
  EXPECT_LT(misfit(-48, 0), 0.2 * misfit(0, 0));
}

TEST_F(Elevation, isKnownAcrossTheDateLine) {
  auto east = inUtm(1, -17.01, -180, 40, 400, 300, false);
  const auto source = open({degrees(179.8, -17, 0.0005, 401, 300), east});
  ASSERT_TRUE(source);
  const auto heights = test::readBands(*source, 32);
  const auto [worst, count] = error(source->posts(), heights);
  EXPECT_LT(worst, test::bilinearLimit(56));
  EXPECT_GT(count, 600u * 250);
  EXPECT_LT(source->posts().columns * source->posts().stepLongitude, 0.5);
  // Zone 60 by itself, on both sides of the line.
  const auto alone = open({inUtm(60, 12, 179.9, 40, 600, 200)});
  ASSERT_TRUE(alone);
  const auto [worstAlone, countAlone] = error(alone->posts(), test::readBands(*alone, 32));
  EXPECT_LT(worstAlone, test::bilinearLimit(40));
  EXPECT_GT(countAlone, 100000u);
}

TEST_F(Elevation, goesRoundTheEarthOnce) {
  test::RasterRecipe posts, pixels, fine;
  // Posts at whole degrees from -180 to 180, or pixels between them.
  posts.west = -180.5, posts.north = 10.5, posts.step = 1, posts.columns = 361, posts.rows = 21;
  pixels.west = -180, pixels.north = 10, pixels.step = 0.5, pixels.columns = 720, pixels.rows = 40;
  fine.west = 177.95, fine.north = 4.05, fine.step = 0.1, fine.columns = 121, fine.rows = 81;
  fine.value = [](int, int, int) { return 200.0; };
  int count = 0;
  for (const test::RasterRecipe& base : {posts, pixels})
    for (const double turn : {0.0, -360.0})
      for (const bool fineFirst : {false, true}) {
        SCOPED_TRACE(count);
        test::RasterRecipe moved = fine;
        moved.west += turn;
        const fs::path baseFile = test::writeRaster(dir_ / ("base" + std::to_string(count) + ".tif"), base),
                       file = test::writeRaster(dir_ / ("fine" + std::to_string(count++) + ".tif"), moved);
        const std::vector<fs::path> files = {fineFirst ? file : baseFile, fineFirst ? baseFile : file};
        const auto opened = openElevation(files);
        ASSERT_TRUE(opened) << toString(opened.findings());
        ElevationSource& source = **opened;
        const PostGrid& p = source.posts();
        EXPECT_LE((p.columns - 1) * p.stepLongitude, 360 + 1e-9);
        EXPECT_GE((p.columns + 1) * p.stepLongitude, 360);
        EXPECT_GT(p.west, -180.5);
        EXPECT_LT(p.west, -179.5);
        const auto heights = test::readBands(source, 32);
        // Within four degrees of the equator, and where the fine file does not give way: 181.2 to 186.8.
        const auto middle = static_cast<std::uint32_t>(std::lround(-p.south / p.stepLatitude));
        std::size_t led = 0;
        for (std::uint32_t c = 0; c < p.columns; ++c) {
          const double east = p.longitude(c) < 0 ? p.longitude(c) + 360 : p.longitude(c);
          const float height = heights[std::size_t{middle} * p.columns + c];
          const bool isFine = east > 177.99 && east < 190.01;
          if (isFine) ++led;
          ASSERT_GE(height, 100) << east;
          ASSERT_LE(height, isFine ? 200 : 100) << east;
          if (east > 181.3 && east < 186.7) {
            ASSERT_EQ(height, 200) << east;
          }
        }
        // One surface, where it is cut too: at the date line the fine file is two thirds of the way in.
        const std::size_t row = std::size_t{middle} * p.columns;
        EXPECT_NEAR(heights[row], heights[row + p.columns - 1], 5);
        EXPECT_NEAR(heights[row + 1] - heights[row],
                    heights[row + p.columns - 1] - heights[row + p.columns - 2], 1);
        EXPECT_GT(heights[row], 155);
        EXPECT_GE(led, 121u);
        EXPECT_EQ(source.names(), (std::vector<std::string>{file.string(), baseFile.string()}));
        ASSERT_EQ(source.given().size(), 2u);
        // Where most is its own: from 15 posts within its border, or nearer where pixels leave the line to
        // it.
        EXPECT_GT(source.given()[0], 4500u);
        EXPECT_LT(source.given()[0], 6000u);
      }
}

TEST_F(Elevation, isKnownBeyondTheEdgeOfACylinder) {
  // On both sides of the date line, as one raster, by either edge; at the equator and far from it.
  constexpr double kEdge = 20037508.342789244, kRadius = 6378137, kDegree = std::numbers::pi / 180;
  for (const double side : {1.0, -1.0})
    for (const double north : {6000.0, 6500000.0}) {
      TrueRaster mercator{
          "EPSG:3857",
          [](double x, double y) {
            return test::Degrees2{std::atan(std::sinh(y / kRadius)) / kDegree, x / kRadius / kDegree};
          },
          side * kEdge - 100 * 60,
          north,
          60,
          200,
          100};
      const auto source = open({mercator});
      ASSERT_TRUE(source);
      const PostGrid& posts = source->posts();
      EXPECT_NEAR((posts.columns - 1) * posts.stepLongitude, 199 * 60 / kRadius / kDegree, 0.002);
      const auto [worst, count] = error(posts, test::readBands(*source, 32));
      EXPECT_LT(worst, test::bilinearLimit(60));
      EXPECT_GE(count, 199u * 99);
      // A world and a half.
      mercator.columns = 90, mercator.step = 2 * kEdge / 60, mercator.rows = 2, mercator.north = 1e6;
      mercator.west = -1.5 * kEdge;
      const fs::path wide = test::write(dir_ / "wide.tif", mercator);
      const auto once = openElevation(std::span(&wide, 1));
      ASSERT_TRUE(once) << toString(once.findings());
      EXPECT_NE(toString(once.findings()).find("29 columns more, from column 61"), std::string::npos)
          << toString(once.findings());
      EXPECT_LE(((*once)->posts().columns - 1) * (*once)->posts().stepLongitude, 360 + 1e-6);
    }
}

TEST_F(Elevation, leavesOutColumnsThatRepeatTheFirst) {
  test::RasterRecipe recipe;
  recipe.west = -180.5, recipe.north = 10, recipe.step = 1, recipe.rows = 20;
  recipe.value = [](int c, int r, int) { return 10 * (c % 360) + r; };
  for (const int columns : {361, 362, 800}) {
    recipe.columns = columns;
    const fs::path file = test::writeRaster(dir_ / "wide.tif", recipe);
    const auto opened = openElevation(std::span(&file, 1));
    ASSERT_TRUE(opened) << toString(opened.findings());
    const PostGrid& posts = (*opened)->posts();
    ASSERT_EQ(posts.columns, 361u);
    std::vector<float> row(posts.columns);
    ASSERT_TRUE((*opened)->readRows(0, 1, row));
    for (int c = 0; c < 361; ++c) ASSERT_EQ(row[static_cast<std::size_t>(c)], 10 * (c % 360) + 19) << c;
    const std::string text = toString(opened.findings());
    const std::string said = std::to_string(columns - 361) + " columns more, from column 361";
    EXPECT_EQ(text.find(said) != std::string::npos, columns > 361) << text;
  }
}

TEST_F(Elevation, inAnOrdinaryProjectionIsReadWithoutAWarning) {
  for (const auto& [crs, x, y] : {std::tuple{"EPSG:2154", 700000.0, 6600000.0},
                                  {"EPSG:32118", 300000.0, 60000.0},
                                  {"EPSG:2263", 1000000.0, 200000.0}}) {
    test::RasterRecipe recipe;
    recipe.crs = crs, recipe.west = x, recipe.north = y, recipe.step = 30;
    recipe.unit = "m";
    const fs::path file = test::writeRaster(dir_ / "projected.tif", recipe);
    const auto opened = openElevation(std::span(&file, 1));
    ASSERT_TRUE(opened) << toString(opened.findings());
    EXPECT_TRUE(opened.findings().empty()) << crs << toString(opened.findings());
  }
}

TEST_F(Elevation, isKnownAtThePole) {
  const auto source = open({degrees(20, 89.95, 0.0005, 400, 200)});
  ASSERT_TRUE(source);
  EXPECT_LT(error(source->posts(), test::readBands(*source, 32)).first, 0.01);
  // Universal polar stereographic, with the pole 1 km from its edge.
  TrueRaster cap{"EPSG:32661", test::utm(0), 1990000, 2015000, 50, 500, 500};
  const auto pole = open({cap});
  ASSERT_TRUE(pole);
  EXPECT_EQ(pole->posts().latitude(pole->posts().rows - 1), 90);
  EXPECT_NEAR(pole->posts().columns * pole->posts().stepLongitude, 360, 1);
  const auto heights = test::readBands(*pole, 32);
  const auto [worst, count] = error(pole->posts(), heights);
  EXPECT_LT(worst, test::bilinearLimit(50));
  EXPECT_GT(count, 250000u);
  for (std::size_t i = heights.size() - pole->posts().columns; i < heights.size(); ++i)
    ASSERT_NEAR(heights[i], test::trueHeight(90, 0), 0.5);
  // In two parts, one of them without the pole.
  TrueRaster left = cap, right = cap;
  left.columns = 300, right.columns = 200, right.west += 300 * 50;
  const auto both = open({left, right});
  ASSERT_TRUE(both);
  const auto [worstOfTwo, countOfTwo] = error(both->posts(), test::readBands(*both, 32));
  EXPECT_LT(worstOfTwo, test::bilinearLimit(50));
  EXPECT_GT(countOfTwo, 250000u);
}

TEST_F(Elevation, isKnownInTheSouthAndFromTheSouth) {
  auto turned = degrees(-70.5, -33, 0.0005, 300, 300);
  turned.southUp = true;
  const auto source = open({turned, inUtm(19, -33.02, -70.4, 40, 300, 300, false)});
  ASSERT_TRUE(source);
  const auto [worst, count] = error(source->posts(), test::readBands(*source, 32));
  EXPECT_LT(worst, test::bilinearLimit(56));
  EXPECT_GT(count, 90000u);
}

TEST_F(Elevation, isTakenToTheBitFromTheFinestFileItself) {
  const auto fine = degrees(12.0, 47.55, 0.0005, 150, 120);
  const auto alone = open({fine}), joined = open({degrees(11.9003, 47.6002, 0.001, 200, 200), fine,
                                                  inUtm(32, 47.6, 11.9, 60, 200, 300)});
  ASSERT_TRUE(alone && joined);
  const auto one = test::readBands(*alone, 64), all = test::readBands(*joined, 64);
  const PostGrid &a = alone->posts(), &b = joined->posts();
  const auto column = static_cast<std::uint32_t>(std::lround((a.west - b.west) / b.stepLongitude)),
             row = static_cast<std::uint32_t>(std::lround((a.south - b.south) / b.stepLatitude));
  // Where it does not give way to what goes on beyond it.
  for (std::uint32_t r = 33; r < a.rows - 33; ++r)
    for (std::uint32_t c = 33; c < a.columns - 33; ++c)
      ASSERT_EQ(all[std::size_t{row + r} * b.columns + column + c], one[std::size_t{r} * a.columns + c]);
}

/// Largest second difference of what is not the terrain's own, along rows and columns.
double roughness(const PostGrid& posts, const std::vector<float>& heights) {
  std::vector<double> rest(heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i)
    rest[i] = static_cast<double>(heights[i]) -
              test::trueHeight(posts.latitude(static_cast<double>(i / posts.columns)),
                               posts.longitude(static_cast<double>(i % posts.columns)));
  double worst = 0;
  for (std::uint32_t r = 1; r + 1 < posts.rows; ++r)
    for (std::uint32_t c = 1; c + 1 < posts.columns; ++c) {
      const std::size_t i = std::size_t{r} * posts.columns + c, up = posts.columns;
      for (const double d :
           {rest[i - 1] - 2 * rest[i] + rest[i + 1], rest[i - up] - 2 * rest[i] + rest[i + up]})
        if (!std::isnan(d)) worst = std::max(worst, std::abs(d));
    }
  return worst;
}

TEST_F(Elevation, hasNoStepWhereFilesDisagree) {
  // Ten metres apart, as different datums or years would be.
  const auto lifted = [](TrueRaster raster) {
    raster.lift = 10;
    return raster;
  };
  auto holed = degrees(11.9, 47.6, 0.0005, 400, 400);
  holed.isVoid = [](double latitude, double longitude) {
    return std::hypot(latitude - 47.5, longitude - 12.0) < 0.02;
  };
  struct Seam {
    const char* name;
    std::vector<TrueRaster> rasters;
    /// Of the second difference, metres, of a step of ten: where two borders meet at a corner, distances from
    /// them meet in a kink.
    double limit;
  };
  const Seam seams[] = {
      {"wide overlap",
       {degrees(11.9, 47.6, 0.0005, 250, 400), lifted(degrees(11.98, 47.6, 0.0005, 240, 400))},
       0.1},
      {"a band of 20 posts",
       {degrees(11.9, 47.6, 0.0005, 210, 400), lifted(degrees(11.995, 47.6, 0.0005, 210, 400))},
       0.2},
      {"an island",
       {lifted(degrees(11.95, 47.55, 0.0005, 200, 200)), degrees(11.9, 47.6, 0.001, 200, 200)},
       0.5},
      {"an island in metres",
       {lifted(degrees(11.95, 47.55, 0.0005, 200, 200)), inUtm(32, 47.6, 11.9, 60, 250, 370)},
       0.5},
      {"a void", {holed, lifted(degrees(11.9, 47.6, 0.0005, 400, 400))}, 0.2},
  };
  for (const Seam& seam : seams) {
    const auto source = open(seam.rasters);
    ASSERT_TRUE(source);
    const auto heights = test::readBands(*source, 64);
    std::vector<TrueRaster> level = seam.rasters;
    for (TrueRaster& raster : level) raster.lift = 0;
    const auto flat = open(level);
    const double own = roughness(flat->posts(), test::readBands(*flat, 64)),
                 found = roughness(source->posts(), heights);
    EXPECT_LT(found, own + seam.limit) << seam.name;
    std::printf("%-22s second differences %.3f m, without disagreement %.3f m\n", seam.name, found, own);
  }
}

TEST_F(Elevation, closesTheGapBetweenTilesThatStandSideBySide) {
  // Pixels side by side: a post may lie between the last of one and the first of the other.
  const auto whole = inUtm(32, 47.59, 11.9, 40, 300, 300);
  auto left = whole, right = whole, low = whole, corner = whole;
  left.columns = 150, left.rows = 150;
  right.columns = 150, right.west += 150 * 40, right.rows = 150;
  low.columns = 150, low.rows = 150, low.north -= 150 * 40;
  corner = low, corner.west += 150 * 40;
  const auto joined = open({left, right, low, corner}), alone = open({whole});
  ASSERT_TRUE(joined);
  std::vector<std::uint8_t> beyond;
  const auto heights = test::readBands(*joined, 64, &beyond);
  const PostGrid& posts = joined->posts();
  std::size_t voids = 0;
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (std::isnan(heights[i]) && beyond[i] == 0) ++voids;
  EXPECT_EQ(voids, 0u);
  const auto [worst, count] = error(posts, heights);
  EXPECT_LT(worst, test::bilinearLimit(40));
  // As many as of one raster: a gap of a pixel in 300 both ways would be two thirds of a per cent.
  const PostGrid& one = alone->posts();
  const double area = posts.stepLatitude * posts.stepLongitude / (one.stepLatitude * one.stepLongitude);
  EXPECT_NEAR(
      static_cast<double>(count) * area / static_cast<double>(error(one, test::readBands(*alone, 64)).second),
      1, 0.002);
}

TEST_F(Elevation, doesNotDependOnBands) {
  auto holed = degrees(11.95, 47.58, 0.0005, 200, 250);
  holed.isVoid = [](double latitude, double longitude) {
    return std::sin(latitude * 900) * std::sin(longitude * 1100) > 0.6;
  };
  auto old = degrees(11.92, 47.55, 0.0007, 150, 150);
  old.crs = test::kEd50, old.toDegrees = test::ed50, old.lift = 4;
  const std::vector<TrueRaster> rasters = {holed, inUtm(32, 47.59, 11.93, 40, 220, 330), old,
                                           inUtm(33, 47.59, 12.02, 47, 150, 300), inLambert(50, 200, 300)};
  const auto reference = test::readBands(*open(rasters), 1u << 20);
  const auto same = [&](const std::vector<float>& heights) {
    return heights.size() == reference.size() &&
           std::memcmp(heights.data(), reference.data(), reference.size() * sizeof(float)) == 0;
  };
  for (const std::uint32_t band : {1u, 7u, 64u})
    EXPECT_TRUE(same(test::readBands(*open(rasters), band))) << band;
  // In no order at all.
  const auto source = open(rasters);
  const PostGrid& posts = source->posts();
  std::vector<float> heights(posts.columns);
  std::mt19937 random(7);
  for (int k = 0; k < 60; ++k) {
    const auto row = static_cast<std::uint32_t>(random() % posts.rows);
    ASSERT_TRUE(source->readRows(row, 1, heights));
    ASSERT_EQ(std::memcmp(heights.data(), reference.data() + std::size_t{row} * posts.columns,
                          posts.columns * sizeof(float)),
              0);
  }
  // Every post is somebody's, once, however often it is read.
  for (const std::uint32_t band : {64u, 7u}) test::readBands(*source, band);
  std::uint64_t given = 0;
  for (const std::uint64_t posts_ : source->given()) given += posts_;
  EXPECT_EQ(given, static_cast<std::uint64_t>(std::count_if(reference.begin(), reference.end(),
                                                            [](float h) { return !std::isnan(h); })));
}

}  // namespace
}  // namespace trimtab::terrain
