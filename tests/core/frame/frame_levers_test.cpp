#include "trimtab/frame/frame_levers.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>

namespace trimtab {
namespace {

PolicyOutcome rules(std::initializer_list<std::pair<Lever, double>> set) {
  PolicyOutcome outcome;
  for (const auto& [lever, value] : set) {
    outcome.moved |= 1u << indexOf(lever);
    outcome.value[indexOf(lever)] = value;
  }
  return outcome;
}

const FrameLeverRow& row(std::string_view key) {
  for (const FrameLeverRow& r : kFrameLeverRows)
    if (r.key == key) return r;
  ADD_FAILURE() << key;
  return kFrameLeverRows[0];
}

constexpr OcclusionResolution kSmall{400, 300}, kLarge{800, 600};

TEST(FrameLevers, eachStepChangesOnlyItsOwn) {
  TuningParameters preset;
  preset.lod.screenSpaceError = Pixels{2};
  preset.staticLod.errorPx = Pixels{1};
  preset.lod.scale = Ratio{1.5};
  preset.lod.spread = Ratio{0.8};
  preset.objects = {Pixels{2}, Pixels{1}, Metres{100000}};
  const FrameLevers asked = presetLevers(preset, kSmall);
  FrameLevers expected;
  expected.errorPx = 2;
  expected.treeErrorPx = 1;
  expected.lodScale = 1.5;
  expected.levelSpread = 0.8;
  expected.smallFeaturePx = 1;
  expected.objectFarM = 100000;
  expected.occlusion = kSmall;
  EXPECT_EQ(asked, expected);

  MotionDecision motion;
  motion.lodScale = 1.2;
  motion.blur.strength = 0.8;
  const FrameLevers turning = withMotion(asked, motion);
  expected.lodScale = 1.5 * 1.2;
  expected.blurStrength = 0.8;
  EXPECT_EQ(turning, expected);

  WeatherDecision weather;
  weather.farM = 8000;
  const FrameLevers foggy = withWeather(turning, weather);
  expected.farM = 8000;
  EXPECT_EQ(foggy, expected);

  EXPECT_EQ(withPolicy(foggy, {}, motion, kLarge), foggy) << "a policy without rules changes nothing";
  const FrameLevers ruled = withPolicy(foggy,
                                       rules({{Lever::occlusion, 2},
                                              {Lever::screen_space_error, 8},
                                              {Lever::lod_scale, 2},
                                              {Lever::far_distance, 0.5},
                                              {Lever::particle_density, 0.25},
                                              {Lever::blur_strength, 0.5},
                                              {Lever::render_scale, 0.75}}),
                                       motion, kLarge);
  expected = {8, 4, 2 * 1.2, 0.8, 4000, 0.75, 0.25, 0.4, 8, 1, 100000, kLarge};
  EXPECT_EQ(ruled, expected) << "rules replace the preset's LOD scale, and head motion multiplies it";

  const FrameLevers held = withBudget(ruled, {16, 0.5, 0, 0});
  expected = {16, 8, 2 * 1.2, 0.8, 4000, 0.5, 0, 0, 16, 1, 100000, kLarge};
  EXPECT_EQ(held, expected) << "the budget leaves LOD scale, spread, far distance and occlusion alone";
}

TEST(FrameLevers, rulesOnObjectsReplaceThePresetsValuesAndTheBudgetMovesTheirErrorWithTheGrounds) {
  TuningParameters preset;
  preset.objects = {Pixels{3}, Pixels{2}, Metres{40000}};
  FrameLevers expected = presetLevers(preset, {});
  EXPECT_EQ(expected.objectErrorPx, 3);
  const FrameLevers ruled = withPolicy(
      expected, rules({{Lever::object_error, 12}, {Lever::small_feature, 0}, {Lever::object_distance, 7000}}),
      {}, {});
  expected.objectErrorPx = 12, expected.smallFeaturePx = 0, expected.objectFarM = 7000;
  EXPECT_EQ(ruled, expected);
  const double twice = 2 * ruled.errorPx;
  EXPECT_EQ(withBudget(ruled, {twice, 1, 1, 1}).objectErrorPx, 24);
}

TEST(FrameLevers, aRuleThatRestsAtThePresetsValueChangesNothingInAnyFormOfTerrain) {
  TuningParameters preset;
  preset.staticLod.errorPx = Pixels{0.3};
  const FrameLevers asked = presetLevers(preset, {});
  EXPECT_EQ(withPolicy(asked, rules({{Lever::screen_space_error, asked.errorPx}}), {}, {}), asked);
  EXPECT_EQ(withBudget(asked, {asked.errorPx, 1, 1, 1}), asked);
}

TEST(FrameLevers, theChainSaysWhoChangedALeverLast) {
  LeverChain chain;
  chain.motion.lodScale = chain.weather.lodScale = chain.policy.lodScale = chain.drawn.lodScale = 2;
  chain.weather.farM = chain.policy.farM = chain.drawn.farM = 9000;
  chain.policy.errorPx = 4;
  chain.drawn.errorPx = 5.6;
  chain.policy.occlusion = chain.drawn.occlusion = kSmall;
  EXPECT_EQ(lastChange(chain, row("lod_scale")), LeverStep::motion);
  EXPECT_EQ(lastChange(chain, row("far_distance")), LeverStep::weather);
  EXPECT_EQ(lastChange(chain, row("screen_space_error")), LeverStep::budget);
  EXPECT_EQ(lastChange(chain, row("occlusion")), LeverStep::policy);
  EXPECT_EQ(lastChange(chain, row("render_scale")), LeverStep::preset);
  EXPECT_EQ(valueOf(chain.drawn, row("occlusion")), 400);
  EXPECT_EQ(explain(chain, row("screen_space_error")), "preset 2 px, policy 4 px, budget 5.6 px");
  EXPECT_EQ(explain(chain, row("far_distance")), "preset unlimited, weather 9000 m");
  EXPECT_EQ(explain(chain, row("occlusion")), "preset none, policy 400 x 300 px");
  EXPECT_EQ(explain(chain, row("render_scale")), "preset 1");
  EXPECT_EQ(&chain.after(LeverStep::weather), &chain.weather);
  for (std::size_t i = 0; i < kLeverSteps; ++i) EXPECT_FALSE(toText(static_cast<LeverStep>(i)).empty());
  EXPECT_TRUE(toText(static_cast<LeverStep>(kLeverSteps)).empty());
}

}  // namespace
}  // namespace trimtab
