#include <algorithm>

#include "culling_truth.h"
#include "trimtab/scene/planted_defects.h"
#include "undrawn.h"

/// That culling_views_test.cpp and its like find what is culled wrongly.
namespace trimtab {
namespace {

using CullingDefects = test::CullingTruth;

TEST_F(CullingDefects, areFoundByWhoOwnsThePixels) {
  use(test::syntheticMountains());
  constexpr OcclusionResolution kCoarse{8, 6};
  std::vector<View> views;
  for (const auto& r : anyViews(48, 1)) views.push_back(truthOf(r, false));
  for (const OcclusionMethod method : {OcclusionMethod::depth_map, OcclusionMethod::horizon})
    for (const double lowering : {0.0, 1.0}) {
      plant(renderer, {.loweringScale = lowering});
      Tally tally;
      for (const View& view : views) compare(view, CullingCase::proposed, method, kCoarse, tally);
      EXPECT_EQ(tally.wrongNodes > 0, lowering < 1) << "method " << static_cast<int>(method);
      EXPECT_GE(tally.wrongPixels, tally.wrongNodes);
    }
  std::size_t found = 0;
  for (const View& view : views) {
    if (view.owners.empty()) continue;
    // The one that shows least.
    const auto least = *std::min_element(view.owners.begin(), view.owners.end(),
                                         [](auto a, auto b) { return a.second < b.second; });
    plant(renderer, {.culledNode = least.first});
    Tally tally;
    compare(view, CullingCase::view_frustum, OcclusionMethod::horizon, kCoarse, tally);
    EXPECT_EQ(tally.wrongNodes, 1u);
    EXPECT_EQ(tally.wrongPixels, least.second);
    ++found;
  }
  EXPECT_GT(found, 36u);
}

/// Most frames of these tests are made without their pictures.
TEST_F(CullingDefects, areSoughtInTheSetsOfDrawnFrames) {
  use(test::syntheticMountains());
  std::size_t occluded = 0;
  for (auto& r : anyViews(48, 2)) {
    r.levers.drawn.occlusion = kBands[1];
    for (const auto& choice : test::occlusionChoices()) {
      if (choice.method == OcclusionMethod::automatic) continue;
      r.occlusion = choice.method;
      const auto nodes = [&](bool wholly) {
        const unsigned long before = test::Undrawn::calls();
        const auto result = draw(r, wholly);
        EXPECT_EQ(test::Undrawn::calls() > before, !wholly && !result.visible.tiles.empty());
        occluded += result.visible.occluded;
        return nodesOf(result.visible);
      };
      const auto drawn = nodes(true);
      EXPECT_EQ(nodes(false), drawn) << choice.name << ", " << describe(r);
    }
  }
  EXPECT_GT(occluded, 500u);
}

}  // namespace
}  // namespace trimtab
