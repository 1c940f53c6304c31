#include <algorithm>

#include "culling_truth.h"

/// No node that owns a pixel is ever left out: 25 views of each terrain and a flight over it; 1,000 with
/// TRIMTAB_SOAK=40, and then in every band.
namespace trimtab {
namespace {

using test::CullingTruth;

class CullingViews : public CullingTruth {
 protected:
  void useShared(const char* folder) {
    use(bakeShared(folder));
    ASSERT_TRUE(database);
  }
};

TEST_F(CullingViews, loseNothingOverEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  useShared("dem-srtm3-everest");
  prove(TerrainForm::levels, 13, 11);
  prove(TerrainForm::patches, 12, 12);
}

TEST_F(CullingViews, loseNothingOverTheMountainsOfBigTujunga) {
  TRIMTAB_NEEDS_SHARED("data/dem-30m-bigtujunga");
  useShared("dem-30m-bigtujunga");
  prove(TerrainForm::levels, 13, 21);
  prove(TerrainForm::patches, 12, 22);
}

TEST_F(CullingViews, loseNothingOverTheSample) {
  const test::ScratchDir dir;
  terrain::SampleOptions options;
  options.postM = 90;
  ASSERT_TRUE(terrain::writeSample(dir / "sample.tif", options));
  auto baked = terrain::openOrBake(dir / "sample.tif", dir / "cache", {});
  ASSERT_TRUE(baked) << toString(baked.findings());
  use(baked.value());
  prove(TerrainForm::levels, 13, 31);
  prove(TerrainForm::patches, 12, 32);
}

// Without this, the tests above might pass because nothing can go wrong where they look.
TEST_F(CullingViews, showWhatIsCulledWrongly) {
  use(test::syntheticMountains());
  constexpr DepthMapSize kCoarse{8, 6};
  std::vector<View> views;
  for (const auto& r : anyViews(48, 1)) views.push_back(truthOf(r, false));
  for (const OcclusionMethod method :
       {OcclusionMethod::depth_map, OcclusionMethod::cpu_map, OcclusionMethod::horizon})
    for (const double lowering : {0.0, 1.0}) {
      renderer.plant({.loweringScale = lowering});
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
    renderer.plant({.culledNode = least.first});
    Tally tally;
    compare(view, CullingCase::view_frustum, OcclusionMethod::horizon, kCoarse, tally);
    EXPECT_EQ(tally.wrongNodes, 1u);
    EXPECT_EQ(tally.wrongPixels, least.second);
    ++found;
  }
  EXPECT_GT(found, 36u);
}

}  // namespace
}  // namespace trimtab
