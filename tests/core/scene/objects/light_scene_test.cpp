#include "objects_on.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/patched_terrain.h"

#include <cmath>

#include "core/scene/gl/stage_clock.h"
#include "core/scene/objects/light_drawer.h"
#include "trimtab/scene/gl_objects.h"

namespace trimtab::test {
namespace {

std::shared_ptr<terrain::ObjectTerrain> litBy(const LocalFrame& frame, const std::vector<Vec3>& places) {
  auto made = std::make_shared<terrain::ObjectTerrain>();
  made->index.frame = frame;
  addLights(*made, places);
  return made;
}

class LightScene : public SceneTest {
 protected:
  void SetUp() override {
    SceneTest::SetUp();
    if (IsSkipped()) return;
    ground = patchedMountains(true);
    use(ground);
  }
  LocalFrame frame() const { return ground->index().frame; }
  void light(const std::vector<Vec3>& places) {
    use(std::make_shared<const ObjectsOn>(ground, litBy(frame(), places)));
  }
  /// Returns a place before the eye by its pixel and its distance along the view's axis.
  Vec3 before(const FrameRequest& r, double x, double y, double ahead) const {
    const ViewShape& v = r.view;
    const Vec3 ray{v.left + (v.right - v.left) * x / v.widthPx,
                   v.bottom + (v.top - v.bottom) * y / v.heightPx, -1};
    return frame().fromGeodetic(r.eye) + transposed(eyeAxes(frame(), r.eye, r.attitude)) * (ray * ahead);
  }
  std::shared_ptr<const terrain::Database> ground;
};

TEST_F(LightScene, ofSizeZeroAreNotThere) {
  FrameRequest r = request(over(0.4, 0.45, 300), {Degrees{70}, Degrees{-12}, Degrees{0}});
  const auto bare = picture(r);
  const auto objects = scene::glObjectsOfContext();
  light({before(r, 320, 180, 200), before(r, 100, 100, 100)});
  EXPECT_EQ(differing(bare, picture(r)), 0u);
  const auto unlit = scene::glObjectsOfContext();
  EXPECT_EQ(unlit.buffers, objects.buffers) << "nothing is uploaded";
  EXPECT_EQ(unlit.vertexArrays, objects.vertexArrays);
  r.lightPx = 3;
  EXPECT_GT(differing(bare, picture(r)), 5u);
  const auto lit = scene::glObjectsOfContext();
  EXPECT_EQ(lit.buffers, objects.buffers + 1);
  EXPECT_EQ(lit.vertexArrays, objects.vertexArrays + 1);
  r.lightPx = 0;
  EXPECT_EQ(differing(bare, picture(r)), 0u);
  use(ground);
  r.lightPx = 3;
  EXPECT_EQ(differing(bare, picture(r)), 0u);
  EXPECT_EQ(scene::glObjectsOfContext().buffers, objects.buffers) << "they are given back";
}

TEST_F(LightScene, coversTheSameDiscOfPixelsFromNearAndFar) {
  FrameRequest r = request(over(0.4, 0.45, 3000), {Degrees{70}, Degrees{25}, Degrees{20}});  // the sky
  const auto bare = picture(r);
  for (const double size : {3.0, 8.5})
    for (const double scale : {1.0, 0.5})
      for (const double ahead : {40.0, 9000.0}) {
        r.lightPx = size;
        r.levers.drawn.renderScale = scale;
        FrameRequest dark = r;
        dark.lightPx = 0;
        const auto without = scale == 1 ? bare : picture(dark);
        const double cx = 211.3, cy = 140.8;
        light({before(r, cx, cy, ahead)});
        const auto with = picture(r);
        std::size_t inside = 0;
        for (int y = 0; y < kHeight; ++y)
          for (int x = 0; x < kWidth; ++x) {
            const std::size_t i = 4 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x));
            const bool differs = !std::equal(with.begin() + i, with.begin() + i + 4, without.begin() + i);
            const double away = std::hypot(x + 0.5 - cx, y + 0.5 - cy) - size / 2;
            inside += differs;
            // Scaled up, a pixel of the scene is two of the image, and mixes with its neighbours.
            const double slack = scale == 1 ? 0.05 : 3;
            if (std::abs(away) < slack) continue;
            ASSERT_EQ(differs, away < 0) << x << ", " << y << " at " << ahead << " m, size " << size;
          }
        EXPECT_GT(inside, size * size / 2) << ahead;
      }
}

TEST_F(LightScene, isHiddenByAHillAndCutByFog) {
  FrameRequest r = request(over(0.4, 0.45, 30), {Degrees{70}, Degrees{-4}, Degrees{0}});
  r.lightPx = 5;
  const auto distances = [&] {
    picture(r);
    return renderer.readDistances();
  }();
  // A pixel of ground that is some way off: a light before it, and one behind it.
  int x = 0, y = 0;
  double away = 0;
  for (int row = 20; row < kHeight && away < 500; ++row) {
    x = kWidth / 2, y = row;
    away =
        static_cast<double>(distances[static_cast<std::size_t>(row) * kWidth + static_cast<std::size_t>(x)]);
  }
  ASSERT_GT(away, 500);
  ASSERT_LT(away, 30000);
  const auto bare = picture(r);
  light({before(r, x + 0.5, y + 0.5, 0.5 * away)});
  EXPECT_GT(differing(bare, picture(r)), 12u);
  light({before(r, x + 0.5, y + 0.5, 1.5 * away)});
  EXPECT_EQ(differing(bare, picture(r)), 0u);
  light({before(r, x + 0.5, y + 0.5, 0.5 * away)});
  r.levers.drawn.farM = 0.4 * away;
  r.decision.weather.visibilityM = 0.4 * away;
  FrameRequest dark = r;
  dark.lightPx = 0;
  EXPECT_EQ(differing(picture(dark), picture(r)), 0u) << "it is beyond what can be seen";
}

TEST_F(LightScene, cullingChangesNoPixelAtTheEdgesOfTheImage) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t shown = 0;
  for (int n = 0; n < 50 * soak(); ++n) {
    FrameRequest r = request(
        over(0.2 + 0.6 * unit(random), 0.2 + 0.6 * unit(random), 50 + 800 * unit(random)),
        {Degrees{360 * unit(random)}, Degrees{-20 + 30 * unit(random)}, Degrees{60 * unit(random) - 30}});
    r.lightPx = 1 + 12 * unit(random);
    if (n % 3 == 0) r.levers.drawn.renderScale = 0.6;
    // Lights on all four edges, a few pixels in or out.
    std::vector<Vec3> places;
    for (int i = 0; i < 80; ++i) {
      const double along = unit(random), beside = 20 * unit(random) - 10,
                   ahead = 5 + 2000 * std::pow(unit(random), 3.0);
      const bool upright = i % 2 == 0, end = i % 4 < 2;
      const double edge = (end ? (upright ? kWidth : kHeight) : 0) + beside;
      places.push_back(upright ? before(r, edge, along * kHeight, ahead)
                               : before(r, along * kWidth, edge, ahead));
    }
    light(places);
    r.cullingCase = CullingCase::none;
    const auto truth = picture(r);
    r.cullingCase = CullingCase::proposed;
    r.occlusion = OcclusionMethod::horizon;
    r.levers.drawn.occlusion = OcclusionResolution{640, 480};
    ASSERT_EQ(differing(truth, picture(r)), 0u) << "view " << n;
    r.lightPx = 0;
    shown += differing(truth, picture(r));
  }
  EXPECT_GT(shown, 5000u) << "the test would see nothing";
}

TEST_F(LightScene, isWholeOnGroundThatIsSeenUnderAGrazingAngle) {
  // Half a metre above the ground, on slopes seen from 40 m above: without help the ground just before a
  // light is nearer than it, and cuts the lower half of its disc.
  std::size_t whole = 0, cut = 0;
  FrameRequest r = request(over(0.4, 0.45, 40), {Degrees{70}, Degrees{-6}, Degrees{0}});
  r.lightPx = 5;
  FrameRequest dark = r;
  dark.lightPx = 0;
  use(ground);
  const auto bare = picture(dark);
  const auto distances = renderer.readDistances();
  for (int x = 20; x < kWidth - 20; x += 40)
    for (int y = 20; y < kHeight - 20; y += 20) {
      const float seen = distances[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
      if (!(seen > 100 && seen < 3000)) continue;
      const ViewShape& v = r.view;
      const double tx = v.left + (v.right - v.left) * (x + 0.5) / v.widthPx,
                   ty = v.bottom + (v.top - v.bottom) * (y + 0.5) / v.heightPx;
      light({before(r, x + 0.5, y + 0.5, double{seen} / std::sqrt(1 + tx * tx + ty * ty)) + Vec3{0, 0, 0.5}});
      const std::size_t pixels = differing(bare, picture(r));
      (pixels >= 17 ? whole : cut) += 1;
    }
  std::printf("%zu discs are whole, %zu are cut\n", whole, cut);
  EXPECT_GT(whole, 20u);
  EXPECT_GT(whole, 4 * cut) << "the others are at ridges, which hide part of a light behind them";
}

TEST_F(LightScene, isSelectedAnewOnlyIfSomethingChanged) {
  FrameRequest r = request(over(0.4, 0.45, 300), {Degrees{70}, Degrees{-12}, Degrees{0}});
  const auto objects = litBy(frame(), {before(r, 320, 180, 200)});
  scene::LightDrawer drawer;
  drawer.setTerrain(objects);
  scene::StageClock clock;
  clock.start(true, false, false);
  const auto prepared = [&] {
    const EyePose eye{frame().fromGeodetic(r.eye), eyeAxes(frame(), r.eye, r.attitude)};
    return drawer.prepare({r, eye, r.view, 1, clock, true});
  };
  EXPECT_FALSE(prepared()) << "nothing is done by day";
  EXPECT_FALSE(drawer.drawsAny());
  r.lightPx = 3;
  EXPECT_TRUE(prepared());
  EXPECT_TRUE(drawer.drawsAny());
  EXPECT_FALSE(prepared());
  r.attitude.heading = Degrees{250};
  EXPECT_TRUE(prepared());
  EXPECT_FALSE(drawer.drawsAny());
  EXPECT_FALSE(prepared());
  r.skips.sameVisible = false;
  EXPECT_TRUE(prepared());
  drawer.release();
}

}  // namespace
}  // namespace trimtab::test
