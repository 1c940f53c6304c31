#include <algorithm>

#include "ig_support.h"
#include "tests/core/scene/foreign/paged_scene.h"
#include "trimtab/host/flight.h"

namespace trimtab {
namespace {

/// The reference IG flies an export over a paged scene of OpenSceneGraph.
class IgOsgScene : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(scene_.written());
    const auto preset = test::edited([](TuningParameters& p) {
      p.motion.control = MotionControl::off;  // it would multiply the scale, too
      p.policy.enabled = true;
      p.policy.terms.line = {"altitude low = ramp 5500 4500"};
      p.policy.rules.line = {"if altitude is low then lod_scale = 1",
                             "if altitude is not low then lod_scale = 8"};
    });
    test::writeFile(dir_ / "preset.json", test::exported(preset));
    test::writeFile(dir_ / "flight.csv", flightCsv(test::weavingFlight(240)));
  }
  int fly(const std::filesystem::path& terrain, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"--preset",   (dir_ / "preset.json").string(),
                                       "--terrain",  terrain.string(),
                                       "--flight",   (dir_ / "flight.csv").string(),
                                       "--trace",    (dir_ / "trace.csv").string(),
                                       "--headless", "--size",
                                       "320x200",    "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    test::IgProcess ig(arguments);
    const int code = ig.end();
    said_ = ig.err();
    return code;
  }

  test::ScratchDir dir_;
  test::SyntheticTerrain ground_{
      4, 0.001, {Degrees{36.57}, Degrees{128.29}, Metres{0}}, [](int column, int row) {
        return 200 + 100 * std::sin(column * 0.3 + row * 0.2);
      }};
  test::PagedScene scene_{ground_, dir_.path(), ".osgb", true};
  std::string said_;
};

TEST_F(IgOsgScene, isFlownAndItsPolicyMovesTheLevelsOfOsg) {
  ASSERT_EQ(fly(scene_.file()), 0) << said_;
  const auto rows = readTrace(dir_ / "trace.csv");
  ASSERT_TRUE(rows) << toString(rows.findings());
  ASSERT_EQ(rows->size(), 240u);
  double fine = 0, coarse = 0, fineImages = 0, coarseImages = 0;
  for (const TraceRow& row : *rows) {
    EXPECT_GT(row.frame->counts.triangles, 0u);
    const double scale = row.levers.drawn.lodScale;
    EXPECT_GE(scale, 1);
    (scale > 6 ? coarse : fine) +=
        scale > 6 || scale < 2 ? static_cast<double>(row.frame->counts.triangles) : 0;
    coarseImages += scale > 6;
    fineImages += scale < 2;
  }
  ASSERT_GT(fineImages, 10);
  ASSERT_GT(coarseImages, 10);
  EXPECT_LT(coarse / coarseImages, 0.6 * fine / fineImages);
}

TEST_F(IgOsgScene, thatIsDamagedIsNamed) {
  std::filesystem::remove(scene_.page(1, 0, 0));
  std::filesystem::remove(scene_.page(1, 1, 1));
  EXPECT_EQ(fly(scene_.file()), 1) << "as with any damaged terrain";
  EXPECT_NE(said_.find("page_1_"), std::string::npos) << said_;
  EXPECT_EQ(readTrace(dir_ / "trace.csv")->size(), 240u) << "the rest is flown over";
  EXPECT_EQ(fly(dir_ / "none.ive"), 1);
  EXPECT_NE(said_.find("none.ive"), std::string::npos) << said_;
  EXPECT_EQ(fly(scene_.file(), {"--origin", "36,128"}), 1);
  EXPECT_NE(said_.find("geocentric"), std::string::npos) << said_;
}

}  // namespace
}  // namespace trimtab
