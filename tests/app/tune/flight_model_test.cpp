#include "app/tune/flight_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/tune/candidates.h"
#include "tests/app/harness/mountain_plan.h"
#include "tests/app/tune/model_world.h"
#include "trimtab/preset/preset.h"

namespace trimtab::tune {
namespace {

class FlightModelTest : public testing::Test {
 protected:
  static Flight flight() { return test::weavingFlight(60, 2); }
  static ModelWorld& world() {
    static ModelWorld world(flight());
    return world;
  }
  static FlightModel anew() {
    return {{smallLand(), ModelWorld::kWidth, ModelWorld::kHeight},
            flight(),
            patches([](TuningParameters&) {}),
            ModelWorld::kRows};
  }
  static Estimate estimate(const std::function<void(TuningParameters&)>& edit) {
    return world().model->estimate(patches(edit));
  }
};

TEST_F(FlightModelTest, samplesReadBackBitForBit) {
  const auto read = parseSamples(toJson(world().samples), "samples");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ(toJson(*read), toJson(world().samples));
  EXPECT_FALSE(parseSamples("{\"format\": \"other\"}", "samples"));
  EXPECT_FALSE(parseSamples("not JSON", "samples"));
}

TEST_F(FlightModelTest, coarserTakesLessTimeAndLosesMore) {
  const Estimate fine = estimate([](TuningParameters& p) { p.lod.screenSpaceError = Pixels{1}; });
  Estimate before = fine;
  for (const double px : {4.0, 8.0, 16.0}) {
    const Estimate now = estimate([&](TuningParameters& p) { p.lod.screenSpaceError = Pixels{px}; });
    EXPECT_GT(now.error, before.error) << px;
    before = now;
  }
  EXPECT_LT(before.medianMs, fine.medianMs);
}

TEST_F(FlightModelTest, theOrderOfPresetsIsThatOfDrawnErrors) {
  double drawnBefore = 0, estimatedBefore = 0;
  for (const auto& [px, scale] : {std::pair{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {4.0, 2.0}, {8.0, 3.0}}) {
    const ValidatedParameters preset = patches([&, px = px, scale = scale](TuningParameters& p) {
      p.lod.screenSpaceError = Pixels{px};
      p.lod.scale = Ratio{scale};
    });
    const double drawn = world().draw(preset, 60).error, estimated = world().model->estimate(preset).error;
    EXPECT_GT(drawn, drawnBefore);
    EXPECT_GT(estimated, estimatedBefore);
    EXPECT_NEAR(estimated / drawn, 1, 0.35) << px << " px times " << scale;
    drawnBefore = drawn, estimatedBefore = estimated;
  }
}

TEST_F(FlightModelTest, whatIsLostAtRestCountsOnceAndFollowsTheGround) {
  DrawnSamples planted = world().samples;
  for (DrawnRow& row : planted.rows) {
    row.atRest = 0.01;
    for (auto& ofLever : row.error) ofLever.fill(0.01);
  }
  FlightModel model = anew();
  model.learn(planted);
  const auto rowsAt = [&](double px) {
    std::vector<RowEstimate> rows;
    model.estimate(patches([&](TuningParameters& p) {
                     p.lod.screenSpaceError = Pixels{px};
                     p.objects.errorPx = Pixels{px};
                   }),
                   &rows);
    return rows;
  };
  const std::vector<RowEstimate> fine = rowsAt(1), coarse = rowsAt(16);
  double least = 1, most = 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    EXPECT_EQ(coarse[i].error, fine[i].error) << "levers add nothing to it";
    least = std::min(least, fine[i].error), most = std::max(most, fine[i].error);
    for (const SampleRow& drawn : model.toDraw())
      if (drawn.row == fine[i].row) {
        EXPECT_NEAR(fine[i].error, 0.01, 1e-6) << "as it was drawn";
      }
  }
  EXPECT_LT(least, 0.0099) << "a row with less ground than those drawn beside it";
  EXPECT_GT(most, 0.0101);
}

TEST_F(FlightModelTest, rulesSeeTheTrianglesThatAreEstimated) {
  // So many triangles are always too many, and never, so that the rule says what is drawn.
  const auto policy = [&](double from) {
    return estimate([&](TuningParameters& p) {
      p.policy.enabled = true;
      p.policy.terms.line = {"triangles many = ramp " + std::to_string(from) + ' ' +
                             std::to_string(from + 1)};
      p.policy.rules.line = {"if triangles is many then screen_space_error = 16"};
    });
  };
  const Estimate always = policy(1), never = policy(1e7);
  const Estimate fine = estimate([](TuningParameters&) {});
  const Estimate coarse = estimate([](TuningParameters& p) { p.lod.screenSpaceError = Pixels{16}; });
  EXPECT_EQ(never.error, fine.error);
  // The first images of a flight know no triangles yet.
  EXPECT_NEAR(always.error, coarse.error, 0.15 * coarse.error);
  EXPECT_GT(coarse.error, 2 * fine.error);
}

TEST_F(FlightModelTest, aBudgetIsHeldByTheEstimate) {
  const double wholeMs = estimate([](TuningParameters& p) { p.lod.screenSpaceError = Pixels{1}; }).p99Ms;
  const auto held = [&](double part) {
    return estimate([&](TuningParameters& p) {
      p.lod.screenSpaceError = Pixels{1};
      p.hold.enabled = true;
      p.measure.budget = Milliseconds{part * wholeMs};
    });
  };
  EXPECT_LE(held(0.7).p95Ms, 0.7 * wholeMs * 1.1);
  EXPECT_GT(held(0.7).error, held(3).error);
  EXPECT_NEAR(held(3).p99Ms, wholeMs, 1e-9) << "what fits stays";
}

TEST_F(FlightModelTest, aHeldBudgetGivesUpNoMoreThanItsOwnImagesAskFor) {
  // Times that lie so far beside the fit, to both sides. The arbiter keeps away from the budget by the band
  // of an image as it draws it, not of the far longer one that is asked for.
  const auto finest = [](TuningParameters& p) { p.lod.screenSpaceError = Pixels{1}; };
  const auto heldOverBudget = [&](double quickest, double repeats) {
    DrawnSamples noisy = world().samples;
    for (std::size_t i = 0; i < noisy.images.size(); ++i) {
      TimedImage& image = noisy.images[i];
      const double ms = 0.05 + 1e-3 * image.load.triangles, side = i % 2 ? 1 : -1;
      image.ms = ms * (1 + side * quickest);
      image.repeatsMs = {ms * (1 + side * repeats)};
    }
    FlightModel model = anew();
    model.learn(noisy);
    const double budgetMs = 0.5 * model.estimate(patches(finest)).p95Ms;
    return model
               .estimate(patches([&](TuningParameters& p) {
                 finest(p);
                 p.hold.enabled = true;
                 p.measure.budget = Milliseconds{budgetMs};
               }))
               .p95Ms /
           budgetMs;
  };
  const double calm = heldOverBudget(0.05, 0.05);
  EXPECT_GT(calm, 0.8 * 0.9);
  EXPECT_LE(calm, 1);
  EXPECT_LT(heldOverBudget(0, 0.25), 0.9 * heldOverBudget(0, 0)) << "times as they come lie far apart";
}

TEST_F(FlightModelTest, whatPresetsShareIsAsIfEachWereAlone) {
  const auto policy = [](TuningParameters& p) {
    p.policy.enabled = true;
    p.policy.terms.line = {"load high = ramp 0.1 0.4", "sight_rate fast = ramp 1 20",
                           "above_ground low = ramp 3000 500"};
    p.policy.rules.line = {"if load is high then screen_space_error = 16",
                           "if sight_rate is fast then lod_scale = 3",
                           "if above_ground is low then occlusion = 2"};
  };
  const std::vector<std::function<void(TuningParameters&)>> edits{
      [](TuningParameters&) {},
      [](TuningParameters& p) { p.lod.scale = Ratio{3}; },
      policy,
      [&](TuningParameters& p) { policy(p), p.altitude.reference = AltitudeReference::above_ground; },
      [](TuningParameters& p) {
        for (std::size_t i = 0; i < p.pitch.curve.size; ++i) p.pitch.curve.point[i].y = 0;
        for (std::size_t i = 0; i < p.altitude.curve.size; ++i) p.altitude.curve.point[i].y = 0;
      },
      [](TuningParameters& p) { p.weather.step = WeatherStep::rain_medium; },
      [&](TuningParameters& p) { policy(p), p.weather.step = WeatherStep::snow_heavy; },
      [](TuningParameters& p) { p.motion.control = MotionControl::off; },
      policy,
      [](TuningParameters& p) { p.hold.enabled = true; },
  };
  for (std::size_t i = 0; i < edits.size(); ++i) {
    FlightModel alone = anew();
    alone.learn(world().samples);
    estimate(edits[i % 2 ? 0 : 2]);  // whatever this one has in common with those
    const Estimate shared = estimate(edits[i]), own = alone.estimate(patches(edits[i]));
    EXPECT_EQ(shared.meanMs, own.meanMs) << i;
    EXPECT_EQ(shared.error, own.error) << i;
  }
}

TEST_F(FlightModelTest, lookingForHiddenGroundIsTheCullingsOwn) {
  // Whether anything is looked for changes the time and never the picture.
  const auto membership = [](double y) {
    return [y](TuningParameters& p) {
      for (CurvePoints* curve :
           {static_cast<CurvePoints*>(&p.altitude.curve), static_cast<CurvePoints*>(&p.pitch.curve)})
        for (std::size_t i = 0; i < curve->size; ++i) curve->point[i].y = y;
    };
  };
  const Estimate always = estimate(membership(1)), never = estimate(membership(0));
  EXPECT_EQ(always.error, never.error);
  EXPECT_NE(always.medianMs, never.medianMs);
}

TEST_F(FlightModelTest, whatWinsNothingIsPutBackToTheStart) {
  const Plan plan;
  const TuningParameters start = *patches([](TuningParameters&) {});
  const auto space = SearchSpace::make(start, {"lod.scale", "objects.far_m", "static_lod.error_px"});
  ASSERT_TRUE(space) << toString(space.findings());
  const Judge judge(plan, *space, std::span(world().model.get(), 1));
  const std::vector<double> at = space->placeOf(start);
  const auto putBack = [&](double scale) {
    // No object stands here, and the terrain is not drawn as trees.
    TuningParameters moved = start;
    moved.lod.scale = Ratio{scale};
    Candidate candidate{space->placeOf(moved), {}};
    for (std::size_t i = 0; i < at.size(); ++i)
      if (space->axes()[i].name != "lod.scale") candidate.place[i] = at[i] < 0.5 ? at[i] + 0.3 : at[i] - 0.3;
    candidate.objectives = judge(candidate.place);
    return simplified(judge, at, candidate);
  };
  EXPECT_EQ(putBack(1.0005).place, at) << "a saving that nobody can measure is none";
  const Candidate kept = putBack(1.02);
  for (std::size_t i = 0; i < at.size(); ++i)
    EXPECT_EQ(kept.place[i] != at[i], space->axes()[i].name == "lod.scale") << space->axes()[i].name;
}

TEST_F(FlightModelTest, theBestChangeOfOneParameterIsFoundToAThirtiethOfItsRange) {
  Plan plan;
  const TuningParameters start = *patches([](TuningParameters&) {});
  const auto space = SearchSpace::make(start, {"lod.scale=1..8"});
  const Judge judge(plan, *space, std::span(world().model.get(), 1));
  // Coarser is quicker and worse, so that the best lies at the limit, wherever that is.
  for (const double part : {0.2, 0.35, 0.6}) {
    const std::vector<double> wanted{part};
    plan.budgetMs = judge(wanted)[0];
    const Candidate best = bestSingle(judge, space->placeOf(start));
    EXPECT_LE(best.objectives[0], *plan.budgetMs);
    EXPECT_NEAR(best.place[0], part, 1.0 / 30) << part;
  }
}

TEST(FlightModel, aFlightBesideTheTerrainHasNothingToDraw) {
  Flight flight = harness::mountainFlight();
  for (AircraftState& state : flight.states) state.position.longitude = Degrees{-60};
  const FlightModel model({harness::hills(), 96, 64}, flight, defaultParameters(), 4);
  EXPECT_TRUE(model.toDraw().empty());
}

}  // namespace
}  // namespace trimtab::tune
