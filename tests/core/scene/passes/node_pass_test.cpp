#include <random>

#include "tests/core/scene/culling/node_owners.h"
#include "tests/core/scene/terrain/synthetic_trees.h"
#include "trimtab/scene/renderer.h"

namespace trimtab {
namespace {

constexpr std::uint32_t kNoNode = scene::Renderer::kNoNode;

using NodePass = test::NodeOwners;

TEST_F(NodePass, givesEachPixelToTheTileWithoutWhichItChanges) {
  use(test::syntheticMountains());
  auto r = request(over(0.4, 0.5, 150), {Degrees{40}, Degrees{-6}, Degrees{17}});
  for (const double error : {0.1, 4.0}) {
    r.levers.drawn.errorPx = error;
    compareWithLeavingOut(r, 24);
  }
  r.decision.weather = {.fogged = true, .visibilityM = 6000, .extinctionPerM = 6e-4, .farM = 6000};
  r.levers.drawn.farM = r.decision.weather.farM;
  compareWithLeavingOut(r, 12);
}

TEST_F(NodePass, givesEachPixelToTheNodeOfStaticTreesWithoutWhichItChanges) {
  use(std::make_shared<const test::TreeTerrain>(test::syntheticMountains()));
  auto r = request(over(0.4, 0.5, 150), {Degrees{40}, Degrees{-6}, Degrees{}});
  r.terrain.form = TerrainForm::static_trees;
  r.levers.drawn.treeErrorPx = 4;
  r.cullingCase = CullingCase::view_frustum;
  compareWithLeavingOut(r, 24);
}

TEST_F(NodePass, withoutCullingIsThePictureWithoutCulling) {
  use(test::syntheticMountains());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.15, 0.85), unit(0, 1);
  for (int i = 0; i < 8; ++i) {
    auto r = request(over(place(random), place(random), 60 + 1500 * unit(random)),
                     {Degrees{360 * unit(random)}, Degrees{-50 * unit(random)}, Degrees{360 * unit(random)}});
    r.levers.drawn.occlusion = OcclusionResolution{320, 240};
    picture(r);
    const auto unculled = renderer.readNodes(true);
    r.cullingCase = CullingCase::none;
    picture(r);
    EXPECT_EQ(unculled, renderer.readNodes()) << "view " << i;
  }
}

TEST_F(NodePass, isEmptyBeforeThereIsAPicture) {
  EXPECT_TRUE(renderer.readNodes().empty());
  picture(request({Degrees{36}, Degrees{128}, Metres{100}}, {}));
  for (const std::uint32_t node : renderer.readNodes(true)) ASSERT_EQ(node, kNoNode) << "no terrain";
  use(test::syntheticMountains());
  EXPECT_TRUE(renderer.readNodes().empty()) << "the last picture was of another terrain";
}

}  // namespace
}  // namespace trimtab
