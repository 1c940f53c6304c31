#include "trimtab/scene/error_meter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "scene_test.h"
#include "synthetic_trees.h"
#include "trimtab/scene/gl_api.h"

namespace trimtab {
namespace {

using test::SceneTest;
constexpr std::uint32_t kNoNode = scene::Renderer::kNoNode;

class NodePass : public SceneTest {
 protected:
  /// What each node owns must be exactly where the picture changes once the node is left out.
  void compareWithLeavingOut(const scene::FrameRequest& r, std::size_t most) {
    scene::FrameResult result;
    picture(r, &result);
    const auto distances = renderer.readDistances();
    const auto nodes = renderer.readNodes();
    ASSERT_EQ(nodes.size(), distances.size());
    EXPECT_EQ(renderer.readDistances(), distances) << "the picture stays as it is";
    std::map<std::uint32_t, std::size_t> owned;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      EXPECT_EQ(nodes[i] == kNoNode, std::isinf(distances[i]));
      if (nodes[i] != kNoNode) ++owned[nodes[i]];
    }
    EXPECT_GT(owned.size(), 3u);
    std::size_t tried = 0;
    for (const TileDraw& tile : result.visible.tiles) {
      if (tried++ == most) break;
      renderer.plant({.culledNode = tile.node});
      picture(r);
      const auto without = renderer.readDistances();
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        wrong += (without[i] != distances[i]) != (nodes[i] == tile.node);
      EXPECT_EQ(wrong, 0u) << "node " << tile.node << " owns " << owned[tile.node];
    }
    renderer.plant({});
  }
};

TEST_F(NodePass, givesEachPixelToTheTileWithoutWhichItChanges) {
  use(test::syntheticMountains());
  auto r = request(over(0.4, 0.5, 150), {Degrees{40}, Degrees{-6}, Degrees{17}});
  for (const double error : {0.1, 4.0}) {
    r.lod.screenSpaceError = Pixels{error};
    compareWithLeavingOut(r, 24);
  }
  r.decision.weather = {.fogged = true, .visibilityM = 6000, .extinctionPerM = 6e-4, .farM = 6000};
  compareWithLeavingOut(r, 12);
}

TEST_F(NodePass, givesEachPixelToTheNodeOfStaticTreesWithoutWhichItChanges) {
  use(std::make_shared<const test::TreeTerrain>(test::syntheticMountains()));
  auto r = request(over(0.4, 0.5, 150), {Degrees{40}, Degrees{-6}, Degrees{}});
  r.staticLod.terrain = TerrainForm::static_trees;
  r.staticLod.errorPx = Pixels{4};
  r.method = CullingCase::view_frustum;
  compareWithLeavingOut(r, 24);
}

TEST_F(NodePass, withoutCullingIsThePictureWithoutCulling) {
  use(test::syntheticMountains());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0.15, 0.85), unit(0, 1);
  for (int i = 0; i < 8; ++i) {
    auto r = request(over(place(random), place(random), 60 + 1500 * unit(random)),
                     {Degrees{360 * unit(random)}, Degrees{-50 * unit(random)}, Degrees{360 * unit(random)}});
    r.decision.depthMap = DepthMapSize{320, 240};
    picture(r);
    const auto unculled = renderer.readNodes(true);
    r.method = CullingCase::none;
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

class ErrorMeter : public SceneTest {
 protected:
  void SetUp() override {
    SceneTest::SetUp();
    if (offscreen) {
      ASSERT_TRUE(meter.initialize().usable);
    }
  }
  void TearDown() override {
    if (offscreen) meter.release();
    SceneTest::TearDown();
  }
  void measureOver(std::shared_ptr<const terrain::Database> terrain) {
    use(terrain);
    meter.setTerrain(std::move(terrain));
  }

  /// Low in the mountains, where much is hidden.
  scene::FrameRequest lowRequest(double heading = 30) const {
    auto r = request(over(0.45, 0.4, 130), {Degrees{heading}, Degrees{-5}, Degrees{}});
    r.decision.depthMap = DepthMapSize{320, 240};
    return r;
  }
  /// A view along a flight of views that look anywhere, most of them low.
  scene::FrameRequest anyRequest(std::mt19937& random) const {
    std::uniform_real_distribution<double> place(0.15, 0.85), unit(0, 1);
    const double above = 60 * std::pow(80.0, std::pow(unit(random), 2.0)), east = place(random);
    auto r = request(over(east, place(random), above),
                     {Degrees{360 * unit(random)}, Degrees{-25 + 30 * unit(random)},
                      Degrees{unit(random) < 0.3 ? 360 * unit(random) : 0}});
    r.decision.depthMap = DepthMapSize{320, 240};
    return r;
  }
  FrameError measure(const scene::FrameRequest& r, const scene::FrameRequest* before = nullptr,
                     scene::ErrorPictures* pictures = nullptr) {
    return meter.measure(r, before, pictures);
  }

  /// Largest error of views at an error bound, as a share of what geometricBound allows.
  void staysWithinTheBound(double boundPx, double lodScale, TerrainForm form, int views) {
    std::mt19937 random(3);
    double largest = 0, share = 0;
    for (int i = 0; i < views; ++i) {
      auto r = anyRequest(random);
      r.lod.screenSpaceError = r.staticLod.errorPx = Pixels{boundPx};
      r.staticLod.terrain = form;
      r.staticLod.error = ErrorMeasure::maximum;
      r.decision.lodScale = lodScale;
      const FrameError error = measure(r);
      EXPECT_EQ(error.wronglyCulledPixels, 0u) << "view " << i;
      EXPECT_LE(error.geometricMaxPx, scene::geometricBoundPx(r)) << "view " << i;
      largest = std::max(largest, error.geometricMaxPx);
      share = std::max(share, error.geometricMaxPx / scene::geometricBoundPx(r));
    }
    std::printf("at %g px x %g: largest %.2f px, %.0f %% of the bound\n", boundPx, lodScale, largest,
                100 * share);
  }

  scene::ErrorMeter meter;
};

TEST_F(ErrorMeter, theReferencesPictureIsTheUnculledOne) {
  measureOver(test::syntheticMountains());
  std::mt19937 random(11);
  for (int i = 0; i < 16; ++i) {
    auto r = scene::referenceOf(anyRequest(random));
    scene::FrameResult frustum, none;
    const auto culled = picture(r, &frustum);
    r.method = CullingCase::none;
    EXPECT_EQ(differing(culled, picture(r, &none)), 0u) << "view " << i;
    EXPECT_LT(frustum.visible.tiles.size(), none.visible.tiles.size());
    for (const TileDraw& tile : none.visible.tiles) ASSERT_EQ(database->index().level[tile.node], 0);
  }
}

TEST_F(ErrorMeter, theReferencesPictureIsTheUnculledOneOverRealTerrains) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  use(bakeShared("dem-srtm3-everest"));
  ASSERT_TRUE(database);
  std::mt19937 random(12);
  for (int i = 0; i < 6; ++i) {
    auto r = scene::referenceOf(anyRequest(random));
    const auto culled = picture(r);
    r.method = CullingCase::none;
    EXPECT_EQ(differing(culled, picture(r)), 0u) << "view " << i;
  }
}

TEST_F(ErrorMeter, findsNothingWhereNothingIsLost) {
  measureOver(test::syntheticMountains());
  auto r = lowRequest(), before = lowRequest(29.5);
  for (auto* frame : {&r, &before}) frame->lod.screenSpaceError = Pixels{1e-6};
  before.time = -1.0 / 60;
  for (const CullingCase method : {CullingCase::none, CullingCase::view_frustum, CullingCase::proposed}) {
    r.method = before.method = method;
    scene::ErrorPictures pictures;
    const FrameError error = measure(r, &before, &pictures);
    EXPECT_EQ(error.wronglyCulledPixels, 0u);
    EXPECT_EQ(error.geometricMaxPx, 0);
    EXPECT_EQ(error.geometricMeanPx, 0);
    EXPECT_TRUE(std::isinf(error.psnrDb));
    EXPECT_EQ(error.ssim, 1);
    EXPECT_EQ(error.flip, 0);
    EXPECT_EQ(error.pop, 0);
    EXPECT_EQ(pictures.ours, pictures.reference);
    EXPECT_EQ(pictures.ours, picture(r));
    EXPECT_EQ(pictures.flip.size(), static_cast<std::size_t>(kWidth * kHeight));
    EXPECT_EQ(pictures.drawn.visible.occluded > 0, method == CullingCase::proposed);
    EXPECT_EQ(pictures.drawnReference.visible.occluded, 0u);
  }
}

TEST_F(ErrorMeter, sharesWhatWasDrawnAndOwnsNothing) {
  measureOver(test::syntheticMountains());
  auto r = lowRequest();
  r.method = CullingCase::view_frustum;
  const double share = measure(r).hiddenDrawnShare;
  // Counted by leaving each out: it owns nothing if that changes nothing.
  scene::FrameResult result;
  const auto whole = picture(r, &result);
  std::size_t hidden = 0;
  for (const TileDraw& tile : result.visible.tiles) {
    renderer.plant({.culledNode = tile.node});
    hidden += differing(whole, picture(r)) == 0;
  }
  renderer.plant({});
  EXPECT_GT(hidden, 5u);
  EXPECT_EQ(share, static_cast<double>(hidden) / static_cast<double>(result.visible.tiles.size()));
  r.method = CullingCase::proposed;
  EXPECT_LT(measure(r).hiddenDrawnShare, share) << "what the depth map is for";
  r.eye.height = r.eye.height + Metres{20000};
  r.attitude.pitch = Degrees{60};
  r.method = CullingCase::view_frustum;
  EXPECT_TRUE(std::isnan(measure(r).hiddenDrawnShare)) << "nothing but sky: no share of it";
}

TEST_F(ErrorMeter, geometricErrorStaysWithinWhatTheLevelsPromise) {
  measureOver(test::syntheticMountains());
  for (const double bound : {2.0, 8.0}) staysWithinTheBound(bound, 1, TerrainForm::levels, 10);
  staysWithinTheBound(2, 4, TerrainForm::levels, 10);
}

TEST_F(ErrorMeter, geometricErrorStaysWithinWhatTheLevelsPromiseOverKansai) {
  TRIMTAB_NEEDS_SHARED("data/fg-kansai-e135n35");
  measureOver(bakeShared("fg-kansai-e135n35"));
  ASSERT_TRUE(database);
  staysWithinTheBound(2, 1, TerrainForm::levels, 8);
  staysWithinTheBound(4, 1, TerrainForm::static_trees, 8);
}

TEST_F(ErrorMeter, aCoarserPictureIsFartherFromTheReference) {
  measureOver(test::syntheticMountains());
  auto r = lowRequest();
  FrameError last;
  for (const double bound : {2.0, 8.0, 32.0}) {
    r.lod.screenSpaceError = Pixels{bound};
    const FrameError error = measure(r);
    if (bound > 2) {
      EXPECT_GT(error.geometricMeanPx, last.geometricMeanPx);
      EXPECT_LT(error.psnrDb, last.psnrDb);
      EXPECT_LT(error.ssim, last.ssim);
      EXPECT_GT(error.flip, last.flip);
    }
    last = error;
  }
}

}  // namespace
}  // namespace trimtab
