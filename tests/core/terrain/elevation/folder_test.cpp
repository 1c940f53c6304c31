#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "rasters.h"
#include "read_elevation.h"
#include "trimtab/terrain/elevation/files.h"
#include "trimtab/terrain/elevation/source.h"

namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Hills of 900 to 1,900 m over 80 x 80 posts.
double hill(int c, int r) {
  return 1400 + 380 * std::sin(c * 0.09) * std::cos(r * 0.07) + 90 * std::sin(c * 0.31 + r * 0.23);
}

/// As the command line prints findings.
std::string told(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings)
    text += std::string(finding.severity == Severity::note      ? "note: "
                        : finding.severity == Severity::warning ? "warning: "
                                                                : "error: ") +
            toString(finding) + '\n';
  return text;
}

/// What programs derive from heights.
double slopeOf(int c, int r) {
  return std::atan(std::hypot(hill(c + 1, r) - hill(c - 1, r), hill(c, r + 1) - hill(c, r - 1)) / 150) * 180 /
         std::numbers::pi;
}
double aspectOf(int c, int r) {
  const double angle = std::atan2(hill(c + 1, r) - hill(c - 1, r), hill(c, r + 1) - hill(c, r - 1));
  return std::fmod(angle * 180 / std::numbers::pi + 360, 360);
}

class ElevationFolder : public ::testing::Test {
 protected:
  test::RasterRecipe recipe(const std::function<double(int, int)>& value, GDALDataType type = GDT_Float32) {
    test::RasterRecipe made;
    made.columns = made.rows = 80;
    made.type = type;
    made.value = [value](int c, int r, int) { return value(c, r); };
    return made;
  }
  void write(const std::string& name, const test::RasterRecipe& made) {
    test::writeRaster(dir_ / "in" / name, made);
  }
  void heights(const std::string& name, GDALDataType type = GDT_Float32) {
    write(name, recipe([](int c, int r) { return std::round(hill(c, r)); }, type));
  }
  Result<test::Imported> import() {
    const fs::path folder = dir_ / "in";
    return test::importElevation(std::span(&folder, 1));
  }
  /// Expects the hills, and nothing else.
  std::string importHills() {
    const auto imported = import();
    EXPECT_TRUE(imported) << told(imported.findings());
    if (!imported) return {};
    const auto& grid = imported->grid;
    double worst = 0;
    for (std::uint32_t r = 0; r < grid.posts.rows; ++r)
      for (std::uint32_t c = 0; c < grid.posts.columns; ++c)
        worst = std::max(worst, std::abs(static_cast<double>(grid.heights[r * grid.posts.columns + c]) -
                                         std::round(hill(static_cast<int>(c), static_cast<int>(79 - r)))));
    EXPECT_EQ(worst, 0);
    return told(imported.findings());
  }
  void SetUp() override { fs::create_directory(dir_ / "in"); }
  test::ScratchDir dir_;
};

TEST_F(ElevationFolder, namesEveryBrokenFileAndReadsTheRest) {
  heights("m.tif");
  test::writeFile(dir_ / "in/a.hgt", "");
  test::writeFile(dir_ / "in/b.tif", "\n <!doctype HTML><html><body>Sign in");
  test::writeFile(dir_ / "in/c.tif", R"({"error": "no such scene"})");
  test::writeFile(dir_ / "in/N10E011.hgt", std::string(70001, '\x01'));
  test::writeFile(dir_ / "in/N10E012.hgt", std::string(2 * 400 * 400, '\x01'));
  heights("z.tif");
  fs::resize_file(dir_ / "in/z.tif", 9000);
  test::writeFile(dir_ / "in/old.ecw", std::string("\x65\x02\0\0\1", 5));
  test::writeFile(dir_ / "in/+47+010.dsf", "XPLNEDSF\1");
  test::writeFile(dir_ / "in/photo.sid", "msid\1\2\3");
  test::writeFile(dir_ / "in/notes.txt", "made in May");
  test::writeFile(dir_ / "in/rest.zip", "PK\x03\x04....");
  fs::create_symlink("gone.tif", dir_ / "in/link.tif");
  const std::string text = importHills();
  const std::string in = (dir_ / "in").string();
  for (const char* says :
       {"/a.hgt: expected elevation, found an empty file; left out",
        "/b.tif: expected elevation, found a web page, HTML text, not recognized as a raster",
        "/c.tif: expected elevation, found JSON text, not recognized as a raster",
        "/N10E011.hgt: expected elevation, found an .hgt of 70001 bytes, which is no square of posts",
        "/N10E012.hgt: expected elevation, found an .hgt of 320000 bytes, 400 x 400 posts, which GDAL does "
        "not",
        "/old.ecw: expected elevation, found an ECW image, for which this GDAL has no driver",
        "/+47+010.dsf: expected elevation, found X-Plane scenery (DSF)",
        "/photo.sid: expected elevation, found a MrSID image",
        "/link.tif: expected a file or folder, found a link to nothing"})
    EXPECT_THAT(text, HasSubstr("warning: " + in + says));
  EXPECT_THAT(text, HasSubstr("warning: " + in + "/z.tif: row "));
  EXPECT_THAT(text, HasSubstr("note: " + in +
                              ": expected elevation, found 2 files that are no rasters, left out: "
                              "notes.txt (text); rest.zip (a packed file, to be unpacked first)"));
}

TEST_F(ElevationFolder, ofBrokenFilesAloneIsRefused) {
  test::writeFile(dir_ / "in/a.tif", "");
  heights("z.tif");
  fs::resize_file(dir_ / "in/z.tif", 9000);
  const auto imported = import();
  ASSERT_FALSE(imported);
  EXPECT_TRUE(hasError(imported.findings()));
  EXPECT_THAT(told(imported.findings()),
              AllOf(HasSubstr("a.tif"), HasSubstr("z.tif"), HasSubstr("none of 1 rasters")));
}

TEST_F(ElevationFolder, isFollowedThroughLinksOnce) {
  fs::create_directory(dir_ / "far");
  test::writeRaster(dir_ / "far/m.tif", recipe([](int c, int r) { return std::round(hill(c, r)); }));
  fs::create_directory_symlink(dir_ / "far", dir_ / "in/tiles");
  fs::create_directory_symlink(dir_ / "in", dir_ / "far/back");
  importHills();
  const fs::path folder = dir_ / "in";
  const auto files = elevationFiles(std::span(&folder, 1));
  ASSERT_TRUE(files);
  EXPECT_EQ(*files, (std::vector<fs::path>{dir_ / "in/tiles/m.tif"}));
}

TEST_F(ElevationFolder, leavesOutWhatWasDerivedFromHeightsWhateverItsName) {
  for (const bool named : {true, false}) {
    for (const auto& entry : fs::directory_iterator(dir_ / "in")) fs::remove(entry.path());
    heights(named ? "dem.tif" : "t1.tif", GDT_Int16);
    write(named ? "slope.tif" : "t2.tif", recipe(slopeOf));
    write(named ? "aspect.tif" : "t3.tif", recipe(aspectOf));
    write(named ? "hillshade.tif" : "t4.tif",
          recipe([](int c, int r) { return 200 - 2 * slopeOf(c, r); }, GDT_Byte));
    write(named ? "ndvi.tif" : "t5.tif",
          recipe([](int c, int r) { return std::sin(c * 0.8) * std::cos(r); }));
    const std::string text = importHills();
    for (const char* name :
         named ? std::array{"slope", "aspect", "hillshade", "ndvi"} : std::array{"t2", "t3", "t4", "t5"})
      EXPECT_THAT(text,
                  HasSubstr("note: " + (dir_ / "in" / name).string() + ".tif: expected elevation, found"));
    EXPECT_THAT(text, AllOf(HasSubstr("its numbers are bytes"), HasSubstr("as aspects do")));
    EXPECT_THAT(text, Not(HasSubstr("share")));
  }
}

TEST_F(ElevationFolder, leavesOutWhatContradictsHeightsThatNameTheirUnit) {
  test::RasterRecipe named = recipe([](int c, int r) { return std::round(hill(c, r)); });
  named.unit = "m";
  write("z.tif", named);
  // Smoother than slopes are, and beyond their range.
  write("a.tif", recipe([](int c, int r) { return 150 + 145 * std::sin(c * 0.3) * std::cos(r * 0.2); }));
  EXPECT_THAT(importHills(), HasSubstr("a.tif: expected elevation, found something else: it contradicts"));
}

TEST_F(ElevationFolder, leavesOutImagesOfAnyDepth) {
  heights("m.tif", GDT_Int16);
  test::RasterRecipe bands = recipe([](int c, int r) { return 900 + c * 7 + r % 13 * 40; }, GDT_UInt16);
  bands.bands = 4;
  write("a.tif", bands);
  bands.bands = 3;
  GDALDataset* data =
      GDALDataset::Open(test::writeRaster(dir_ / "in/rgb16.tif", bands).c_str(), GDAL_OF_UPDATE);
  data->GetRasterBand(1)->SetColorInterpretation(GCI_RedBand);
  GDALClose(data);
  write("T32_B08.tif", recipe([](int c, int r) { return 300 + (c * 7919 + r * 104729) % 2600; }, GDT_UInt16));
  const std::string text = importHills();
  EXPECT_THAT(text,
              HasSubstr("a.tif: expected elevation, found something else: 4 bands, where elevation has one"));
  EXPECT_THAT(text, HasSubstr("rgb16.tif: expected elevation, found an image of 3 bands of UInt16 in red"));
  EXPECT_THAT(text, HasSubstr("its name says \"b08\""));
}

TEST_F(ElevationFolder, keepsLevelTilesOfASetOfHeights) {
  test::RasterRecipe sea = recipe([](int c, int r) { return 0.4 * std::sin(c * 1.7) * std::cos(r * 2.1); });
  heights("w.tif");
  sea.west += 80 * sea.step;
  write("x.tif", sea);
  const auto imported = import();
  ASSERT_TRUE(imported) << told(imported.findings());
  EXPECT_EQ(imported->grid.posts.columns, 160u);
  EXPECT_THAT(told(imported.findings()), HasSubstr("taken with its neighbours"));
}

TEST_F(ElevationFolder, warnsOfSourcesThatContradictEachOther) {
  const auto file = [&](const char* name, double factor, double step) {
    test::RasterRecipe made = recipe([=](int c, int r) { return factor * hill(c, r); });
    made.step = step;
    made.unit = "m";
    return test::writeRaster(dir_ / name, made);
  };
  const std::vector<fs::path> feet{file("a.tif", 1, 0.001), file("b.tif", 3.28084, 0.00099)};
  const auto both = test::importElevation(feet);
  ASSERT_TRUE(both);
  EXPECT_THAT(told(both.findings()),
              AllOf(HasSubstr("warning: "), HasSubstr("a.tif"), HasSubstr("b.tif at the same place"),
                    HasSubstr("one of the two may be something else")));
  const std::vector<fs::path> alike{feet[0], file("c.tif", 1.01, 0.001)};
  const auto good = test::importElevation(alike);
  ASSERT_TRUE(good);
  EXPECT_THAT(told(good.findings()), Not(HasSubstr("warning")));
}

TEST_F(ElevationFolder, takesWhatIsNamedWithAWarning) {
  const std::vector<fs::path> one{test::writeRaster(dir_ / "slope.tif", recipe(slopeOf))};
  const auto imported = test::importElevation(one);
  ASSERT_TRUE(imported);
  EXPECT_THAT(told(imported.findings()), HasSubstr("taken because it was named"));
}

}  // namespace
}  // namespace trimtab::terrain
