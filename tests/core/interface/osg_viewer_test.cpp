#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "tests/core/scene/foreign/paged_scene.h"
#include "tests/support.h"
#include "trimtab/preset/preset.h"
#include "trimtab/rig/ig_fit.h"

/// The example of an image generator on osgViewer, built as its author would, in a window over a paged scene.
namespace trimtab::test {
namespace {

class OsgViewerExample : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "It needs an X server.";
    ASSERT_TRUE(scene_.written());
    const Ran built =
        run(TRIMTAB_CXX " -std=c++17 -Wall -Wextra -Wno-deprecated-copy " +
            (sourceDir() / "tests/core/interface/examples/osg_viewer.cpp").string() + " -I" +
            (sourceDir() / "core/interface/include").string() + " -o " + (dir_ / "viewer").string() +
            " $(pkg-config --cflags --libs openscenegraph) -L" TRIMTAB_LIBRARY_DIR
            " -ltrimtab -Wl,-rpath," TRIMTAB_LIBRARY_DIR);
    ASSERT_EQ(built.exitCode, 0) << built.err;
    std::string table;
    for (int i = 0; i < 1000; ++i) {
      table +=
          std::to_string(i / 60.0) + " 36.6 128.32 900 " + std::to_string(0.1 * i) + " -25 0 nan nan nan\n";
      if (i == 399) writeFile(dir_ / "table.txt", table);
    }
    writeFile(dir_ / "long.txt", table);
  }

  /// Returns the columns of the last hundred images: all pages that they need have been read by then.
  std::vector<std::array<double, 3>> flown(TuningParameters p) {
    writeFile(dir_ / "preset.json", exportText(*validate(p), "preset", {}, ExportFormat::json));
    const Ran ran = run(viewer((dir_ / "preset.json").string(), "table.txt"));
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    std::istringstream lines(ran.out.substr(ran.out.find_first_of("0123456789")));
    std::vector<std::array<double, 3>> all;
    for (std::array<double, 3> row{}; lines >> row[0] >> row[1] >> row[2];) all.push_back(row);
    EXPECT_EQ(all.size(), 400u) << ran.out.substr(0, 500);
    return {all.end() - std::min<std::ptrdiff_t>(100, std::ssize(all)), all.end()};
  }
  std::string viewer(const std::string& preset, const std::string& table) const {
    return (dir_ / "viewer").string() + ' ' + preset + ' ' + scene_.file().string() + ' ' +
           (dir_ / table).string() + ' ' + kProfile;
  }
  static double mean(const std::vector<std::array<double, 3>>& rows, std::size_t column) {
    double sum = 0;
    for (const auto& row : rows) sum += row[column];
    return sum / static_cast<double>(rows.size());
  }

  const std::string kProfile = (sourceDir() / "tests/core/interface/examples/osg_viewer.json").string();
  ScratchDir dir_;
  SyntheticTerrain ground_{4, 0.001, {Degrees{36.57}, Degrees{128.29}, Metres{0}}, [](int column, int row) {
                             return 200 + 100 * std::sin(column * 0.3 + row * 0.2);
                           }};
  PagedScene scene_{ground_, dir_.path(), ".osgb", true};
};

TEST_F(OsgViewerExample, followsThePolicyOfAPreset) {
  TuningParameters p;
  p.motion.control = MotionControl::off;
  const auto fine = flown(p);
  EXPECT_GT(mean(fine, 1), 1000) << "the scene is not in view";
  p.policy.enabled = true;
  p.policy.terms.line = {"altitude low = ramp 5500 4500"};
  p.policy.rules.line = {"if altitude is low then lod_scale = 8"};
  const auto coarse = flown(p);
  EXPECT_GT(mean(coarse, 0), 6 * mean(fine, 0));
  EXPECT_LT(mean(coarse, 1), 0.6 * mean(fine, 1));
  EXPECT_GT(mean(coarse, 1), 0);
  std::printf("triangles %.0f at LOD scale %.2f, %.0f at %.2f\n", mean(fine, 1), mean(fine, 0),
              mean(coarse, 1), mean(coarse, 0));
}

TEST_F(OsgViewerExample, isFittedByOneCommand) {
  const Ran ran = run(TRIMTAB_CLI " fit --profile " + kProfile + " --preset low-level -o " +
                      (dir_ / "fit").string() + " -- " + viewer("{preset}", "long.txt"));
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_NE(ran.out.find("LODScale 4: time "), std::string::npos) << ran.out;
  const Result<IgProfile> profile = loadIgProfile(kProfile);
  const Result<IgFit> fit = loadIgFit(dir_ / "fit/fit.json");
  ASSERT_TRUE(profile && fit) << toString(fit.findings());
  EXPECT_EQ(fit->views, 1000 / 30u);
  EXPECT_GT(fit->loadHigh, fit->loadLow);
  EXPECT_LT(fit->shape[2], 0.9) << "four times the LOD scale draws fewer triangles";
  EXPECT_GE(fit->shape[2], fit->shape[3]);
  EXPECT_GT(fit->points.back().time.high, fit->points.back().time.low);
  EXPECT_TRUE(std::isfinite(fit->points.front().flip)) << "it gave no images";
  const Result<Preset> fitted = loadPreset((dir_ / "fit/fitted.json").string());
  ASSERT_TRUE(fitted) << toString(fitted.findings());
  EXPECT_TRUE(validate(fitted->parameters));
  EXPECT_NE(fitted->parameters.policy.terms.line.front(), "triangles many = ramp 50000 150000");
  std::printf("%s", ran.out.c_str());
}

TEST_F(OsgViewerExample, thatFliesTooShortIsNotFitted) {
  const Ran ran = run(TRIMTAB_CLI " fit --profile " + kProfile + " -o " + (dir_ / "fit").string() + " -- " +
                      viewer("{preset}", "table.txt"));
  EXPECT_EQ(ran.exitCode, 1);
  EXPECT_NE(ran.err.find("at least 20 views"), std::string::npos) << ran.err;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "fit/fitted.json"));
  std::filesystem::create_directory(dir_ / "mine");
  writeFile(dir_ / "mine/fit.json", "{\"mine\": true}");
  const Ran mine =
      run(TRIMTAB_CLI " fit --profile " + kProfile + " -o " + (dir_ / "mine").string() + " -- no-such-ig");
  EXPECT_EQ(mine.exitCode, 1);
  EXPECT_EQ(readFile(dir_ / "mine/fit.json"), "{\"mine\": true}") << "a file of somebody else was lost";
  const Ran none =
      run(TRIMTAB_CLI " fit --profile " + kProfile + " -o " + (dir_ / "fit").string() + " -- no-such-ig");
  EXPECT_EQ(none.exitCode, 1);
  EXPECT_NE(none.err.find("no-such-ig"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace trimtab::test
