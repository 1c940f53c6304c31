#include <algorithm>

#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/received_state.h"
#include "trimtab/preset/preset.h"
#include "trimtab/session/session.h"

/// What the preset `as-published` draws over scenery.
namespace trimtab {
namespace {

class AsPublished : public test::SceneTest {
 protected:
  void SetUp() override {
    SceneTest::SetUp();
    TRIMTAB_NEEDS_SHARED("data/fg-kansai-e135n35");
    if (!offscreen) return;
    ASSERT_TRUE(useShared("fg-kansai-e135n35"));
  }

  static TuningParameters preset() {
    const Result<Preset> loaded = loadPreset("as-published");
    EXPECT_TRUE(loaded) << toString(loaded.findings());
    return loaded ? loaded->parameters : TuningParameters{};
  }

  /// The request of the preset for a state alone, as if it were the first of its flight.
  FrameRequest requestAt(const AircraftState& state) const {
    Session session(*validate(preset()));
    session.setGround(database);
    session.look(state);
    FrameRequest r = *session.request(state.time, kWidth, kHeight);
    r.waitForPages = true;
    return r;
  }

  /// The mean vertices in view while the line of sight turns 180 degrees in a second and then rests for one,
  /// 200 images a second, from the end of the dwell on; over tiled levels, as document C had.
  double sweptVertices(MotionControl control) {
    constexpr int kPerS = 200, kStill = 60, kImages = kStill + 2 * kPerS, kDwell = 10, kDrawnEach = 10;
    TuningParameters parameters = preset();
    parameters.motion.control = control;
    Session session(*validate(parameters));
    session.setGround(database);
    AircraftState state;
    state.position = over(0.5, 0.5, 0);
    state.position.height =
        *database->highestWithin(state.position.latitude, state.position.longitude, Metres{2000}) +
        Feet{2000}.as<Metres>();
    double vertices = 0;
    int drawn = 0;
    for (int i = 0; i < kImages; ++i, ++state.packet) {
      state.time = double(i) / kPerS;
      const double turned = std::clamp(double(i - kStill) / kPerS, 0.0, 1.0);
      state.head = Attitude{Degrees{180 * turned}, {}, {}};
      session.receive(std::vector{ReceivedState{state, state.time, state.time}});
      FrameRequest r = *session.request(state.time, kWidth, kHeight);
      if (i < kStill + kDwell || i % kDrawnEach != 0) continue;
      r.terrain.form = TerrainForm::tiles;
      r.levers.drawn.blurStrength = 0;
      r.waitForPages = true;
      vertices += double(renderer.draw(r, offscreen->framebuffer()).visible.vertices);
      ++drawn;
    }
    return vertices / drawn;
  }
};

TEST_F(AsPublished, testsStaticTreesAndLeavesOutWhatIsHiddenWithoutAPixelChanged) {
  const Result<Flight> flight = readFlight(test::sourceDir() / "resources/flights/kansai-valley.csv");
  ASSERT_TRUE(flight) << toString(flight.findings());
  constexpr int kViews = 12;
  int dynamic = 0, tested = 0;
  std::size_t hidden = 0;
  for (int i = 0; i < kViews; ++i) {
    const double part = (i + 0.5) / kViews;
    FrameRequest r = requestAt(stateAt(*flight, flight->beginS() + part * flight->durationS()));
    dynamic += r.levers.drawn.occlusion.has_value();
    FrameResult whole, culled;
    r.cullingCase = CullingCase::none;
    const auto unculled = picture(r, &whole);
    ASSERT_TRUE(whole.staticLod.drawn);
    r.cullingCase = CullingCase::proposed;
    EXPECT_EQ(differing(unculled, picture(r, &culled)), 0u) << "view " << i;
    tested += culled.depthMap.has_value();
    hidden += culled.visible.occluded;
  }
  EXPECT_GT(dynamic, 0);
  EXPECT_EQ(tested, dynamic) << "what is published runs wherever the scheme is dynamic";
  EXPECT_GT(hidden, 0u);
  std::printf("%d views, %d dynamic, %d tested: %zu nodes hidden\n", kViews, dynamic, tested, hidden);
}

TEST_F(AsPublished, drawsThePublishedShareOfVerticesWhileTheHeadTurns) {
  const double before = sweptVertices(MotionControl::off),
               coarser = sweptVertices(MotionControl::lod_scale_and_blur) / before,
               restored = sweptVertices(MotionControl::with_restoration) / before;
  std::printf("%.0f vertices before; %.3f of them with the mechanism, %.3f with restoration\n", before,
              coarser, restored);
  EXPECT_NEAR(coarser, 31000.0 / 44000, 0.05) << "document C, Figure 10";
  EXPECT_NEAR(restored, 36000.0 / 44000, 0.05);
}

}  // namespace
}  // namespace trimtab
