#include "app/harness/flown_frames.h"

#include <gmock/gmock.h>

#include <cmath>

#include "mountain_plan.h"
#include "tests/shared_scene.h"
#include "trimtab/measure/paired_ratio.h"
#include "trimtab/policy/signals.h"
#include "trimtab/preset/preset.h"

namespace trimtab::harness {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TuningParameters withPolicy(std::vector<std::string> terms, std::vector<std::string> rules) {
  TuningParameters p = *defaultParameters();
  p.policy.enabled = true;
  p.policy.terms.line = std::move(terms);
  p.policy.rules.line = std::move(rules);
  return p;
}

/// The more triangles, the larger the allowed error.
ValidatedParameters byTriangles() {
  return *validate(
      withPolicy({"triangles many = ramp 500 4000"}, {"if not triangles is many then screen_space_error = 1",
                                                      "if triangles is many then screen_space_error = 16"}));
}

Plan planOf(const ValidatedParameters& parameters) {
  Plan plan = smallPlan();
  plan.presets = {{"default", defaultParameters()}, {"ours", parameters}};
  plan.cases = {CullingCase::proposed};
  return plan;
}

Results measured(const Plan& plan) {
  const test::ScratchDir dir;
  const auto results = run(plan, dir / "out");
  EXPECT_TRUE(results) << toString(results.findings());
  return results ? *results : Results{};
}

double meanOf(const Unit& unit, const char* key) {
  return summarise(unit, *quantityOf(key)).mean;
}

std::unique_ptr<experiment::Stage> stageFor(const Plan& plan) {
  experiment::Setup setup;
  setup.terrain = plan.terrain;
  setup.widthPx = plan.widthPx;
  setup.heightPx = plan.heightPx;
  auto stage = experiment::Stage::open(setup);
  EXPECT_TRUE(stage) << toString(stage.findings());
  return stage ? std::move(stage).value() : nullptr;
}

Flying flyingOf(const Plan& plan) {
  return {plan.terrain, plan.widthPx, plan.heightPx, plan.whole, plan.repeats, {}};
}

TEST(FeedbackOf, asksForImagesOnlyWhereADecisionDependsOnThem) {
  EXPECT_FALSE(feedbackOf(defaultParameters()).any());
  const Feedback counts = feedbackOf(byTriangles());
  EXPECT_TRUE(counts.counts && !counts.times);
  EXPECT_GT(counts.rememberedS, 1);
  const Feedback times = feedbackOf(
      *validate(withPolicy({"load high = ramp 0.5 1"}, {"if load is high then render_scale = 0.5"})));
  EXPECT_TRUE(times.times && !times.counts);
  const Feedback flight = feedbackOf(
      *validate(withPolicy({"roll steep = ramp 20 40"}, {"if roll is steep then render_scale = 0.5"})));
  EXPECT_FALSE(flight.any());
  TuningParameters p = *defaultParameters();
  p.hold.enabled = true;
  EXPECT_TRUE(feedbackOf(*validate(p)).times);
  p = *defaultParameters();
  p.motion.frames = MotionFrames::drawn;
  EXPECT_FALSE(feedbackOf(*validate(p)).any());
  p.motion.lodOverVertices = Ratio{1000};
  EXPECT_TRUE(feedbackOf(*validate(p)).counts);
}

TEST(FlyFrames, drawsNothingForAPresetWithoutFeedback) {
  const Plan plan = smallPlan();
  const auto stage = stageFor(plan);
  int images = 0;
  Flying flying = flyingOf(plan);
  flying.goOn = [&images] { return ++images > 0; };
  const std::vector<std::size_t> rows{10, 40};
  const Flight flight = mountainFlight();
  const auto frames = flyFrames(*stage, flying, flight, defaultParameters(), rows);
  ASSERT_TRUE(frames);
  EXPECT_EQ(images, 0);
  ASSERT_EQ(frames->size(), 2u);
  EXPECT_EQ((*frames)[1].row, 40u);
  EXPECT_EQ((*frames)[1].images.size(), 1u);
  EXPECT_EQ((*frames)[1].images[0].before.size(), 1u);
}

TEST(FlyFrames, drawsWhatItForetold) {
  Plan plan = smallPlan();
  const auto stage = stageFor(plan);
  const std::vector<std::size_t> rows{3, 12, 50};
  const Flight flight = mountainFlight();
  TuningParameters holds = *defaultParameters();
  holds.hold.enabled = true;
  for (const bool whole : {false, true})
    for (const ValidatedParameters& parameters : {byTriangles(), *validate(holds)}) {
      Flying flying = flyingOf(plan);
      flying.whole = whole;
      std::size_t images = 0;
      flying.goOn = [&images] { return ++images > 0; };
      ASSERT_TRUE(flyFrames(*stage, flying, flight, parameters, rows));
      EXPECT_EQ(images, imagesToFly(flying, flight, parameters, rows));
      // With a flight to learn from, and another for each of two repeats.
      const std::size_t flights = parameters->hold.enabled ? 3 : 1;
      EXPECT_EQ(images == flights * 50, whole) << "every row up to the last one measured, in each flight";
      flying.goOn = [] { return false; };
      EXPECT_FALSE(flyFrames(*stage, flying, flight, parameters, rows)) << "it was stopped";
    }
}

TEST(Run, measuresAPresetByItsOwnTriangles) {
  const Results results = measured(planOf(byTriangles()));
  const Unit &plain = unitOf(results, "default", "proposed"), &ours = unitOf(results, "ours", "proposed");
  EXPECT_NE(meanOf(ours, "triangles"), meanOf(plain, "triangles"));
  EXPECT_NE(meanOf(ours, "flip"), meanOf(plain, "flip"));
  EXPECT_THAT(results.notes, Contains(HasSubstr("ours decides by its own images")));
}

/// Twenty rows a second, so that far fewer of them are drawn than there are.
Flight smoothMountainFlight() {
  const Flight rows = mountainFlight();
  Flight flight;
  for (double time = 0; time < rows.states.back().time; time += 0.05)
    flight.states.push_back(stateAt(rows, time));
  return flight;
}

/// What is drawn before a sampled frame is enough for it.
TEST(Run, sampledFramesAgreeWithThoseOfAFlightThatIsDrawnWhole) {
  Plan plan = planOf(byTriangles());
  plan.flights = {{"one", smoothMountainFlight()}};
  plan.frames = 8;
  plan.repeats = 1;
  const Results sampled = measured(plan);
  plan.whole = true;
  const Results whole = measured(plan);
  const auto differ = [](const Unit& a, const Unit& b, const char* key) {
    std::vector<double> as, bs;
    for (const MeasuredFrame& frame : a.frames) as.push_back(quantityOf(key)->of(frame));
    for (const MeasuredFrame& frame : b.frames) bs.push_back(quantityOf(key)->of(frame));
    const PairedDifference difference = pairedDifference(as, bs);
    return difference.low > 0 || difference.high < 0;
  };
  const Unit &some = unitOf(sampled, "ours", "proposed"), &all = unitOf(whole, "ours", "proposed"),
             &plain = unitOf(whole, "default", "proposed");
  ASSERT_EQ(some.frames.size(), all.frames.size());
  for (const char* key : {"triangles", "flip"}) {
    EXPECT_FALSE(differ(some, all, key)) << key;
    EXPECT_NE(meanOf(some, key), meanOf(plain, key)) << "the rules do something";
  }
}

/// Each signal of the table, with a flight and a preset in which it is known and above its threshold.
TEST(Run, aRuleOnAnySignalMovesARow) {
  for (const SignalRow& signal : kSignalRows) {
    const std::string key(signal.key);
    // Whatever value the flight has is above the range's low end, and any such counts as much.
    const double from = signal.range.low, to = from + (signal.range.high - from) * 1e-9;
    char term[120];
    std::snprintf(term, sizeof term, "%s some = ramp %.17g %.17g", key.c_str(), from, to);
    TuningParameters p = withPolicy({term}, {"if " + key + " is some then screen_space_error = 16"});
    p.weather.source = WeatherSource::preset;
    p.weather.step = WeatherStep::rain_medium;
    TuningParameters plain = p;
    plain.policy.enabled = false;
    Plan plan = planOf(*validate(p));
    plan.presets[0].parameters = *validate(plain);
    plan.frames = 2;
    plan.repeats = 1;
    double headingDeg = 0;
    for (AircraftState& state : plan.flights[0].flight.states)
      state.head = Attitude{Degrees{headingDeg += 10}, Degrees{0}, Degrees{0}};
    const Results results = measured(plan);
    const Unit &without = unitOf(results, "default", "proposed"), &with = unitOf(results, "ours", "proposed");
    EXPECT_LT(meanOf(with, "triangles"), meanOf(without, "triangles")) << key;
    EXPECT_THAT(with.unknownSignals, ElementsAre()) << key;
  }
}

TEST(Run, saysWhichSignalsNobodyKnew) {
  const test::ScratchDir dir;
  Plan plan = planOf(*validate(withPolicy(
      {"head_rate fast = ramp 30 100", "roll some = ramp 0 1"},
      {"if head_rate is fast then screen_space_error = 16", "if roll is some then lod_scale = 2"})));
  const auto results = run(plan, dir / "out");
  ASSERT_TRUE(results) << toString(results.findings());
  EXPECT_THAT(unitOf(*results, "ours", "proposed").unknownSignals, ElementsAre("head_rate"));
  EXPECT_THAT(unitOf(*results, "default", "proposed").unknownSignals, ElementsAre());
  ASSERT_EQ(results.findings().size(), 1u);
  EXPECT_EQ(results.findings()[0].key, "head_rate");
  EXPECT_EQ(results.findings()[0].severity, Severity::warning);
  EXPECT_THAT(results->notes, Contains(HasSubstr("head_rate")));
  const auto read = parseResults(toJson(*results), "");
  ASSERT_TRUE(read);
  EXPECT_THAT(unitOf(*read, "ours", "proposed").unknownSignals, ElementsAre("head_rate"));
  // The same from what the folder holds.
  const auto again = run(plan, dir / "out");
  ASSERT_TRUE(again);
  EXPECT_EQ(toString(again.findings()), toString(results.findings()));
}

TEST(Run, measuresAPresetThatHoldsTheBudgetAsItHolds) {
  TuningParameters p = *defaultParameters();
  p.hold.enabled = true;
  p.measure.budget = Milliseconds{2};
  Plan plan = planOf(*validate(p));
  // So large that pixels are what an image takes, and lowering them wins.
  plan.widthPx = 960;
  plan.heightPx = 540;
  plan.repeats = 3;
  // What pixels cost is learned from times, in which another program's may drown it.
  Results results = measured(plan);
  for (int again = 0; again < 2 && meanOf(unitOf(results, "ours", "proposed"), "render_scale") == 1; ++again)
    results = measured(plan);
  const Unit &plain = unitOf(results, "default", "proposed"), &ours = unitOf(results, "ours", "proposed");
  EXPECT_LT(meanOf(ours, "render_scale"), 1);
  EXPECT_GT(meanOf(ours, "flip"), meanOf(plain, "flip"));
  EXPECT_THAT(results.notes, Contains(HasSubstr("each repeat flies anew")));
}

TEST(FlyFrames, fliesAnewForEachRepeatWhereTimeDecides) {
  const Plan plan = smallPlan();
  const auto stage = stageFor(plan);
  const Flight flight = mountainFlight();
  const ValidatedParameters byLoad =
      *validate(withPolicy({"load some = ramp 0 1e-6"}, {"if load is some then screen_space_error = 16"}));
  const auto timed = flyFrames(*stage, flyingOf(plan), flight, byLoad, {30});
  const auto counted = flyFrames(*stage, flyingOf(plan), flight, byTriangles(), {30});
  ASSERT_TRUE(timed && counted);
  EXPECT_EQ((*timed)[0].images.size(), plan.repeats);
  EXPECT_EQ((*counted)[0].images.size(), 1u);
  for (const FlownFrame::Image& image : (*timed)[0].images) EXPECT_EQ(image.request.levers.drawn.errorPx, 16);
  EXPECT_EQ(&(*counted)[0].ofRepeat(1), &(*counted)[0].images[0]);
}

/// The acceptance of a measured preset: what ships differs where its rules fire.
TEST(Run, lowLevelDiffersFromDefaultOverKansai) {
  TRIMTAB_NEEDS_SHARED("data/fg-kansai-e135n35");
  const auto terrain = test::bakedOnce("fg-kansai-e135n35");
  ASSERT_TRUE(terrain) << toString(terrain.findings());
  const auto flight = readFlight(test::sourceDir() / "resources/flights/kansai-valley.csv");
  ASSERT_TRUE(flight) << toString(flight.findings());
  Plan plan = smallPlan();
  plan.terrain = *terrain;
  plan.terrainName = "Kansai";
  plan.flights = {{"kansai-valley", *flight}};
  plan.presets.clear();
  for (const char* name : {"default", "low-level", "high-cruise"}) {
    const auto preset = loadPreset(name);
    ASSERT_TRUE(preset);
    plan.presets.push_back({name, *validate(preset->parameters)});
  }
  plan.cases = {CullingCase::view_frustum};
  plan.widthPx = 320;
  plan.heightPx = 180;
  plan.frames = 3;
  plan.repeats = 1;
  const Results results = measured(plan);
  for (const char* name : {"low-level", "high-cruise"}) {
    const Unit &plain = unitOf(results, "default", "view_frustum"),
               &ours = unitOf(results, name, "view_frustum");
    EXPECT_NE(meanOf(ours, "triangles"), meanOf(plain, "triangles")) << name;
    EXPECT_NE(meanOf(ours, "flip"), meanOf(plain, "flip")) << name;
    EXPECT_THAT(ours.unknownSignals, ElementsAre()) << name;
  }
}

}  // namespace
}  // namespace trimtab::harness
