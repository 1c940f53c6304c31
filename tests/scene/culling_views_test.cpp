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

}  // namespace
}  // namespace trimtab
