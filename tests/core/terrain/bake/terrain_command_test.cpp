#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/child.h"
#include "tests/core/terrain/scenery/scenery_tiles.h"

namespace trimtab {
namespace {

std::string cli(const std::string& arguments) {
  return test::program("trimtab-cli").string() + " terrain " + arguments;
}

class TerrainCommand : public ::testing::Test {
 protected:
  std::string at(const char* name) const { return (dir_ / name).string(); }
  test::ScratchDir dir_;
};

TEST_F(TerrainCommand, makesBakesAndDescribesASample) {
  const auto sample = test::run(cli("sample -o " + at("s.tif") + " --seed 3 --size-km 20 --post-m 100"));
  ASSERT_EQ(sample.exitCode, 0) << sample.err;
  EXPECT_NE(sample.err.find('%'), std::string::npos);
  const auto baked = test::run(cli("bake " + at("s.tif") + " -o " + at("db")));
  ASSERT_EQ(baked.exitCode, 0) << baked.err;
  const auto info = test::run(cli("info " + at("db") + " --json"));
  ASSERT_EQ(info.exitCode, 0) << info.err;
  const auto json = nlohmann::json::parse(info.out);
  EXPECT_EQ(json["columns"], 201);
  EXPECT_EQ(json["voids_filled"], 0);
  EXPECT_EQ(json["source"], at("s.tif"));
  EXPECT_EQ(json["levels"].back()["columns"], 1);
  EXPECT_NE(test::run(cli("info " + at("db"))).out.find("level 0"), std::string::npos);
}

TEST_F(TerrainCommand, bakesObjectsOfFilesBesideTheirList) {
  ASSERT_EQ(test::run(cli("sample -o " + at("s.tif") + " --size-km 10 --post-m 100")).exitCode, 0);
  const auto plain = test::run(cli("bake " + at("s.tif") + " -o " + at("db")));
  ASSERT_EQ(plain.exitCode, 0) << plain.err;
  const auto before = nlohmann::json::parse(test::run(cli("info " + at("db") + " --json")).out);
  EXPECT_FALSE(before.contains("objects"));
  const double latitude = (before["south_deg"].get<double>() + before["north_deg"].get<double>()) / 2,
               longitude = (before["west_deg"].get<double>() + before["east_deg"].get<double>()) / 2;
  std::filesystem::create_directories(dir_ / "models");
  test::writeFile(dir_ / "models/hut.obj",
                  "v -3 0 -3\nv 3 0 -3\nv 3 0 3\nv -3 0 3\nv 0 5 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
  std::string list = "model,latitude_deg,longitude_deg,heading_deg,scale\n";
  for (int i = 0; i < 200; ++i)
    list += "models/hut.obj," + std::to_string(latitude + 0.0001 * i) + "," + std::to_string(longitude) +
            ",45,1\n";
  test::writeFile(dir_ / "list.csv", list + "models/gone.ac,1,1,0,1\n" + "models/hut.obj,x,1,0,1\n");
  const auto baked =
      test::run(cli("bake " + at("s.tif") + " -o " + at("db") + " --objects " + at("list.csv")));
  ASSERT_EQ(baked.exitCode, 0) << baked.err;
  EXPECT_NE(baked.err.find("models/gone.ac: expected a model that can be used, found 1 row"),
            std::string::npos)
      << baked.err;
  EXPECT_NE(baked.err.find("list.csv:203: latitude_deg"), std::string::npos) << baked.err;
  EXPECT_NE(baked.out.find("model models/hut.obj: 200 placed; 4 triangles to 0 m"), std::string::npos)
      << baked.out;
  const auto json = nlohmann::json::parse(test::run(cli("info " + at("db") + " --json")).out);
  EXPECT_EQ(json["objects"]["instances"], 200);
  EXPECT_EQ(json["objects"]["finest_triangles"], 800);
  EXPECT_EQ(json["objects"]["models"].size(), 1u);
  EXPECT_EQ(json["objects"]["models"][0]["error_m"][0], 0);
  EXPECT_EQ(test::run(cli("info " + at("db") + " --check")).exitCode, 0);
  const auto refused =
      test::run(cli("bake " + at("s.tif") + " -o " + at("db2") + " --objects " + at("none.csv")));
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_NE(refused.err.find("none.csv"), std::string::npos) << refused.err;
}

TEST_F(TerrainCommand, countryEndsBeforeThePoleAndMeetsItselfNowhere) {
  const std::string to = "country -o " + at("c.tif") + " --post-m 2000";
  for (const auto& [size, said] : {std::pair{" --rows 6000 --columns 33", "rows: expected at most 5924"},
                                   {" --rows 33 --columns 20000", "columns: expected at most 16080"}}) {
    const auto refused = test::run(cli(to + size));
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_NE(refused.err.find(said), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(at("c.tif")));
  }
  const auto made = test::run(cli(to + " --rows 5924 --columns 33"));
  ASSERT_EQ(made.exitCode, 0) << made.err;
  const auto baked = test::run(cli("bake " + at("c.tif") + " -o " + at("db") + " --max-error-m 500"));
  EXPECT_EQ(baked.exitCode, 0) << baked.err;
}

TEST_F(TerrainCommand, bakesACountryInPartsAndChecksIt) {
  const auto made = test::run(cli("country -o " + at("c.tif") + " --columns 300 --rows 200"));
  ASSERT_EQ(made.exitCode, 0) << made.err;
  const std::string bake = "bake " + at("c.tif") + " -o " + at("db") + " --max-error-m 20 --memory-mb 128";
  ASSERT_EQ(test::run(cli(bake + " --part 2/2")).exitCode, 0);
  const auto early = test::run(cli(bake + " --join"));
  EXPECT_EQ(early.exitCode, 3);
  EXPECT_NE(early.err.find("missing"), std::string::npos) << early.err;
  ASSERT_EQ(test::run(cli(bake + " --part 1/2")).exitCode, 0);
  const auto joined = test::run(cli(bake + " --join"));
  ASSERT_EQ(joined.exitCode, 0) << joined.err;
  for (const char* part : {"3/2", "0/2", "a", "1/2x"})
    EXPECT_EQ(test::run(cli(bake + " --part " + part)).exitCode, 2) << part;
  const auto many = test::run(cli(bake + " --part 1/4097"));
  EXPECT_EQ(many.exitCode, 2);
  EXPECT_NE(many.err.find("4096"), std::string::npos) << many.err;
  const auto info = test::run(cli("info " + at("db") + " --json"));
  const auto json = nlohmann::json::parse(info.out);
  ASSERT_FALSE(json["patches"].empty());
  for (std::size_t depth = 1; depth < json["patches"].size(); ++depth)
    EXPECT_LE(json["patches"][depth]["error_m"], json["patches"][depth - 1]["error_m"]);
  EXPECT_NEAR(json["bytes_a_post"].get<double>(), json["bytes"].get<double>() / (300 * 200), 1e-9);
  const auto checked = test::run(cli("info " + at("db") + " --check"));
  EXPECT_EQ(checked.exitCode, 0) << checked.err;
  EXPECT_NE(checked.out.find("depth"), std::string::npos);
  EXPECT_NE(checked.out.find("every checksum holds"), std::string::npos);
  const auto full = test::run("( " + cli("info " + at("db")) + " >/dev/full )");
  EXPECT_EQ(full.exitCode, 1);
  EXPECT_NE(full.err.find("standard output"), std::string::npos) << full.err;
  std::string heights = test::readFile(dir_ / "db/heights.f32");
  heights[1000] = static_cast<char>(heights[1000] ^ 1);
  test::writeFile(dir_ / "db/heights.f32", heights);
  EXPECT_EQ(test::run(cli("info " + at("db"))).exitCode, 0);
  const auto damaged = test::run(cli("info " + at("db") + " --check"));
  EXPECT_EQ(damaged.exitCode, 1);
  EXPECT_NE(damaged.err.find("heights.f32: rows 0 to"), std::string::npos) << damaged.err;
}

TEST_F(TerrainCommand, answersHeightsWithTheirFileAndError) {
  // South of the equator and west of Greenwich: a plane that rises to the east.
  std::string rows = "ncols 40\nnrows 30\nxllcorner -70.05\nyllcorner -33.3\ncellsize 0.01\n";
  for (int i = 0; i < 40 * 30; ++i) rows += std::to_string(i % 40 * 10) + (i % 40 == 39 ? '\n' : ' ');
  test::writeFile(dir_ / "plane.asc", rows);
  test::writeFile(dir_ / "plane.prj",
                  R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
                  R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]])");
  const auto baked = test::run(cli("bake " + at("plane.asc") + " -o " + at("db")));
  ASSERT_EQ(baked.exitCode, 0) << baked.err;
  const auto asked = test::run(cli("height " + at("db") + " -33.175 -69.9 -33.1 -69.875 --json"));
  ASSERT_EQ(asked.exitCode, 0) << asked.err;
  const auto json = nlohmann::json::parse(asked.out);
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["latitude_deg"], -33.175);
  EXPECT_NEAR(json[0]["height_m"].get<double>(), 145, 1e-3);
  EXPECT_NEAR(json[1]["height_m"].get<double>(), 170, 1e-3);
  EXPECT_EQ(json[0]["source"], at("plane.asc"));
  EXPECT_GT(json[0]["error_m"], 0);
  test::writeFile(dir_ / "points.csv", "id,lon,lat\n1,-69.9,-33.175\n2,0,0\n");
  const auto table = test::run(cli("height " + at("db") + " --csv " + at("points.csv")));
  EXPECT_EQ(table.exitCode, 1);
  EXPECT_NE(table.out.find("latitude_deg,longitude_deg,height_m,error_m,source\n-33.175,-69.9,145,"),
            std::string::npos)
      << table.out;
  EXPECT_NE(table.out.find("\n0,0,,,\n"), std::string::npos) << table.out;
  EXPECT_NE(table.err.find("points.csv:3"), std::string::npos) << table.err;
  for (const char* wrong : {"", " 1", " 1 2 3", " 91 3", " 3 400"})
    EXPECT_EQ(test::run(cli("height " + at("db") + wrong)).exitCode, 2) << wrong;
}

TEST_F(TerrainCommand, asksForTheUnitOfHeightsAndTakesIt) {
  std::string rows = "ncols 40\nnrows 40\nxllcorner 1000000\nyllcorner 200000\ncellsize 100\n";
  for (int i = 0; i < 40 * 40; ++i) rows += std::string("900") + (i % 40 == 39 ? '\n' : ' ');
  test::writeFile(dir_ / "feet.asc", rows);
  test::writeFile(
      dir_ / "feet.prj",
      R"(PROJCS["NAD_1983_StatePlane_New_York_Long_Island_FIPS_3104_Feet",GEOGCS["GCS_North_American_1983",)"
      R"(DATUM["D_North_American_1983",SPHEROID["GRS_1980",6378137.0,298.257222101]],PRIMEM["Greenwich",0.0],)"
      R"(UNIT["Degree",0.0174532925199433]],PROJECTION["Lambert_Conformal_Conic"],)"
      R"(PARAMETER["False_Easting",984250.0],PARAMETER["False_Northing",0.0],)"
      R"(PARAMETER["Central_Meridian",-74.0],PARAMETER["Standard_Parallel_1",40.66666666666666],)"
      R"(PARAMETER["Standard_Parallel_2",41.03333333333333],PARAMETER["Latitude_Of_Origin",40.16666666666666],)"
      R"(UNIT["Foot_US",0.3048006096012192]])");
  const std::string bake = "bake " + at("feet.asc") + " -o " + at("db");
  const auto asked = test::run(cli(bake));
  EXPECT_EQ(asked.exitCode, 1);
  EXPECT_NE(asked.err.find("--height-unit"), std::string::npos) << asked.err;
  EXPECT_EQ(test::run(cli(bake + " --height-unit cubit")).exitCode, 2);
  const auto told = test::run(cli(bake + " --height-unit us_survey_foot"));
  ASSERT_EQ(told.exitCode, 0) << told.err;
  EXPECT_EQ(told.err.find("warning"), std::string::npos) << told.err;
  const auto info = nlohmann::json::parse(test::run(cli("info " + at("db") + " --json")).out);
  EXPECT_NEAR(info["highest_m"].get<double>(), 900 * 1200.0 / 3937, 1e-3);
}

TEST_F(TerrainCommand, keepsTheColumnsOfTheWholeEarthApart) {
  std::string rows = "ncols 361\nnrows 181\nxllcenter -180\nyllcenter -90\ncellsize 1\n";
  for (int i = 0; i < 361 * 181; ++i) rows += std::to_string(i * 7 % 500) + (i % 361 == 360 ? '\n' : ' ');
  test::writeFile(dir_ / "world.asc", rows);
  test::writeFile(dir_ / "world.prj",
                  R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
                  R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]])");
  const auto baked = test::run(cli("bake " + at("world.asc") + " -o " + at("db")));
  ASSERT_EQ(baked.exitCode, 0) << baked.err;
  const auto json = nlohmann::json::parse(test::run(cli("info " + at("db") + " --json")).out);
  ASSERT_GT(json["patches"][0]["error_m"], 1e4);
  std::istringstream table(test::run(cli("info " + at("db"))).out);
  std::string line;
  while (std::getline(table, line) && line.rfind("depth", 0) != 0) continue;
  for (const auto& depth : json["patches"]) {
    ASSERT_TRUE(std::getline(table, line));
    std::istringstream columns(line);
    std::vector<double> numbers;
    for (double number = 0; columns >> number;) numbers.push_back(number);
    ASSERT_EQ(numbers.size(), 7u) << line;
    EXPECT_NEAR(numbers[3], depth["bytes"].get<double>(), 0.5);
    EXPECT_NEAR(numbers[4], depth["error_m"].get<double>(), 0.01);
  }
}

TEST_F(TerrainCommand, bakesSceneryAndTellsOfItsTrees) {
  std::filesystem::create_directory(dir_ / "scenery");
  test::TileRecipe recipe;
  recipe.cells = 16;
  test::writeFile(dir_ / "scenery/3072816.btg.gz", test::gzipped(test::gridTile(recipe)));
  test::writeFile(dir_ / "scenery/3072816.stg", "OBJECT_BASE 3072816.btg\nOBJECT LOST.btg\n");
  const auto baked =
      test::run(cli("bake " + at("scenery") + " -o " + at("db") + " --leaf-triangles 100 --post-m 200"));
  ASSERT_EQ(baked.exitCode, 0) << baked.err;
  EXPECT_NE(baked.err.find("LOST.btg"), std::string::npos);
  const auto info = test::run(cli("info " + at("db") + " --json"));
  ASSERT_EQ(info.exitCode, 0) << info.err;
  const auto json = nlohmann::json::parse(info.out);
  EXPECT_EQ(json["scenery"]["tiles"], 1);
  EXPECT_EQ(json["scenery"]["triangles_in_file"], 512);
  EXPECT_EQ(json["scenery"]["degenerate"], 0);
  EXPECT_EQ(json["scenery"]["missing"], nlohmann::json::array({"LOST.btg"}));
  EXPECT_EQ(json["static_lod"]["triangles_per_node"], 100);
  EXPECT_EQ(json["static_lod"]["source_triangles"], 512);
  EXPECT_EQ(json["static_lod"]["levels"], json["static_lod"]["faces_of_level"].size());
  EXPECT_EQ(json["static_lod"]["faces_of_level"].back(), 512);
  EXPECT_EQ(json["image"], true);
  const std::string text = test::run(cli("info " + at("db"))).out;
  for (const char* line :
       {"scenery.missing", "LOST.btg", "static_lod.faces_of_level", "static_lod.locked_minima"})
    EXPECT_NE(text.find(line), std::string::npos) << line;

  const std::string write = "export btg " + at("db") + " -o " + at("out") + " --level ";
  const auto refused = test::run(cli(write + "9"));
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_NE(refused.err.find("level: expected 0 to"), std::string::npos) << refused.err;
  const auto written = test::run(cli(write + "0"));
  ASSERT_EQ(written.exitCode, 0) << written.err;
  EXPECT_NE(written.out.find("level 0: 1 tiles, 0 airports, 1 lists"), std::string::npos) << written.out;
  EXPECT_EQ(test::readFile(dir_ / "out/Terrain/e000n50/e007n50/3072816.stg"), "OBJECT_BASE 3072816.btg\n");
  const auto again = test::run(cli(write + "0"));
  EXPECT_EQ(again.exitCode, 1);
  EXPECT_NE(again.err.find("one that holds something"), std::string::npos) << again.err;
}

TEST_F(TerrainCommand, keepsTheTextureOfSceneryIfAskedTo) {
  TRIMTAB_NEEDS_SHARED("data/fg-cologne");
  const std::string airport =
      (test::sharedDir() / "data/fg-cologne/Terrain/e000n50/e007n50/EDKB.btg.gz").string();
  for (const bool keep : {false, true}) {
    const std::string db = at(keep ? "kept" : "plain"), out = at(keep ? "kept-out" : "plain-out");
    const auto baked = test::run(cli("bake " + airport + " -o " + db + (keep ? " --keep-texture" : "")));
    ASSERT_EQ(baked.exitCode, 0) << baked.err;
    ASSERT_EQ(test::run(cli("export btg " + db + " --level 9 -o " + out)).exitCode, 1);
    ASSERT_EQ(test::run(cli("export btg " + db + " --level 1 -o " + out)).exitCode, 0);
    const auto read = terrain::readBtg(out + "/Terrain/e000n50/e007n50/EDKB.btg.gz", true);
    ASSERT_TRUE(read) << toString(read.findings());
    float widest = 0;
    for (const auto& corners : read->texture)
      for (const auto& at : corners) widest = std::max(widest, std::abs(at[0]));
    // Markings along the runway reach 210; kilometres within a degree 70 at most.
    if (keep)
      EXPECT_GT(widest, 200);
    else
      EXPECT_LT(widest, 71);
  }
}

TEST_F(TerrainCommand, exportsOnlyWhatWasScenery) {
  ASSERT_EQ(test::run(cli("sample -o " + at("s.tif") + " --size-km 6")).exitCode, 0);
  ASSERT_EQ(test::run(cli("bake " + at("s.tif") + " -o " + at("db"))).exitCode, 0);
  const auto refused = test::run(cli("export btg " + at("db") + " --level 0 -o " + at("out")));
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_NE(refused.err.find("expected a database baked from scenery"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(at("out")));
}

TEST_F(TerrainCommand, tellsOfSceneryThatIsNotBaked) {
  test::writeFile(dir_ / "EDNY.btg.gz", test::gzipped(test::gridTile({})));
  for (const std::string& path : {at("EDNY.btg.gz"), dir_.path().string()}) {
    const auto info = test::run(cli("info " + path + " --json"));
    ASSERT_EQ(info.exitCode, 0) << info.err;
    const auto json = nlohmann::json::parse(info.out);
    EXPECT_EQ(json["scenery"]["airports"], 1);
    EXPECT_EQ(json["materials"]["Lake"], 16);
    EXPECT_EQ(json["files"][0]["name"], "EDNY");
    EXPECT_NEAR(json["files"][0]["west_deg"].get<double>(), 7, 1e-6);
    EXPECT_NE(test::run(cli("info " + path)).out.find("airport EDNY: version 7, 32 triangles"),
              std::string::npos);
  }
  test::writeFile(dir_ / "EDNY.btg.gz", "no tile");
  const auto broken = test::run(cli("info " + at("EDNY.btg.gz") + " --json"));
  EXPECT_EQ(broken.exitCode, 1);
  EXPECT_TRUE(broken.out.empty());
  EXPECT_NE(broken.err.find("magic number"), std::string::npos);
}

TEST_F(TerrainCommand, exitsWithOneForBadDataAndTwoForBadUsage) {
  test::writeFile(dir_ / "noise.tif", "no raster");
  const auto noise = test::run(cli("bake " + at("noise.tif") + " -o " + at("db")));
  EXPECT_EQ(noise.exitCode, 1);
  EXPECT_NE(noise.err.find("noise.tif"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "db"));
  const auto info = test::run(cli("info " + at("nowhere") + " --json"));
  EXPECT_EQ(info.exitCode, 1);
  EXPECT_TRUE(info.out.empty());
  for (const char* usage : {"", "bake", "bake x.tif", "sample", "info", "sample -o x.tif --post-m nothing",
                            "unknown", "bake x -o y --leaf-triangles 0", "bake x -o y --post-m 0"})
    EXPECT_EQ(test::run(cli(usage)).exitCode, 2) << usage;
}

TEST_F(TerrainCommand, leavesWhatOthersPutBesideASample) {
  const std::filesystem::path folder = dir_ / ".s.tif.part-2026-11-27";
  std::filesystem::create_directory(folder);
  test::writeFile(folder / "thesis.txt", "mine");
  const std::string sample = "sample --size-km 10 --post-m 200 -o ";
  const auto made = test::run(cli(sample + at("s.tif")));
  EXPECT_EQ(made.exitCode, 0) << made.err;
  EXPECT_NE(made.err.find("warning: " + folder.string() + ": "), std::string::npos) << made.err;
  EXPECT_EQ(test::readFile(folder / "thesis.txt"), "mine");
  const auto device = test::run(cli(sample + "/dev/null"));
  EXPECT_EQ(device.exitCode, 1);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null")) << "it is not replaced";
}

TEST_F(TerrainCommand, bakesInNoFolderOfOthers) {
  ASSERT_EQ(test::run(cli("sample --size-km 10 --post-m 200 -o " + at("s.tif"))).exitCode, 0);
  const std::filesystem::path work = dir_ / ".w.work";
  std::filesystem::create_directory(work);
  test::writeFile(work / "thesis.txt", "mine");
  const auto refused = test::run(cli("bake " + at("s.tif") + " -o " + at("w")));
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_NE(refused.err.find(work.string() + ": "), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("name another output"), std::string::npos) << refused.err;
  EXPECT_EQ(test::namesIn(work), std::vector<std::string>{"thesis.txt"});
  std::filesystem::remove(work / "thesis.txt");
  const auto made = test::run(cli("bake " + at("s.tif") + " -o " + at("w")));
  EXPECT_EQ(made.exitCode, 0) << made.err;
  EXPECT_FALSE(std::filesystem::exists(work));
}

/// `ulimit -f` has the system end a program by a signal, unless it ignores that.
TEST_F(TerrainCommand, saysWhenAFileMayNotBeSoLarge) {
  const std::pair<const char*, const char*> kinds[] = {{"--bare", "s.tif"}, {"", "s-objects.csv"}};
  for (const auto& [option, file] : kinds) {
    const auto ran = test::run("ulimit -f 100; " + cli("sample -o " + at("s.tif") + " " + option));
    EXPECT_EQ(ran.exitCode, 1) << ran.err;
    EXPECT_NE(ran.err.find(file), std::string::npos) << ran.err;
    EXPECT_TRUE(std::filesystem::is_empty(dir_.path()));
  }
}

TEST_F(TerrainCommand, stopsCleanlyWhenInterrupted) {
  const test::ScratchDir log;
  for (const int signal : {SIGINT, SIGTERM}) {
    // One for each, since the first one says what the second is waited for.
    const std::filesystem::path err = log / std::to_string(signal);
    test::Background sample(
        {test::program("trimtab-cli").string(), "terrain", "sample", "-o", at("s.tif"), "--post-m", "20"},
        err);
    ASSERT_TRUE(sample.says(" % "));
    EXPECT_EQ(sample.end(signal), 1) << test::readFile(err);
    EXPECT_NE(test::readFile(err).find("cancelled"), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_empty(dir_.path()));
  }
}

TEST_F(TerrainCommand, stopsCleanlyFromItsFirstMomentOn) {
  const test::ScratchDir log;
  test::Background sample(
      {test::program("trimtab-cli").string(), "terrain", "sample", "-o", at("s.tif"), "--post-m", "20"},
      log / "err");
  // A signal before the program begins ends any program.
  ASSERT_TRUE(test::until([&] { return test::catches(sample.pid(), SIGTERM); }));
  EXPECT_EQ(sample.end(SIGTERM), 1) << test::readFile(log / "err");
  EXPECT_NE(test::readFile(log / "err").find("cancelled"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(dir_.path()));
}

}  // namespace
}  // namespace trimtab
