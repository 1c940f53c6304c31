#include "objects_on.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/patched_terrain.h"

#include <chrono>
#include <cstdio>

namespace trimtab::test {
namespace {

class ObjectScene : public SceneTest {
 protected:
  /// Mountains with so many cones on them.
  void plant(int count, int side = 24) {
    const std::shared_ptr<const terrain::Database> ground = patchedMountains(true);
    use(std::make_shared<const ObjectsOn>(ground, scattered(*ground, count, 7, side, 6)));
  }
  FrameRequest proposed(FrameRequest r) const {
    r.cullingCase = CullingCase::proposed;
    r.occlusion = OcclusionMethod::horizon;
    r.levers.drawn.occlusion = OcclusionResolution{640, 480};
    return r;
  }
};

TEST_F(ObjectScene, cullingChangesNoPixelInAnyForm) {
  plant(40000);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const TerrainForm form : {TerrainForm::patches, TerrainForm::tiles}) {
    std::uint64_t occluded = 0, inView = 0;
    std::size_t ofObjects = 0;
    const int views = 25 * soak();
    for (int i = 0; i < views; ++i) {
      const double aboveM = 30 * std::pow(60, std::pow(unit(random), 2.0));
      FrameRequest r = request(
          over(0.15 + 0.7 * unit(random), 0.15 + 0.7 * unit(random), aboveM),
          {Degrees{-15 + 20 * unit(random)}, Degrees{60 * unit(random) - 30}, Degrees{360 * unit(random)}});
      r.terrain.form = form;
      r.levers.drawn.errorPx = 1 + 3 * unit(random);
      r.cullingCase = CullingCase::none;
      FrameResult whole, frustum, horizon;
      const auto truth = picture(r, &whole);
      ASSERT_EQ(whole.objects.drawn, 40000u);
      r.cullingCase = CullingCase::view_frustum;
      ASSERT_EQ(differing(truth, picture(r, &frustum)), 0u) << "view " << i;
      ASSERT_EQ(differing(truth, picture(proposed(r), &horizon)), 0u) << "view " << i;
      EXPECT_EQ(horizon.objects.all(), 40000u);
      EXPECT_LE(horizon.objects.drawn, frustum.objects.drawn);
      occluded += frustum.objects.drawn - horizon.objects.drawn;
      inView += frustum.objects.drawn;
      if (i < 5) {
        const auto objects = std::exchange(database, patchedMountains(true));
        renderer.setTerrain(database);
        ofObjects += differing(truth, picture(r));
        use(objects);
      }
    }
    std::printf("%s: %llu of %llu instances in view were hidden, %zu pixels were of objects\n",
                form == TerrainForm::patches ? "patches" : "tiles", static_cast<unsigned long long>(occluded),
                static_cast<unsigned long long>(inView), ofObjects);
    EXPECT_GT(ofObjects, 1000u) << "the test would see nothing";
    EXPECT_GT(occluded * 4, inView);
  }
}

}  // namespace
}  // namespace trimtab::test
