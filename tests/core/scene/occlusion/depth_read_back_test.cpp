#include "core/scene/occlusion/depth_read_back.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"

#include <random>
#include <set>

#include "tests/core/scene/culling/culling_flight.h"
#include "trimtab/host/flight.h"
#include "trimtab/scene/renderer.h"

namespace trimtab {
namespace {

class ReadBackScene : public test::CullingFlight {
 protected:
  ReadBackScene() : CullingFlight(OcclusionMethod::read_back, 15) {}
  void TearDown() override {
    scene::DepthReadBack::force({});
    CullingFlight::TearDown();
  }

  struct Flight {
    std::size_t wrong = 0;  ///< nodes that show a pixel and were not drawn
    std::size_t differing = 0, hidden = 0, frustum = 0;
    int served = 0, cuts = 0;
  };
  std::size_t missing(const FrameResult& result) {
    std::set<std::uint32_t> drawn, shown;
    for (const TileDraw& tile : result.visible.tiles) drawn.insert(tile.node);
    for (const std::uint32_t node : renderer.readNodes(true))
      if (node != scene::Renderer::kNoNode && drawn.count(node) == 0) shown.insert(node);
    return shown.size();
  }
  /// Straight up from low places, 40 m a frame: nodes that show a pixel and were not drawn.
  std::size_t climb() {
    std::size_t wrong = 0, hidden = 0;
    for (int place = 0; place < 4; ++place)
      for (int i = 0; i < 10; ++i) {
        auto r = request(over(0.3 + 0.1 * place, 0.65 - 0.1 * place, 30 + 40 * i),
                         {Degrees{50.0 * place}, Degrees{-4}, {}});
        r.lod.screenSpaceError = Pixels{0.5};
        r.decision.depthMap = DepthMapSize{640, 480};
        r.occlusion = OcclusionMethod::read_back;
        FrameResult result;
        picture(r, &result);
        wrong += missing(result);
        hidden += result.visible.occluded;
      }
    std::printf("climbing: %zu hidden, %zu wrong\n", hidden, wrong);
    return wrong;
  }
  /// 600 knots, a head that turns at 200 degrees a second to and fro, and every so often another place.
  Flight flyOn(int frames, unsigned seed, DepthMapSize size, double pixels = 0.5) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0.25, 0.75), unit(0, 1);
    constexpr double kStep = 1 / 60.0, kSpeed = 308.7, kTurn = 200;
    Flight tally;
    double east = 0, north = 0, course = 0, heading = 0, above = 0, height = 0;
    std::uint64_t cuts = 0;
    const double degreesNorth = kSpeed * kStep / 111e3;
    for (int i = 0; i < frames; ++i) {
      if (i % 25 == 0) {
        east = place(random), north = place(random), course = 360 * unit(random), heading = course;
        above = 40 + 260 * unit(random);
        height = over(east, north, above).height.value();
      }
      const auto& info = database->info();
      const double wide = scene::widthOf(info).value(),
                   high = (info.northEast.latitude - info.southWest.latitude).value();
      const double radians = course * 3.14159265 / 180;
      north += degreesNorth * std::cos(radians) / high;
      east += degreesNorth * std::sin(radians) / 0.8 / wide;
      // Straight on for a while, turning for a while, both in the end; along the ground, up and down.
      heading += i % 25 < 8 ? 0 : kTurn * kStep * (i % 50 < 25 ? 1 : -1);
      height += std::clamp(over(east, north, above).height.value() - height, -3.0, 3.0);
      auto eye = over(east, north, 0);
      eye.height = Metres{std::max(eye.height.value() + 15, height)};
      auto r = request(eye, {Degrees{heading}, Degrees{-6}, Degrees{i % 3 == 0 ? 10.0 : 0.0}});
      r.lod.screenSpaceError = Pixels{pixels};
      r.decision.depthMap = size;
      r.occlusion = OcclusionMethod::read_back;
      FrameResult result;
      const auto drawn = picture(r, &result);
      tally.wrong += missing(result);
      tally.hidden += result.visible.occluded;
      tally.served += result.visible.occluded > 0;
      tally.frustum += result.visible.tiles.size() + result.visible.occluded;
      tally.cuts += result.cutsSelected != cuts;
      cuts = result.cutsSelected;
      r.method = CullingCase::none;
      tally.differing += differing(drawn, picture(r));
    }
    std::printf("%d frames: %zu tiles in view, %zu hidden in %d frames, %zu wrong, %zu pixels differ\n",
                frames, tally.frustum, tally.hidden, tally.served, tally.wrong, tally.differing);
    return tally;
  }
};

TEST_F(ReadBackScene, leavesNoPixelOutAtOnce) {
  use(test::syntheticMountains());
  const Tally tally = fly(24, 1);
  EXPECT_EQ(tally.differing, 0u);
  EXPECT_GT(tally.served, 18);
  EXPECT_LT(tally.proposed * 10, tally.frustum * 9) << "it hides hardly anything";
}

class ReadBackLag : public ReadBackScene, public testing::WithParamInterface<int> {};

TEST_P(ReadBackLag, leavesNothingOutThatTheEyeOfNowSees) {
  use(test::syntheticMountains());
  scene::DepthReadBack::force({.lag = GetParam()});
  const Flight flight = flyOn(75 * test::soak(), 11, {640, 480});
  EXPECT_EQ(flight.wrong, 0u);
  EXPECT_EQ(flight.differing, 0u);
  EXPECT_GT(flight.served, 15) << "maps that come late serve hardly ever";
  EXPECT_GT(flight.hidden * 20, flight.frustum) << "they hide hardly anything";
}
INSTANTIATE_TEST_SUITE_P(Frames, ReadBackLag, testing::Values(1, 2, 3));

// Without these, the test above might pass because nothing can go wrong where it looks.
TEST_F(ReadBackScene, losesWhatTheEyesMotionUncoversWhereThatIsNotAllowedFor) {
  use(test::syntheticMountains());
  scene::DepthReadBack::force({.lag = 3, .motionScale = 0});
  const std::size_t without = climb();
  scene::DepthReadBack::force({.lag = 3});
  EXPECT_GT(without, 0u);
  EXPECT_EQ(climb(), 0u);
}

TEST_F(ReadBackScene, servesWhileTheHeadTurnsAtOnePlace) {
  use(test::syntheticMountains());
  scene::DepthReadBack::force({.lag = 2});
  FrameRequest r;
  FrameResult result;
  for (int place = 0; place < 10 && result.visible.occluded < 10; ++place) {
    r = request(over(0.3 + 0.04 * place, 0.6 - 0.03 * place, 60), {Degrees{20}, Degrees{-4}, {}});
    r.decision.depthMap = DepthMapSize{640, 480};
    r.occlusion = OcclusionMethod::read_back;
    r.lod.screenSpaceError = Pixels{0.25};
    for (int i = 0; i < 5; ++i) picture(r, &result);
  }
  const std::size_t still = result.visible.occluded;
  ASSERT_GE(still, 10u) << "no place for this test";
  r.attitude.heading = Degrees{24};
  picture(r, &result);
  EXPECT_GT(result.visible.occluded * 2, still) << "what the old view shows is proven for the new one";
  r.attitude.heading = Degrees{200};
  picture(r, &result);
  EXPECT_EQ(result.visible.occluded, 0u) << "nothing of it is in the old view";
  r.attitude.heading = Degrees{24};
  r.eye.height = r.eye.height + Metres{1};
  picture(r, &result);
  EXPECT_EQ(result.visible.occluded, 0u) << "no motion was allowed for";
}

}  // namespace
}  // namespace trimtab
