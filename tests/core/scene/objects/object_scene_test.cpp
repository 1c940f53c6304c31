#include "objects_on.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/patched_terrain.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "trimtab/culling/select_objects.h"
#include "trimtab/scene/node_description.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::test {
namespace {

class ObjectScene : public SceneTest {
 protected:
  /// Mountains with so many cones on them.
  void plant(int count, int side = 24) {
    const std::shared_ptr<const terrain::Database> ground = patchedMountains(true);
    use(std::make_shared<const ObjectsOn>(ground, scattered(*ground, count, 7, side, 6)));
  }
  FrameRequest proposed(FrameRequest r, OcclusionMethod method = OcclusionMethod::horizon) const {
    r.cullingCase = CullingCase::proposed;
    r.occlusion = method;
    r.levers.drawn.occlusion = OcclusionResolution{640, 480};
    return r;
  }
};

TEST_F(ObjectScene, cullingChangesNoPixelInAnyForm) {
  plant(40000);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const TerrainForm form : {TerrainForm::patches, TerrainForm::tiles}) {
    std::uint64_t occluded = 0, behindMap = 0, inView = 0;
    std::size_t ofObjects = 0;
    const int views = 25 * soak();
    for (int i = 0; i < views; ++i) {
      const double aboveM = 30 * std::pow(60, std::pow(unit(random), 2.0));
      FrameRequest r = request(
          over(0.15 + 0.7 * unit(random), 0.15 + 0.7 * unit(random), aboveM),
          {Degrees{360 * unit(random)}, Degrees{-15 + 20 * unit(random)}, Degrees{60 * unit(random) - 30}});
      r.terrain.form = form;
      r.levers.drawn.errorPx = 1 + 3 * unit(random);
      r.cullingCase = CullingCase::none;
      FrameResult whole, frustum, horizon, map;
      const auto truth = picture(r, &whole);
      ASSERT_EQ(whole.objects.drawn, 40000u);
      r.cullingCase = CullingCase::view_frustum;
      ASSERT_EQ(differing(truth, picture(r, &frustum)), 0u) << "view " << i;
      ASSERT_EQ(differing(truth, picture(proposed(r), &horizon)), 0u) << "view " << i;
      ASSERT_EQ(differing(truth, picture(proposed(r, OcclusionMethod::depth_map), &map)), 0u) << "view " << i;
      EXPECT_EQ(map.objects.all(), 40000u);
      EXPECT_EQ(horizon.objects.all(), 40000u);
      EXPECT_LE(horizon.objects.drawn, frustum.objects.drawn);
      occluded += frustum.objects.drawn - horizon.objects.drawn;
      behindMap += frustum.objects.drawn - map.objects.drawn;
      inView += frustum.objects.drawn;
      if (i < 5) {
        const auto objects = std::exchange(database, patchedMountains(true));
        renderer.setTerrain(database);
        ofObjects += differing(truth, picture(r));
        use(objects);
      }
    }
    std::printf(
        "%s: of %llu instances in view the horizon hid %llu and the depth map %llu, %zu pixels were "
        "of objects\n",
        form == TerrainForm::patches ? "patches" : "tiles", static_cast<unsigned long long>(inView),
        static_cast<unsigned long long>(occluded), static_cast<unsigned long long>(behindMap), ofObjects);
    EXPECT_GT(ofObjects, 1000u) << "the test would see nothing";
    EXPECT_GT(occluded * 4, inView);
    EXPECT_GT(behindMap * 8, inView);
  }
}

TEST_F(ObjectScene, aDepthMapThatIsReadBesideItsPlaceLosesObjects) {
  plant(40000);
  std::size_t right = 0, lost = 0;
  for (int i = 0; i < 12; ++i) {
    // Rolled, so that a shift to the side is one over a ridge.
    const double east = 0.2 + 0.1 * (i % 6), north = 0.25 + 0.3 * (i / 6);
    FrameRequest r = proposed(request(over(east, north, 60), {Degrees{-2}, Degrees{0}, Degrees{100.0 * i}}),
                              OcclusionMethod::depth_map);
    r.terrain.form = TerrainForm::tiles;
    const auto objectsOf = [&](int shiftTexels) {
      scene::plant(renderer, {.depthMapShiftTexels = shiftTexels});
      FrameResult result;
      picture(r, &result);
      return renderer.readObjects();
    };
    const auto truth = objectsOf(0), shifted = objectsOf(i % 2 == 0 ? 100 : -100);
    scene::plant(renderer, {});
    for (std::size_t pixel = 0; pixel < truth.size(); ++pixel) {
      // Tiles that are lost as well show more objects, never fewer.
      if (truth[pixel] == scene::Renderer::kNoNode) continue;
      ++right;
      lost += shifted[pixel] == scene::Renderer::kNoNode;
    }
  }
  EXPECT_GT(right, 1000u);
  EXPECT_GT(lost, 10u);
}

TEST_F(ObjectScene, aRestingEyeSelectsAgainOnlyIfTheFlagsOfTheCellsChange) {
  plant(40000);
  FrameRequest r = proposed(request(over(0.45, 0.4, 60), {Degrees{30}, Degrees{-2}, Degrees{0}}));
  r.terrain.form = TerrainForm::tiles;
  const auto drawnBy = [&](OcclusionMethod method) {
    FrameResult result;
    picture(proposed(r, method), &result);
    return result.objects.drawn;
  };
  const auto horizon = drawnBy(OcclusionMethod::horizon), map = drawnBy(OcclusionMethod::depth_map);
  ASSERT_NE(horizon, map) << "the test would see nothing";
  EXPECT_EQ(drawnBy(OcclusionMethod::depth_map), map);
  EXPECT_EQ(drawnBy(OcclusionMethod::horizon), horizon);
}

TEST_F(ObjectScene, eachPixelOfAnObjectIsWithinItsSphereAndTheOthersShowNone) {
  plant(20000);
  const auto objects = database->objects();
  for (const TerrainForm form : {TerrainForm::patches, TerrainForm::tiles}) {
    FrameRequest r = proposed(request(over(0.4, 0.45, 300), {Degrees{-12}, Degrees{5}, Degrees{70}}));
    r.terrain.form = form;
    r.levers.drawn.errorPx = 1;
    const auto with = picture(r);
    const auto shown = renderer.readObjects();
    const auto distances = renderer.readDistances();
    ASSERT_EQ(picture(r), with) << "reading changes no image";
    FrameRequest bare = r;
    bare.levers.drawn.objectFarM = 0;
    const auto without = picture(bare);
    const EyePose eye{objects->index.frame.fromGeodetic(r.eye),
                      eyeAxes(objects->index.frame, r.eye, r.attitude)};
    std::size_t ofObjects = 0, different = 0;
    std::optional<std::uint32_t> some;
    ASSERT_EQ(shown.size(), static_cast<std::size_t>(r.view.widthPx * r.view.heightPx));
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (shown[i] == scene::Renderer::kNoNode) {
        different += !std::equal(with.begin() + 4 * i, with.begin() + 4 * i + 4, without.begin() + 4 * i);
        continue;
      }
      ++ofObjects;
      some = shown[i];
      ASSERT_LT(shown[i], objects->index.instances.size());
      const auto x = static_cast<double>(i % static_cast<std::size_t>(r.view.widthPx)) + 0.5,
                 y = static_cast<double>(i / static_cast<std::size_t>(r.view.widthPx)) + 0.5;
      const Vec3 ray{r.view.left + (r.view.right - r.view.left) * x / r.view.widthPx,
                     r.view.bottom + (r.view.top - r.view.bottom) * y / r.view.heightPx, -1};
      const Vec3 seen = eye.position + transposed(eye.axes) * (normalized(ray) * double{distances[i]});
      const ObjectInstance& instance = objects->index.instances[shown[i]];
      const double radius = double{objects->index.models[instance.model].radiusM} * instance.scale;
      ASSERT_LT(length(seen - placeOfObject(objects->index, shown[i])),
                radius + 1e-3 * double{distances[i]} + 0.1);
    }
    EXPECT_EQ(different, 0u);
    EXPECT_GT(ofObjects, 2000u);
    ASSERT_TRUE(some);
    const auto described = scene::describeObject(*some, *database, r);
    ASSERT_TRUE(described);
    EXPECT_EQ(described->form, "object");
    EXPECT_EQ(described->model, objects->names[objects->index.instances[*some].model]);
    EXPECT_LE(described->errorPx, 1.001);
    EXPECT_GT(described->widthPx, 0);
  }
  EXPECT_FALSE(scene::describeObject(20000, *database, request(over(0.4, 0.45, 300), {})));
  database = patchedMountains(true);
  renderer.setTerrain(database);
  picture(request(over(0.4, 0.45, 300), {}));
  for (const std::uint32_t object : renderer.readObjects()) ASSERT_EQ(object, scene::Renderer::kNoNode);
}

}  // namespace
}  // namespace trimtab::test
