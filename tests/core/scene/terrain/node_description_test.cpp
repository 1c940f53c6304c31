#include "trimtab/scene/node_description.h"

#include "tests/core/scene/scene_test.h"

namespace trimtab {
namespace {

using scene::describeNode;
using test::SceneTest;

class NodeDescription : public SceneTest {};

TEST_F(NodeDescription, saysOfTheNodeInTheMiddleOfTheImageWhatItIs) {
  use(test::syntheticMountains());
  const FrameRequest r = request(over(0.5, 0.5, 2500), {Degrees{0}, Degrees{-90}, Degrees{0}});
  FrameResult result;
  picture(r, &result);
  const std::vector<std::uint32_t> nodes = renderer.readNodes();
  const std::uint32_t node = nodes[nodes.size() / 2 + kWidth / 2];
  const auto found = describeNode(node, *database, r, result);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->form, "tile");
  EXPECT_EQ(found->level, database->index().level[node]);
  EXPECT_EQ(found->triangles, 2u * TerrainIndex::kTileCells * TerrainIndex::kTileCells);
  EXPECT_EQ(found->reason, CullReason::drawn);
  EXPECT_EQ(found->errorM, database->index().errorM[node]);
  EXPECT_GT(found->distanceM, 0);
  EXPECT_LT(found->distanceM, 2600) << "the eye is 2500 m above the ground in the middle";
  const double pixelsPerRadian = kWidth / (r.view.right - r.view.left);
  EXPECT_NEAR(found->errorPx, found->errorM / found->distanceM * pixelsPerRadian, found->errorPx * 0.01);
  EXPECT_GT(found->widthPx, 0);
  EXPECT_LE(found->widthPx, kWidth);
  EXPECT_GT(found->heightPx, 0);
  EXPECT_LE(found->heightPx, kHeight);
}

TEST_F(NodeDescription, saysWhyANodeIsLeftOutAndThatItHasNoSizeInTheImage) {
  use(test::syntheticMountains());
  const FrameRequest r = request(over(0.5, 0.5, 300), {Degrees{0}, Degrees{0}, Degrees{0}});
  FrameResult result;
  picture(r, &result);
  std::size_t outside = 0;
  for (std::uint32_t node = 0; node < database->index().size(); ++node) {
    const auto found = describeNode(node, *database, r, result);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->reason, result.visible.reasonOf(node));
    outside += found->reason == CullReason::outside_frustum && found->widthPx * found->heightPx == 0;
  }
  EXPECT_GT(outside, 0u);
  EXPECT_EQ(scene::inWords(CullReason::outside_frustum), "outside the frustum");
}

TEST_F(NodeDescription, isNothingWhereTheTerrainHasNoSuchNode) {
  use(test::syntheticMountains());
  const FrameRequest r = request(over(0.5, 0.5, 300), {Degrees{0}, Degrees{0}, Degrees{0}});
  FrameResult result;
  picture(r, &result);
  EXPECT_FALSE(describeNode(scene::Renderer::kNoNode, *database, r, result));
  EXPECT_FALSE(describeNode(static_cast<std::uint32_t>(database->index().size()), *database, r, result));
  result.patches = true;
  EXPECT_FALSE(describeNode(0, *database, r, result)) << "an old result of a terrain that had patches";
}

}  // namespace
}  // namespace trimtab
