#include <nlohmann/json.hpp>

#include "support.h"

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

TEST_F(TerrainCommand, exitsWithOneForBadDataAndTwoForBadUsage) {
  test::writeFile(dir_ / "noise.tif", "no raster");
  const auto noise = test::run(cli("bake " + at("noise.tif") + " -o " + at("db")));
  EXPECT_EQ(noise.exitCode, 1);
  EXPECT_NE(noise.err.find("noise.tif"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "db"));
  const auto info = test::run(cli("info " + at("nowhere") + " --json"));
  EXPECT_EQ(info.exitCode, 1);
  EXPECT_TRUE(info.out.empty());
  for (const char* usage :
       {"", "bake", "bake x.tif", "sample", "info", "sample -o x.tif --post-m nothing", "unknown"})
    EXPECT_EQ(test::run(cli(usage)).exitCode, 2) << usage;
}

TEST_F(TerrainCommand, stopsCleanlyWhenInterrupted) {
  const auto stopped = test::run("exec timeout -s INT --preserve-status 0.3 " +
                                 cli("sample -o " + at("s.tif") + " --post-m 30"));
  EXPECT_EQ(stopped.exitCode, 1) << stopped.err;
  EXPECT_NE(stopped.err.find("cancelled"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(dir_.path()));
}

}  // namespace
}  // namespace trimtab
