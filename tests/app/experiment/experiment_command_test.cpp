#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/app/small_run.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

test::Ran experimentBy(const std::string& arguments) {
  return test::run(test::program("trimtab-cli").string() + " experiment " + arguments);
}

TEST(ExperimentCommand, refusesAFolderForResultsBeforeItOpensTheTerrain) {
  for (const char* command : {"experiment culling", "leverage --flight none.csv"}) {
    const test::Ran ran = test::run(test::program("trimtab-cli").string() + " " + command +
                                    " --terrain /no/such/terrain -o /proc/results");
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_NE(ran.err.find("/proc/results"), std::string::npos) << ran.err;
    EXPECT_EQ(ran.err.find("/no/such/terrain"), std::string::npos) << ran.err;
  }
}

using ExperimentRun = test::SmallRun;

TEST_F(ExperimentRun, printsOneDocumentAndWritesTablesAndPlots) {
  const test::ScratchDir dir;
  test::writeFile(dir / "file", "");
  const test::Ran nowhere = experimentBy("culling --terrain " + database() + " --size 64x48 --repeats 1 -o " +
                                         (dir / "file/out").string());
  EXPECT_EQ(nowhere.exitCode, 1);
  EXPECT_THAT(nowhere.err, HasSubstr("file/out: expected a folder that can be written"));
  EXPECT_EQ(nowhere.out, "");
  EXPECT_THAT(nowhere.err, ::testing::Not(HasSubstr(" % "))) << "before the work, not after it";
  const std::string out = (dir / "out").string();
  const test::Ran ran =
      experimentBy("culling --terrain " + database() + " --size 64x48 --repeats 1 --json -o " + out +
                   " --set fuzzy.combination=twice_minimum");
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const json document = json::parse(ran.out);
  EXPECT_EQ(document.at("published").size(), 12u);
  EXPECT_EQ(document.at("measured").size(), 16u);
  EXPECT_TRUE(document.at("machine").is_string());
  for (const char* column : {"altitude_ft", "case", "triangles", "vertices", "frame_ms", "fps"})
    EXPECT_TRUE(document.at("measured")[0].contains(column)) << column;
  EXPECT_THAT(ran.err, HasSubstr(" % 8000 ft"));
  for (const char* name : {"culling.json", "culling.html", "culling-published.csv", "culling-measured.csv"})
    EXPECT_GT(test::readFile((dir / "out") / name).size(), 100u) << name;
}

TEST_F(ExperimentRun, writesTheCalibratedStepIntoAPresetUnlessItIsRejected) {
  const test::ScratchDir dir;
  int rejected = 0;
  const std::string preset = (dir / "tuned.json").string();
  const std::string command =
      cli() + " weather calibrate --terrain " + database() + " --size 160x90 --repeats 1 --step rain_heavy";
  // A tolerance so small that no two times agree, and one within which they do unless the machine is busy.
  for (const char* tolerance : {"0.001", "0.5"}) {
    std::filesystem::remove(preset);
    const test::Ran ran =
        test::run(command + " --set weather.tolerance=" + tolerance + " --json -o " + preset);
    const json document = json::parse(ran.out);
    ASSERT_EQ(document.at("steps").size(), 1u);
    const json& step = document.at("steps")[0];
    EXPECT_EQ(step.at("step"), "rain_heavy");
    EXPECT_FALSE(step.at("trials").empty());
    const std::string why = step.at("rejected");
    EXPECT_EQ(ran.exitCode, why.empty() ? 0 : 1) << ran.err;
    EXPECT_EQ(std::filesystem::exists(preset), why.empty());
    if (!why.empty()) {
      ++rejected;
      EXPECT_THAT(ran.err, HasSubstr("rain_heavy: expected times that agree"));
      EXPECT_THAT(ran.err, HasSubstr(why));
      continue;
    }
    const json written = json::parse(test::readFile(preset)).at("parameters");
    for (const auto& [key, value] : written.items()) EXPECT_THAT(key, HasSubstr("weather.")) << value;
  }
  EXPECT_GE(rejected, 1);
  const test::Ran refused = test::run(command + " --vertices 1e9 -o " + (dir / "none.json").string());
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_THAT(refused.err, HasSubstr("--vertices"));
  EXPECT_FALSE(std::filesystem::exists(dir / "none.json"));
  EXPECT_EQ(test::run(command + " --step fog").exitCode, 2);
}

TEST(LeverageCommand, printsOneDocumentAndWritesTableAndPicture) {
  const test::ScratchDir dir;
  const std::string cli = test::program("trimtab-cli").string(), tif = (dir / "sample.tif").string(),
                    database = (dir / "db").string(), out = (dir / "out").string();
  ASSERT_EQ(test::run(cli + " terrain sample --size-km 20 -o " + tif).exitCode, 0);
  ASSERT_EQ(test::run(cli + " terrain bake " + tif + " -o " + database).exitCode, 0);
  const std::string command =
      cli + " leverage --terrain " + database + " --size 64x48 --repeats 1 --frames 2";
  const test::Ran ran = test::run(command + " --set hold.loss_blur=0.1 --json --losses " +
                                  (dir / "losses.json").string() + " -o " + out + " --flight " +
                                  (test::sourceDir() / "resources/flights/yecheon-circuit.csv").string());
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const json document = json::parse(ran.out);
  EXPECT_EQ(document.at("leverage").size(), 7u);
  for (const char* key : {"machine", "flight", "terrain", "preset"})
    EXPECT_TRUE(document.at(key).is_string()) << key;
  EXPECT_EQ(document.at("frames"), 2);
  EXPECT_EQ(document.at("flight"), "yecheon-circuit.csv");
  EXPECT_EQ(json::parse(test::readFile(dir / "out" / "leverage.json")), document);
  for (const char* name : {"leverage.csv", "leverage.html"})
    EXPECT_GT(test::readFile(dir / "out" / name).size(), 100u) << name;
  const auto losses = loadPreset((dir / "losses.json").string());
  ASSERT_TRUE(losses) << toString(losses.findings());
  const HoldParameters& hold = losses->parameters.hold;
  const std::map<std::string, double> taken{{"screen_space_error", hold.lossError.value()},
                                            {"render_scale", hold.lossRenderScale.value()},
                                            {"particle_density", hold.lossParticles.value()},
                                            {"blur_strength", hold.lossBlur.value()}};
  std::size_t compared = 0;
  for (const json& row : document.at("leverage"))
    if (const auto loss = taken.find(row.at("lever")); loss != taken.end()) {
      EXPECT_NEAR(loss->second, std::max(row.at("flip_lost").get<double>(), 0.0), 1e-4) << loss->first;
      ++compared;
    }
  EXPECT_EQ(compared, taken.size());
  EXPECT_THAT(ran.err, HasSubstr(" % Render scale"));
  EXPECT_EQ(test::run(command).exitCode, 2) << "no flight is wrong usage";
  const test::Ran refused = test::run(command + " --flight /none.csv");
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_THAT(refused.err, HasSubstr("/none.csv"));
}

TEST(ExperimentCommand, tellsAllThatIsWrongWithItsInput) {
  const test::Ran ran =
      experimentBy("weather --terrain /nowhere --size 10x --preset nope --flight /none.csv");
  EXPECT_EQ(ran.exitCode, 1);
  for (const char* said : {"--size", "nope", "/none.csv", "/nowhere"}) EXPECT_THAT(ran.err, HasSubstr(said));
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(experimentBy("culling").exitCode, 2) << "no terrain is wrong usage";
  EXPECT_EQ(experimentBy("nothing --terrain x").exitCode, 2);
}

}  // namespace
}  // namespace trimtab
