#include <algorithm>
#include <cmath>
#include <map>

#include "error_meter_fixture.h"
#include "tests/core/scene/terrain/synthetic_trees.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/scene/renderer.h"

namespace trimtab {
namespace {

constexpr std::uint32_t kSkyNode = scene::Renderer::kNoNode;

using PlantedDefects = test::ErrorMeterTest;

/// Peaks of one post where no coarser level has a post: every level's error is seen against the sky.
double peaks(int column, int row) {
  return column % 8 == 3 && row % 8 == 5 ? 400.0 : 30 * std::sin(column * 0.05) * std::cos(row * 0.04);
}

/// A gentle ridge, and far behind it a higher one that shows by a pixel or two.
double twoRidges(int, int row) {
  const auto ridge = [row](double at, double width, double height) {
    return height * std::exp(-std::pow((row - at) / width, 2));
  };
  return 20 + ridge(110, 16, 400) + ridge(300, 40, 1350);
}

std::shared_ptr<const test::SyntheticTerrain> terrainOf(double (*height)(int, int)) {
  return std::make_shared<const test::SyntheticTerrain>(
      16, 1.0 / 1200, GeodeticPosition{Degrees{36.4}, Degrees{128.1}, Metres{0}}, height);
}

TEST_F(PlantedDefects, findsATileThatIsLeftOut) {
  measureOver(test::syntheticMountains());
  const auto r = lowRequest();
  EXPECT_EQ(measure(r).wronglyCulledPixels, 0u);
  picture(r);
  std::map<std::uint32_t, std::uint64_t> owned;
  for (const std::uint32_t node : renderer.readNodes())
    if (node != kSkyNode) ++owned[node];
  for (const auto& [node, pixels] : owned) {
    plant(meter, {.culledNode = node});
    EXPECT_EQ(measure(r).wronglyCulledPixels, pixels);
  }
  plant(meter, {});
  EXPECT_EQ(measure(r).wronglyCulledPixels, 0u);
}

TEST_F(PlantedDefects, areNotTheReferences) {
  measureOver(test::syntheticMountains());
  auto r = lowRequest();
  r.levers.drawn.errorPx = 1e-6;
  const auto reference = picture(scene::referenceOf(r));
  const std::uint32_t node = renderer.readNodes()[100 * kWidth + 320];
  ASSERT_NE(node, kSkyNode);
  plant(meter, {.culledNode = node});
  scene::ErrorPictures pictures;
  EXPECT_GT(measure(r, nullptr, &pictures).wronglyCulledPixels, 0u);
  EXPECT_EQ(pictures.reference, reference);
  EXPECT_NE(pictures.ours, reference);
}

TEST_F(PlantedDefects, findsANodeOfStaticTreesThatIsLeftOut) {
  measureOver(std::make_shared<const test::TreeTerrain>(test::syntheticMountains()));
  auto r = lowRequest();
  r.terrain.form = TerrainForm::static_trees;
  scene::ErrorPictures pictures;
  EXPECT_EQ(measure(r, nullptr, &pictures).wronglyCulledPixels, 0u);
  EXPECT_TRUE(pictures.drawn.staticLod.drawn && pictures.drawnReference.staticLod.drawn);
  EXPECT_GT(pictures.drawnReference.visible.triangles, pictures.drawn.visible.triangles);
  picture(r);
  const auto nodes = renderer.readNodes();
  const std::uint32_t node = nodes[100 * kWidth + 320];
  ASSERT_NE(node, kSkyNode);
  plant(meter, {.culledNode = node});
  EXPECT_EQ(measure(r).wronglyCulledPixels,
            static_cast<std::uint64_t>(std::count(nodes.begin(), nodes.end(), node)));
}

TEST_F(PlantedDefects, findsLevelsWhoseErrorIsUnderstated) {
  measureOver(terrainOf(peaks));
  auto r = lowRequest();
  r.eye.height = r.eye.height + Metres{200};
  for (const double truly : {1.0, 0.05, 1.0}) {
    plant(meter, {.statedErrorScale = truly});
    const FrameError error = measure(r);
    EXPECT_EQ(error.geometricMaxPx > test::geometricBoundPx(r), truly < 1) << error.geometricMaxPx;
    EXPECT_EQ(error.wronglyCulledPixels, 0u) << "levels are another matter";
  }
}

TEST_F(PlantedDefects, findsADepthMapThatIsReadATexelAside) {
  measureOver(terrainOf(twoRidges));
  // On its side, so that aside is down: what the near ridge hides reaches a texel higher.
  auto r = request(over(0.5, 0.06, 60), {Degrees{}, Degrees{}, Degrees{90}});
  r.levers.drawn.occlusion = OcclusionResolution{64, 48};
  r.levers.drawn.errorPx = 1e-6;
  for (const int shift : {0, 1, 0}) {
    plant(meter, {.depthMapShiftTexels = shift});
    scene::ErrorPictures pictures;
    const FrameError error = measure(r, nullptr, &pictures);
    EXPECT_GT(pictures.drawn.visible.occluded, 20u);
    EXPECT_EQ(error.wronglyCulledPixels > 100, shift != 0) << error.wronglyCulledPixels;
    EXPECT_EQ(error.wronglyCulledPixels == 0, shift == 0);
  }
}

}  // namespace
}  // namespace trimtab
