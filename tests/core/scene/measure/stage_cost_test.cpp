#include <cmath>
#include <string>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gpu_timer.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/synthetic_trees.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/measure/cost_stages.h"
#include "trimtab/preset/table.h"

namespace trimtab {
namespace {

using test::SceneTest;

class StageCost : public SceneTest {
 protected:
  /// Everything that a frame can be made to do.
  FrameRequest whole(double time) const {
    auto r = bare(time);
    r.levers.drawn.occlusion = OcclusionResolution{320, 240};
    r.decision.weather.precipitation = Precipitation::rain;
    r.decision.weather.density = 0.8;
    r.levers.drawn.blurStrength = 0.8;
    TuningParameters p;
    p.symbology.enabled = true;
    r.symbology =
        SymbologyRequest{{r.attitude, r.attitude, Metres{1234}, Knots{240}, true, {}}, symbologySetup(p)};
    return r;
  }
  FrameRequest bare(double time) const {
    auto r = request(over(0.4, 0.4, 400), {Degrees{30}, Degrees{-8}, Degrees{5}});
    r.time = time;
    r.separateStages = true;
    return r;
  }
  FrameCost costOf(const FrameRequest& r) { return renderer.draw(r, offscreen->framebuffer()).cost; }
  static double sumOf(const FrameCost& cost, StageKind kind) {
    double sum = 0;
    for (const CostStage& stage : kCostStages)
      if (stage.kind == kind && std::isfinite(cost.*stage.ms)) sum += cost.*stage.ms;
    return sum;
  }
  static void expectWhole(const FrameCost& cost, const std::string& what) {
    EXPECT_NEAR(sumOf(cost, StageKind::of_frame), cost.total, 1e-9 * cost.total) << what;
    EXPECT_LE(sumOf(cost, StageKind::part), cost.draw) << what;
    EXPECT_GT(cost.total, 0) << what;
  }
};

TEST_F(StageCost, countsEveryMomentOnce) {
  if (!report.software) GTEST_SKIP() << "parts are the GPU's";
  use(test::syntheticMountains());
  for (int i = 0; i < 4; ++i) {
    auto r = whole(1 + 0.02 * i);
    r.eye = over(0.4 + 0.1 * i, 0.4, 400);
    const FrameCost cost = costOf(r);
    expectWhole(cost, "whole frame " + std::to_string(i));
    // The decision is the session's.
    for (const CostStage& stage : kCostStages) {
      if (stage.ms == &FrameCost::decide || stage.ms == &FrameCost::gpu) continue;
      if (stage.ms == &FrameCost::page && i > 0) continue;  // the tiles may be there
      EXPECT_GT(cost.*stage.ms, 0) << stage.name << ' ' << i;
    }
    expectWhole(costOf(bare(2 + i)), "bare frame");
    r.separateStages = false;
    expectWhole(costOf(r), "not waiting");
    for (const CullingCase method : {CullingCase::none, CullingCase::view_frustum}) {
      r.cullingCase = method;
      expectWhole(costOf(r), "other case");
    }
  }
}

TEST_F(StageCost, isNotMeasuredWhereAStageIsNotRun) {
  if (!report.software) GTEST_SKIP() << "parts are the GPU's, of a frame before";
  use(test::syntheticMountains());
  EXPECT_GT(costOf(whole(1)).page, 0) << "the first picture makes its tiles";
  const struct {
    const char* what;
    CostField stage;
    void (*without)(FrameRequest&);
  } kCases[] = {
      {"all tiles are there", &FrameCost::page, [](FrameRequest&) {}},
      {"scheme frustum", &FrameCost::occlusion, [](FrameRequest& r) { r.levers.drawn.occlusion.reset(); }},
      {"at rest", &FrameCost::blur, [](FrameRequest& r) { r.levers.drawn.blurStrength = 0; }},
      {"clear air", &FrameCost::weather,
       [](FrameRequest& r) { r.decision.weather.precipitation = Precipitation::none; }},
      {"no symbols", &FrameCost::symbology, [](FrameRequest& r) { r.symbology.reset(); }},
      {"symbols switched off", &FrameCost::symbology,
       [](FrameRequest& r) { r.symbology->setup.general.enabled = false; }},
  };
  for (const auto& c : kCases) {
    auto r = whole(2);
    c.without(r);
    const FrameCost cost = costOf(r);
    EXPECT_TRUE(std::isnan(cost.*c.stage)) << c.what;
    expectWhole(cost, c.what);
    for (const CostField other : {&FrameCost::blur, &FrameCost::weather, &FrameCost::symbology}) {
      if (other == c.stage) continue;
      EXPECT_GT(cost.*other, 0) << c.what << " concerns no other stage";
    }
  }
  for (const double part : {costOf(bare(3)).blur, costOf(bare(3)).weather, costOf(bare(3)).symbology})
    EXPECT_TRUE(std::isnan(part));
  auto together = whole(4);
  together.separateStages = false;
  const FrameCost cost = costOf(together);
  for (const double part : {cost.blur, cost.weather, cost.symbology})
    EXPECT_TRUE(std::isnan(part)) << "without waiting nobody knows whose work it was";

  const auto last = whole(5);
  use(nullptr);
  const FrameCost sky = costOf(last);
  for (const double stage : {sky.select, sky.page, sky.occlusion}) EXPECT_TRUE(std::isnan(stage));
  expectWhole(sky, "no terrain");
}

TEST_F(StageCost, measuringChangesNoPixel) {
  use(test::syntheticMountains());
  auto r = whole(1);
  const auto separate = picture(r);
  r.separateStages = false;
  EXPECT_EQ(differing(separate, picture(r)), 0u);
}

/// The least of many: whatever else the machine does only adds to it.
TEST_F(StageCost, growsWithTheWorkOfItsStage) {
  if (!report.software) GTEST_SKIP() << "parts are the GPU's, of a frame before";
  use(test::syntheticMountains());
  double time = 1;
  const auto least = [&](FrameRequest r, CostField stage) {
    r.eye.height = r.eye.height + Metres{5000};  // the sky: little but the passes
    r.attitude.pitch = Degrees{60};
    double ms = 1e9;
    for (int i = 0; i < 20; ++i) {
      r.time = time += 0.01;
      ms = std::fmin(ms, costOf(r).*stage);
    }
    return ms;
  };
  auto less = whole(0), more = whole(0);
  less.decision.weather.density = 0.02;
  more.decision.weather.density = 1;
  EXPECT_GT(least(more, &FrameCost::weather), 2 * least(less, &FrameCost::weather));
  less = bare(0), more = bare(0);
  less.levers.drawn.blurStrength = more.levers.drawn.blurStrength = 0.8;
  more.view.widthPx *= 2, more.view.heightPx *= 2;
  less.view.widthPx /= 4, less.view.heightPx /= 4;
  EXPECT_GT(least(more, &FrameCost::blur), 3 * least(less, &FrameCost::blur)) << "64 times the pixels";
}

TEST_F(StageCost, ofStaticTreesSumsToTheTotal) {
  if (!report.software) GTEST_SKIP() << "parts are the GPU's";
  use(std::make_shared<const test::TreeTerrain>(test::syntheticMountains()));
  auto r = whole(1);
  r.terrain.form = TerrainForm::static_trees;
  for (int i = 0; i < 3; ++i) expectWhole(costOf(r), "trees");
}

class GpuTimer : public SceneTest {};

TEST_F(GpuTimer, tellsSpansApartAndForgetsThoseThatAFrameLacks) {
  scene::GpuTimer timer(3);
  for (std::size_t span = 0; span < 3; ++span) EXPECT_TRUE(std::isnan(timer.milliseconds(span)));
  const auto frame = [&](bool second) {
    timer.beginFrame();
    timer.begin(0);
    for (int i = 0; i < 20; ++i) glClear(GL_COLOR_BUFFER_BIT);
    if (second) {
      timer.begin(1);
      for (int i = 0; i < 20; ++i) glClear(GL_COLOR_BUFFER_BIT);
      timer.end(1);
    }
    timer.end(0);
    timer.endFrame();
    glFinish();
  };
  glBindFramebuffer(GL_FRAMEBUFFER, offscreen->framebuffer());
  for (int i = 0; i < 8; ++i) frame(true);
  EXPECT_GT(timer.milliseconds(0), 0);
  EXPECT_GT(timer.milliseconds(1), 0);
  EXPECT_LE(timer.milliseconds(1), timer.milliseconds(0)) << "a span in a span";
  EXPECT_TRUE(std::isnan(timer.milliseconds(2)));
  for (int i = 0; i < 8; ++i) frame(false);
  EXPECT_GT(timer.milliseconds(0), 0);
  EXPECT_TRUE(std::isnan(timer.milliseconds(1))) << "of a frame before";
}

}  // namespace
}  // namespace trimtab
