#include "culling_truth.h"

/// As culling_views_test.cpp, over FlightGear scenery.
namespace trimtab {
namespace {

class CullingScenery : public test::CullingTruth {
 protected:
  void proveAll(const char* folder, unsigned seed) {
    ASSERT_TRUE(useShared(folder));
    ASSERT_TRUE(database->staticLod());
    prove({{TerrainForm::tiles, 9}, {TerrainForm::patches, 8}, {TerrainForm::static_trees, 8}}, seed);
  }
};

TEST_F(CullingScenery, losesNothingOverKansai) {
  TRIMTAB_NEEDS_SHARED("data/fg-kansai-e135n35");
  proveAll("fg-kansai-e135n35", 61);
}

TEST_F(CullingScenery, losesNothingOverTheCoastOfIceland) {
  TRIMTAB_NEEDS_SHARED("data/fg-debian-iceland-reykjanes");
  proveAll("fg-debian-iceland-reykjanes", 71);
}

TEST_F(CullingScenery, losesNothingOverHawaii) {
  TRIMTAB_NEEDS_SHARED("data/fg-debian-hawaii-bigisland");
  proveAll("fg-debian-hawaii-bigisland", 81);
}

}  // namespace
}  // namespace trimtab
