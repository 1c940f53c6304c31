#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/harness/mountain_plan.h"
#include "tests/app/tune/model_world.h"
#include "tests/core/scene/terrain/synthetic_trees.h"
#include "trimtab/preset/preset.h"

/// What estimates know of levers that reach beyond their own image, or move all levels at once.
namespace trimtab::tune {
namespace {

ValidatedParameters spreadPreset(double px, double spread, double fromM) {
  return patches([&](TuningParameters& p) {
    p.lod.screenSpaceError = p.objects.errorPx = Pixels{px};
    p.lod.spread = Ratio{spread};
    p.lod.spreadFrom = Metres{fromM};
    // Whether anything is looked for changes the planted times.
    p.culling.cullingCase = CullingCase::view_frustum;
  });
}

/// Large enough that levels of many errors are in view.
std::shared_ptr<const terrain::Database> wideLand() {
  static const test::ScratchDir dir;
  static const std::shared_ptr<const terrain::Database> land = test::bakedSample(dir.path(), {3, 40, 60, {}});
  return land;
}

ModelWorld& weaving() {
  static ModelWorld world(test::weavingFlight(60, 2), spreadPreset(2, 1, 5000), ErrorKind::flip, wideLand());
  return world;
}

TEST(SpreadOfLevels, drawsAndLosesWhatIsEstimated) {
  const auto change = [](double from, double to) { return std::abs(std::log(to / from)); };
  for (const double px : {1.0, 2.0}) {
    const Estimate all = weaving().model->estimate(spreadPreset(px, 1, 5000));
    const ModelWorld::Drawn drawnAll = weaving().draw(spreadPreset(px, 1, 5000));
    for (const double spread : {0.5, 2.0}) {
      const Estimate now = weaving().model->estimate(spreadPreset(px, spread, 5000));
      const ModelWorld::Drawn drawn = weaving().draw(spreadPreset(px, spread, 5000));
      EXPECT_NEAR(now.error / all.error / (drawn.error / drawnAll.error), 1, 0.3)
          << px << " px, spread " << spread;
      // A triangle is planted to take 2e-4 ms.
      const double triangles = drawnAll.triangles + (now.meanMs - all.meanMs) / 2e-4;
      EXPECT_NEAR(triangles / drawn.triangles, 1, 0.2) << px << " px, spread " << spread;
      EXPECT_GT(change(drawnAll.triangles, drawn.triangles), 0.25) << "else nothing is shown";
    }
  }
}

TEST(SpreadOfLevels, fromAnotherDistanceIsAnotherAllowedError) {
  // By the rule of levels: a spread of 2 from 20 km is one from 5 km at twice the allowed error.
  const Estimate from20 = weaving().model->estimate(spreadPreset(2, 2, 20000)),
                 from5 = weaving().model->estimate(spreadPreset(4, 2, 5000)),
                 unspread = weaving().model->estimate(spreadPreset(2, 1, 20000));
  EXPECT_NEAR(from20.error, from5.error, 1e-9);
  EXPECT_NEAR(from20.meanMs, from5.meanMs, 1e-9);
  EXPECT_EQ(unspread.meanMs, weaving().model->estimate(spreadPreset(2, 1, 5000)).meanMs);
}

/// Flies ahead for a second and a half, then turns by 120 degrees a second, at 60 Hz, and once by 180.
Flight turningFlight() {
  Flight flight = test::weavingFlight(180, 60);
  for (std::size_t i = 0; i < flight.states.size(); ++i) {
    AircraftState& state = flight.states[i];
    state.position = {Degrees{36.62 + 1e-5 * static_cast<double>(i)}, Degrees{128.35},
                      Feet{5000}.as<Metres>()};
    state.attitude = {Degrees{i < 90 ? 40.0 : 39.0 + 2 * static_cast<double>(i - 90) + (i < 120 ? 0 : 1)},
                      Degrees{-5}, Degrees{0}};
  }
  return flight;
}

TEST(Blur, losesWhereTheViewTurnsAndTakesItsTime) {
  ModelWorld world(turningFlight());
  const auto preset = [](double strength) {
    return patches([&](TuningParameters& p) {
      p.motion.blurStrength = Ratio{strength};
      p.motion.lodMaximum = Ratio{1};  // head motion blurs and makes nothing coarser
    });
  };
  const Estimate sharp = world.model->estimate(preset(0));
  const double sharpDrawn = world.draw(preset(0), 24).error;
  double before = 0;
  for (const double strength : {0.3, 0.8}) {
    const Estimate blurred = world.model->estimate(preset(strength));
    const double lost = blurred.error - sharp.error,
                 drawn = world.draw(preset(strength), 24).error - sharpDrawn;
    EXPECT_GT(lost, before);
    EXPECT_NEAR(lost / drawn, 1, 0.35) << strength;
    before = lost;
    // The longest images are those that blur.
    const double planted = ModelWorld::kBlurMsPerMpx * 1e-6 * ModelWorld::kWidth * ModelWorld::kHeight;
    EXPECT_NEAR(blurred.p95Ms - sharp.p95Ms, planted, 0.2 * planted) << strength;
  }
}

TEST(Blur, isDrawnWhereTheViewTurnsFastest) {
  const ModelWorld world(turningFlight());
  const auto blurred = std::count_if(world.model->toDraw().begin(), world.model->toDraw().end(),
                                     [](const SampleRow& sample) { return sample.trail.has_value(); });
  EXPECT_EQ(blurred, 3);
  const auto fastest =
      std::max_element(world.model->toDraw().begin(), world.model->toDraw().end(),
                       [](const SampleRow& a, const SampleRow& b) { return a.turnDegps < b.turnDegps; });
  EXPECT_NEAR(fastest->turnDegps, 180, 1);
  EXPECT_EQ(fastest->row, 120u) << "which is none of those that are evenly spread";
  ASSERT_TRUE(fastest->trail);
  EXPECT_GT(fastest->trail->size(), 30u) << "so far back reaches the strongest blur at 60 Hz";
  for (std::size_t i = 1; i < fastest->trail->size(); ++i)
    EXPECT_LT((*fastest->trail)[i - 1].time, (*fastest->trail)[i].time);
  EXPECT_LT(fastest->trail->back().time, fastest->before->time);
}

TEST(StaticTrees, areEstimatedByTheirOwnErrors) {
  const auto trees = [](const std::function<void(TuningParameters&)>& edit) {
    return test::edited([&](TuningParameters& p) {
      p.terrain.form = TerrainForm::static_trees;
      p.culling.cullingCase = CullingCase::view_frustum;
      edit(p);
    });
  };
  const auto atPx = [&](double px) {
    return trees([px](TuningParameters& p) { p.staticLod.errorPx = Pixels{px}; });
  };
  ModelWorld world(harness::mountainFlight(), atPx(1), ErrorKind::flip,
                   std::make_shared<const test::TreeTerrain>(harness::hills()));
  const Estimate fine = world.model->estimate(atPx(1));
  const ModelWorld::Drawn drawnFine = world.draw(atPx(1));
  for (const double px : {4.0, 12.0}) {
    const Estimate now = world.model->estimate(atPx(px));
    const ModelWorld::Drawn drawn = world.draw(atPx(px));
    EXPECT_NEAR(now.error / drawn.error, 1, 0.35) << px;
    EXPECT_NEAR((now.meanMs - fine.meanMs) / 2e-4, drawn.triangles - drawnFine.triangles,
                0.35 * std::abs(drawn.triangles - drawnFine.triangles))
        << px;
    // The allowed error of tiles and patches says nothing of trees.
    const Estimate other = world.model->estimate(trees([px](TuningParameters& p) {
      p.staticLod.errorPx = Pixels{px};
      p.lod.screenSpaceError = Pixels{9};
    }));
    EXPECT_EQ(other.error, now.error);
  }
  // A distance per metre of error is an allowed error, too.
  const double pxPerRadian = errorPxPerRadian(world.model->toDraw()[0].request);
  const Estimate byFactor = world.model->estimate(trees([&](TuningParameters& p) {
    p.staticLod.rule = StaticDistanceRule::factor;
    p.staticLod.distancePerError = Ratio{pxPerRadian / 4};
  }));
  EXPECT_NEAR(byFactor.error, world.model->estimate(atPx(4)).error, 1e-9);
  EXPECT_NEAR(byFactor.meanMs, world.model->estimate(atPx(4)).meanMs, 1e-9);
}

class ErrorKinds : public testing::TestWithParam<ErrorKind> {};

TEST_P(ErrorKinds, estimatesAreOfTheErrorThatIsDrawn) {
  ModelWorld world(test::weavingFlight(60, 2), patches([](TuningParameters&) {}), GetParam());
  const auto preset = [](double px, double scale) {
    return patches([&](TuningParameters& p) {
      p.lod.screenSpaceError = Pixels{px};
      p.policy.enabled = scale < 1;
      p.policy.terms.line = {"altitude high = ramp -3000 -2000"};
      p.policy.rules.line = {"if altitude is high then render_scale = " + std::to_string(scale)};
    });
  };
  for (const auto& [px, scale] : {std::pair{2.0, 1.0}, {8.0, 1.0}, {2.0, 0.7}, {8.0, 0.7}}) {
    const double drawn = world.draw(preset(px, scale), 24).error,
                 estimated = world.model->estimate(preset(px, scale)).error;
    EXPECT_NEAR(estimated / drawn, 1, 0.45) << px << " px, render scale " << scale;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ErrorKinds,
                         testing::Values(ErrorKind::flip, ErrorKind::geometric, ErrorKind::pop),
                         [](const auto& kind) { return std::string(rowOf(kind.param).key); });

TEST(Band, holdsNineOfTenImagesThatSeveralLeversMove) {
  // What is planted beside the estimates comes back as their band.
  ModelWorld& world = weaving();
  const auto bandOf = [&](double part) {
    DrawnSamples samples = world.samples;
    FlightModel model({world.land, ModelWorld::kWidth, ModelWorld::kHeight}, world.flight,
                      patches([](TuningParameters&) {}), ModelWorld::kRows);
    for (DrawnRow& row : samples.rows) {
      row.error = {}, row.atRest = 0.02;
      row.together.fill(0.02 * (1 + part));
    }
    for (std::size_t i = 0; i < samples.images.size(); ++i) {
      samples.images[i].ms *= i % 2 ? 1 + part : 1 - part;
      samples.images[i].repeatsMs = {samples.images[i].ms};
    }
    model.learn(samples);
    return model.estimate(patches([](TuningParameters&) {}));
  };
  EXPECT_NEAR(bandOf(0).errorBand, 0, 1e-6);
  EXPECT_NEAR(bandOf(0.1).errorBand, 0.1, 1e-6);
  EXPECT_LT(bandOf(0).timeBand, 0.01);
  EXPECT_GT(bandOf(0.1).timeBand, 0.05);
  EXPECT_LT(bandOf(0.1).timeBand, 0.3) << "each image is also off by what its row is";
}

TEST(Losses, countWhatLiesBeyondTheRestingImageAsTheRootOfTheSumOfSquares) {
  Losses losses(0.02);
  losses.add(0.05);
  losses.add(0.06);
  losses.add(0.01);  // a lever that does nothing, or that hides what rests
  EXPECT_NEAR(losses.error(), 0.02 + 0.05, 1e-12);
  EXPECT_EQ(Losses(0.02).error(), 0.02);
}

TEST(ErrorStatistic, aFlightAndItsImagesAreJudgedAsTheyAreDrawn) {
  std::vector<double> images;
  for (int i = 1; i <= 40; ++i) images.push_back(i);
  EXPECT_EQ(errorOfImages(ErrorKind::flip, images), 20.5);
  EXPECT_EQ(errorOfImages(ErrorKind::geometric, images), 40);
  EXPECT_EQ(errorOfImages(ErrorKind::pop, images), 38);
  EXPECT_EQ(errorOfFlights(ErrorKind::flip, std::vector{1.0, 3.0}), 2);
  EXPECT_EQ(errorOfFlights(ErrorKind::geometric, std::vector{1.0, 3.0}), 3);
  EXPECT_EQ(errorOfFlights(ErrorKind::pop, std::vector{1.0, 3.0}), 3);
  EXPECT_EQ(errorText(ErrorKind::flip, 0.0123), "FLIP 0.012");
  EXPECT_EQ(errorText(ErrorKind::geometric, 3.14), "3.1 px");
  EXPECT_EQ(errorText(ErrorKind::pop, 4.21), "pop 4.2 of 255");
}

}  // namespace
}  // namespace trimtab::tune
