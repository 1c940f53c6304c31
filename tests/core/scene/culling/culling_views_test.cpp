#include "culling_truth.h"

/// No node that owns a pixel is ever left out: 25 views of each terrain and a flight over it; 1,000 with
/// TRIMTAB_SOAK=40, and then in every band. TRIMTAB_SHARD=0/2 and 1/2 share them between two processes.
namespace trimtab {
namespace {

using CullingViews = test::CullingTruth;

TEST_F(CullingViews, loseNothingOverEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  ASSERT_TRUE(useShared("dem-srtm3-everest"));
  prove({{TerrainForm::tiles, 13}, {TerrainForm::patches, 12}}, 11);
}

TEST_F(CullingViews, loseNothingOverTheMountainsOfBigTujunga) {
  TRIMTAB_NEEDS_SHARED("data/dem-30m-bigtujunga");
  ASSERT_TRUE(useShared("dem-30m-bigtujunga"));
  prove({{TerrainForm::tiles, 13}, {TerrainForm::patches, 12}}, 21);
}

TEST_F(CullingViews, loseNothingOverTheSample) {
  ASSERT_TRUE(useSample());
  prove({{TerrainForm::tiles, 13}, {TerrainForm::patches, 12}}, 31);
}

}  // namespace
}  // namespace trimtab
