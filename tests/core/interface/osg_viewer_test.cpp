#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "tests/core/scene/foreign/paged_scene.h"
#include "tests/support.h"
#include "trimtab/preset/preset.h"

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
    for (int i = 0; i < 400; ++i)
      table +=
          std::to_string(i / 60.0) + " 36.6 128.32 900 " + std::to_string(0.1 * i) + " -25 0 nan nan nan\n";
    writeFile(dir_ / "table.txt", table);
  }

  /// Returns the columns of the last hundred images: all pages that they need have been read by then.
  std::vector<std::array<double, 3>> flown(TuningParameters p) {
    writeFile(dir_ / "preset.json", exportText(*validate(p), "preset", {}, ExportFormat::json));
    const Ran ran = run((dir_ / "viewer").string() + ' ' + (dir_ / "preset.json").string() + ' ' +
                        scene_.file().string() + ' ' + (dir_ / "table.txt").string());
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    std::istringstream lines(ran.out.substr(ran.out.find_first_of("0123456789")));
    std::vector<std::array<double, 3>> all;
    for (std::array<double, 3> row{}; lines >> row[0] >> row[1] >> row[2];) all.push_back(row);
    EXPECT_EQ(all.size(), 400u) << ran.out.substr(0, 500);
    return {all.end() - std::min<std::ptrdiff_t>(100, std::ssize(all)), all.end()};
  }
  static double mean(const std::vector<std::array<double, 3>>& rows, std::size_t column) {
    double sum = 0;
    for (const auto& row : rows) sum += row[column];
    return sum / static_cast<double>(rows.size());
  }

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

}  // namespace
}  // namespace trimtab::test
