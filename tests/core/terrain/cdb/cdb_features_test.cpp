#include <algorithm>
#include <cmath>

#include "made_cdb.h"
#include "tests/core/terrain/objects/model_support.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/cdb/features.h"
#include "trimtab/terrain/cdb/models.h"

/// Features, their classes and their models, on a CDB that is made here. tests/app/models reads real ones.
namespace trimtab::terrain {
namespace {

using test::MadeCdb;
namespace fs = std::filesystem;
using test::MadeRow;

class CdbFeaturesTest : public ::testing::Test {
 protected:
  static CdbTile tile(int set, int first, int second, int level, int up = 0, int right = 0) {
    return {-34, 18, set, first, second, level, up, right};
  }
  const std::vector<std::string> instance_{"CNAM", "AO1", "SCALx", "SCALy", "SCALz", "AHGT", "MODL"},
      class_{"CNAM", "FACC", "FSC", "MODL", "MLOD", "AHGT"};

  static MadeRow row(double longitude, double latitude, std::map<std::string, std::string> values,
                     double height = 0) {
    return {std::array{longitude, latitude, height}, std::move(values)};
  }
  fs::path typicalModel(const std::string& name) const {
    const fs::path folder =
        cdb_.root / "GTModel" / "500_GTModelGeometry" / "E_Vegetation" / "C_Woodland" / "030_Trees";
    fs::create_directories(folder);
    test::writeFile(folder / ("D500_S001_T001_EC030_004_" + name + ".flt"), name);
    return folder;
  }
  /// Trees of one class at places of the cell, in a table of a level.
  void trees(int level, const std::vector<MadeRow>& rows, int up = 0, int right = 0) const {
    cdb_.table(tile(101, 2, 1, level, up, right), instance_, rows, true);
    cdb_.table(tile(101, 2, 2, level, up, right), class_,
               {{{}, {{"CNAM", "tree"}, {"FACC", "EC030"}, {"FSC", "4"}, {"MODL", "oak"}}},
                {{}, {{"CNAM", "high"}, {"FACC", "EC030"}, {"FSC", "4"}, {"MODL", "oak"}, {"AHGT", "T"}}},
                {{}, {{"CNAM", "odd"}, {"FACC", "EC030"}, {"FSC", "1e300"}, {"MODL", "oak"}}},
                {{}, {{"CNAM", "none"}, {"FACC", "EC030"}, {"FSC", "4"}, {"MODL", "ash"}}}},
               false);
  }
  CdbFeatures read() {
    const auto cdb = openCdb(dir_.path());
    EXPECT_TRUE(cdb) << toString(cdb.findings());
    Findings findings;
    CdbFeatures features = readCdbFeatures(*cdb, findings);
    said_ = toString(findings);
    about_ = toString(aboutCdb(*cdb, features));
    return features;
  }

  test::ScratchDir dir_;
  MadeCdb cdb_{dir_ / "Root"};
  std::string said_, about_;
};

TEST_F(CdbFeaturesTest, standWhereTheirRowsSay) {
  typicalModel("oak");
  trees(0, {row(18.25, -33.5, {{"CNAM", "tree"}, {"AO1", "123.5"}}, 2.5),
            row(18.75, -33.25, {{"CNAM", "tree"}, {"SCALx", "2"}, {"SCALy", "2"}, {"SCALz", "2"}}),
            row(18.5, -33.75, {{"CNAM", "high"}}, 77)});
  const CdbFeatures features = read();
  EXPECT_EQ(said_, "");
  ASSERT_EQ(features.list.placements.size(), 3u);
  ASSERT_EQ(features.models.size(), 1u);
  EXPECT_TRUE(features.models[0].file.ends_with("D500_S001_T001_EC030_004_oak.flt"));
  const auto& p = features.list.placements;
  EXPECT_EQ(p[0].longitude.value(), 18.25);
  EXPECT_EQ(p[0].latitude.value(), -33.5);
  EXPECT_EQ(p[0].heading.value(), 123.5);
  EXPECT_FALSE(p[0].height);
  EXPECT_EQ(p[0].aboveGround.value(), 2.5);
  EXPECT_EQ(p[0].scale, 1);
  EXPECT_EQ(p[1].scale, 2);
  ASSERT_TRUE(p[2].height);
  EXPECT_EQ(p[2].height->value(), 77);
  EXPECT_NE(features.list.placeOf(2, "").find("L00_U0_R0.shp:3"), std::string::npos)
      << features.list.placeOf(2, "");
  EXPECT_EQ(features.typical, 3u);
}

TEST_F(CdbFeaturesTest, anInstanceSaysMoreThanItsClass) {
  typicalModel("oak");
  typicalModel("elm");
  trees(0, {row(18.25, -33.5, {{"CNAM", "tree"}, {"MODL", "elm"}}),
            row(18.25, -33.4, {{"CNAM", "high"}, {"AHGT", "F"}}, 9)});
  const CdbFeatures features = read();
  ASSERT_EQ(features.models.size(), 2u) << said_;
  EXPECT_TRUE(features.models[0].file.ends_with("elm.flt"));
  EXPECT_FALSE(features.list.placements[1].height);
}

TEST_F(CdbFeaturesTest, aFinerTableTakesThePlaceOfACoarserWhereItHasRows) {
  typicalModel("oak");
  trees(-1, {row(18.1, -33.9, {{"CNAM", "tree"}}), row(18.7, -33.9, {{"CNAM", "tree"}})});
  trees(0, {});
  trees(1,
        {row(18.6, -33.8, {{"CNAM", "tree"}}), row(18.7, -33.9, {{"CNAM", "tree"}}),
         row(18.8, -33.7, {{"CNAM", "tree"}})},
        0, 1);
  const CdbFeatures features = read();
  EXPECT_EQ(features.list.placements.size(), 4u);
  EXPECT_EQ(features.replaced, 1u);
}

TEST_F(CdbFeaturesTest, unequalScalesStretchTheModel) {
  typicalModel("oak");
  const std::map<std::string, std::string> high{
      {"CNAM", "tree"}, {"SCALx", "1"}, {"SCALy", "2"}, {"SCALz", "4"}};
  trees(0, {row(18.25, -33.5, high), row(18.3, -33.5, {{"CNAM", "tree"}}), row(18.35, -33.5, high)});
  const CdbFeatures features = read();
  ASSERT_EQ(features.models.size(), 2u);
  EXPECT_EQ(features.models[0].stretch, (std::array{0.25, 0.5, 1.0}));
  EXPECT_EQ(features.models[1].stretch, (std::array{1.0, 1.0, 1.0}));
  EXPECT_EQ(features.list.placements[0].scale, 4);
  EXPECT_EQ(features.list.placements[2].model, 0u);
  EXPECT_NE(features.list.models[0], features.list.models[1]);
}

TEST_F(CdbFeaturesTest, rowsThatCannotBeUsedAreNamed) {
  typicalModel("oak");
  struct Bad {
    MadeRow row;
    const char* said;
  };
  const Bad bad[] = {{row(18.1, -33.5, {{"CNAM", "tree"}, {"AO1", "4000"}}), "AO1"},
                     {row(18.1, -33.5, {{"CNAM", "tree"}, {"AO1", "north"}}), "AO1"},
                     {row(18.1, -33.5, {{"CNAM", "tree"}, {"SCALx", "1e9"}}), "SCALX"},
                     {row(18.1, -33.5, {{"CNAM", "tree"}, {"SCALy", "0"}}), "SCALY"},
                     {row(18.1, -33.5, {{"CNAM", "tree"}, {"SCALz", "-1"}}), "SCALZ"},
                     {row(18.1, -33.5, {{"CNAM", "tree"}}, 1e6), "height"},
                     {row(5e5, -33.5, {{"CNAM", "tree"}}), "place"},
                     {{{}, {{"CNAM", "tree"}}}, "place"}};
  std::vector<MadeRow> rows{row(18.5, -33.5, {{"CNAM", "tree"}})};
  for (const Bad& b : bad) rows.push_back(b.row);
  trees(0, rows);
  const CdbFeatures features = read();
  EXPECT_EQ(features.list.placements.size(), 1u);
  for (std::size_t i = 0; i < std::size(bad); ++i)
    EXPECT_NE(said_.find("shp:" + std::to_string(i + 2) + ": " + bad[i].said), std::string::npos)
        << bad[i].said << "\n"
        << said_;
}

TEST_F(CdbFeaturesTest, whatHasNoModelIsCountedAndNamed) {
  typicalModel("oak");
  trees(0, {row(18.5, -33.5, {{"CNAM", "tree"}}), row(18.6, -33.5, {{"CNAM", "none"}}),
            row(18.7, -33.5, {{"CNAM", "none"}}), row(18.8, -33.5, {{"CNAM", "unheard"}}),
            row(18.9, -33.5, {{"CNAM", "odd"}})});
  const CdbFeatures features = read();
  EXPECT_EQ(features.list.placements.size(), 1u);
  EXPECT_EQ(features.withoutModel,
            (std::map<std::string, std::size_t>{{"EC030_004_ash", 2},
                                                {"no FACC, FSC and MODL for odd", 1},
                                                {"no FACC, FSC and MODL for unheard", 1}}));
  EXPECT_NE(about_.find("none for 4 features"), std::string::npos) << about_;
  EXPECT_NE(about_.find("EC030_004_ash"), std::string::npos) << about_;
}

TEST_F(CdbFeaturesTest, modelsOfOnePlaceAreInTheArchiveOfTheirLevel) {
  const auto house = [&](const char* name, const char* mlod) {
    return MadeRow{{}, {{"CNAM", name}, {"FACC", "AL015"}, {"FSC", "7"}, {"MODL", name}, {"MLOD", mlod}}};
  };
  cdb_.table(tile(100, 1, 1, 0), instance_,
             {row(18.7, -33.9, {{"CNAM", "hut"}}), row(18.7, -33.9, {{"CNAM", "inn"}}),
              row(18.2, -33.9, {{"CNAM", "hut"}}), row(18.7, -33.9, {{"CNAM", "mill"}})},
             true);
  cdb_.table(tile(100, 1, 2, 0), class_, {house("hut", "1"), house("inn", "-2"), house("mill", "60")}, false);
  const CdbTile fine = tile(300, 1, 1, 1, 0, 1), coarse = tile(300, 1, 1, -2);
  MadeCdb::zip(cdb_.fileOf(fine, ".zip"), {{MadeCdb::nameOf(fine) + "_AL015_007_hut.flt", "hut"}});
  MadeCdb::zip(cdb_.fileOf(coarse, ".zip"), {{MadeCdb::nameOf(coarse) + "_AL015_007_inn.flt", "inn"}});
  CdbFeatures features = read();
  EXPECT_EQ(said_, "");
  ASSERT_EQ(features.models.size(), 2u);
  EXPECT_EQ(bytesOfFile(features.models[0].file).value(), "hut");
  EXPECT_EQ(bytesOfFile(features.models[1].file).value(), "inn");
  // Another quarter of the cell has no archive, and there is no level 60.
  EXPECT_EQ(features.withoutModel,
            (std::map<std::string, std::size_t>{{"AL015_007_hut", 1}, {"AL015_007_mill", 1}}));
  // An archive that is cut short.
  const std::string bytes = test::readFile(cdb_.fileOf(fine, ".zip"));
  test::writeFile(cdb_.fileOf(fine, ".zip"), bytes.substr(0, bytes.size() / 2));
  features = read();
  EXPECT_EQ(features.models.size(), 1u);
  EXPECT_NE(said_.find(MadeCdb::nameOf(fine) + ".zip"), std::string::npos) << said_;
}

TEST_F(CdbFeaturesTest, lightsLinesAndAreasAreCounted) {
  for (const auto& [level, count] : {std::pair{-2, 1}, {-1, 3}}) {
    std::vector<MadeRow> rows;
    for (int i = 0; i < count; ++i) rows.push_back(row(18.1 + 0.1 * i, -33.5, {}));
    cdb_.table(tile(100, 4, 1, level), instance_, rows, true);
    cdb_.table(tile(201, 2, 3, level), instance_, rows, true);
    cdb_.table(tile(204, 1, 5, level), instance_, rows, true);
  }
  const CdbFeatures features = read();
  EXPECT_TRUE(features.list.placements.empty());
  EXPECT_EQ(features.lights, 3u);
  EXPECT_NE(about_.find("3 lights"), std::string::npos) << about_;
  EXPECT_NE(about_.find("3 lines and 0 areas of data set 201"), std::string::npos) << about_;
  EXPECT_NE(about_.find("0 lines and 3 areas of data set 204"), std::string::npos) << about_;
}

TEST_F(CdbFeaturesTest, damagedTablesAreNamedAndOthersRead) {
  typicalModel("oak");
  trees(0, {row(18.5, -33.5, {{"CNAM", "tree"}})});
  cdb_.table(tile(101, 1, 1, 0), instance_, {row(18.5, -33.5, {{"CNAM", "tree"}})}, true);
  test::writeFile(cdb_.fileOf(tile(101, 1, 1, 0), ".shp"), "not a shape");
  cdb_.table(tile(100, 2, 1, 0), instance_, {row(18.5, -33.5, {{"CNAM", "tree"}})}, true);
  fs::remove(cdb_.fileOf(tile(100, 2, 1, 0), ".shp"));
  const CdbFeatures features = read();
  EXPECT_EQ(features.list.placements.size(), 1u);
  for (const char* name : {"S34E018_D101_S001_T001_L00_U0_R0.shp", "S34E018_D100_S002_T001_L00_U0_R0.dbf"})
    EXPECT_NE(said_.find(name), std::string::npos) << name << "\n" << said_;
}

TEST_F(CdbFeaturesTest, aMissingTextureHasTheNearestLevelThereIs) {
  const fs::path models = typicalModel("oak"),
                 folder = cdb_.root / "GTModel" / "501_GTModelTexture" / "B" / "A" / "bark";
  fs::create_directories(folder);
  for (const char* level : {"W02", "W06", "W10"})
    test::writeFile(folder / ("D501_S001_T001_" + std::string(level) + "_bark.rgb"), level);
  test::writeFile(folder / "D501_S001_T001_W07_barkless.rgb", "another");
  const auto found = [&](const std::string& level) {
    return cdbTexture("../../../../501_GTModelTexture/B/A/bark/D501_S001_T001_" + level + "_bark.rgb",
                      (models / "oak.flt").string());
  };
  EXPECT_EQ(test::readFile(found("W11").value()), "W10");
  EXPECT_EQ(test::readFile(found("W05").value()), "W06");
  EXPECT_EQ(test::readFile(found("W08").value()), "W10") << "the finer of two";
  EXPECT_EQ(test::readFile(found("W00").value()), "W02");
  // A texture that this version lacks is read from an older one.
  const fs::path old = dir_ / "old" / "GTModel" / "501_GTModelTexture" / "M" / "O" / "moss";
  fs::create_directories(old);
  fs::create_directories(cdb_.root / "Metadata");
  test::writeFile(old / "D501_S001_T001_W01_moss.rgb", "moss");
  test::writeFile(cdb_.root / "Metadata" / "Version.xml",
                  "<Version><PreviousIncrementalRootDirectory name=\"../old\"/></Version>");
  EXPECT_EQ(test::readFile(cdbTexture("../../../../501_GTModelTexture/M/O/moss/D501_S001_T001_W05_moss.rgb",
                                      (models / "oak.flt").string())
                               .value_or("")),
            "moss");
  EXPECT_FALSE(cdbTexture("D:/textures/bark.rgb", (models / "oak.flt").string()));
  EXPECT_FALSE(cdbTexture("../D501_S001_T001_W01_bark.rgb", (models / "oak.flt").string()));
  // In an archive of the cell, under another tile's name.
  const CdbTile model = tile(300, 1, 1, 0), texture = tile(301, 1, 1, 2, 3, 1);
  MadeCdb::zip(cdb_.fileOf(model, ".zip"), {{"house.flt", "house"}});
  MadeCdb::zip(cdb_.fileOf(texture, ".zip"), {{MadeCdb::nameOf(texture) + "_W03_wall.rgb", "wall 3"},
                                              {MadeCdb::nameOf(texture) + "_roof.rgb", "roof"}});
  const auto inArchive = [&](const std::string& name) {
    return cdbTexture("../../../301_GSModelTexture/L06/U47/S34E018_D301_S001_T001_L06_U47_R50_" + name,
                      "/vsizip/" + cdb_.fileOf(model, ".zip").string() + "/house.flt");
  };
  EXPECT_EQ(bytesOfFile(inArchive("roof.rgb").value()).value(), "roof");
  EXPECT_EQ(bytesOfFile(inArchive("W09_wall.rgb").value()).value(), "wall 3");
  EXPECT_FALSE(inArchive("floor.rgb"));
}

TEST_F(CdbFeaturesTest, allOfThemOffTheGroundLeaveTheGround) {
  typicalModel("oak");
  cdb_.heights({-34, 18, 1, 1, 1, -5, 0, 0}, [](int, int) { return 5.0; });
  trees(0, {row(30, -33.5, {{"CNAM", "tree"}})});
  BakeOptions options;
  options.sources = {dir_ / "Root"};
  options.output = dir_ / "db";
  options.readModel = [](const fs::path& file) -> Result<SourceModel> {
    return test::modelOf(file.string(), {test::ball(8, 4, 0)});
  };
  const auto baked = bake(options);
  ASSERT_TRUE(baked) << toString(baked.findings());
  EXPECT_EQ((*baked)->objects(), nullptr);
  EXPECT_NE(toString(baked.findings()).find("L00_U0_R0.shp:1"), std::string::npos);
}

/// Bakes the made CDB; its models are balls.
TEST_F(CdbFeaturesTest, areBakedOntoTheirGround) {
  typicalModel("oak");
  cdb_.heights({-34, 18, 1, 1, 1, -3, 0, 0}, [](int c, int r) { return 0.5 * c + 0.25 * r; });
  trees(0, {row(18.25, -33.5, {{"CNAM", "tree"}}, 3), row(18.5, -33.25, {{"CNAM", "high"}}, 500),
            row(18.6, -33.5, {{"CNAM", "tree"}, {"SCALx", "1"}, {"SCALy", "1"}, {"SCALz", "3"}}),
            row(30, -33.5, {{"CNAM", "tree"}})});
  BakeOptions options;
  options.sources = {dir_ / "Root"};
  options.output = dir_ / "db";
  options.maxError = Metres{0};
  options.readModel = [](const fs::path& file) -> Result<SourceModel> {
    return test::modelOf(file.string(), {test::ball(8, 4, 0)});
  };
  const auto baked = bake(options);
  ASSERT_TRUE(baked) << toString(baked.findings());
  EXPECT_NE(toString(baked.findings()).find("D101_S002_T001_L00_U0_R0.shp:4"), std::string::npos)
      << toString(baked.findings());
  ASSERT_NE((*baked)->objects(), nullptr);
  const ObjectIndex& index = (*baked)->objects()->index;
  ASSERT_EQ(index.instances.size(), 3u);
  std::vector<double> above;
  std::vector<float> radius;
  for (std::uint32_t c = 0; c < index.cells.size(); ++c)
    for (std::uint32_t i = 0; index.cells[c].isLeaf(c) && i < index.cells[c].instances; ++i) {
      const ObjectInstance& o = index.instances[index.cells[c].firstInstance + i];
      const auto& from = index.cells[c].origin;
      const GeodeticPosition p = index.frame.toGeodetic(
          {from[0] * 16.0 + double{o.x}, from[1] * 16.0 + double{o.y}, from[2] * 16.0 + double{o.z}});
      above.push_back(p.height.value() - (*baked)->heightAt(p.latitude, p.longitude)->value());
      radius.push_back(o.scale * index.models[o.model].radiusM);
    }
  std::sort(above.begin(), above.end());
  std::sort(radius.begin(), radius.end());
  EXPECT_NEAR(above[0], 0, 0.1);
  EXPECT_NEAR(above[1], 3, 0.1);
  EXPECT_GT(above[2], 400);
  // A ball of 8 m on its south pole: three times as high, it reaches 24 m up.
  EXPECT_NEAR(radius[0], 8, 0.1f);
  EXPECT_NEAR(radius[2], 24, 0.1f);
  EXPECT_NE(toString(aboutSources(options)).find("4 by 2 models"), std::string::npos)
      << toString(aboutSources(options));
}

}  // namespace
}  // namespace trimtab::terrain
