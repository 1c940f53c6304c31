#include "trimtab/hold/cost_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "noisy_machine.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

using Machine = test::NoisyMachine;

double predictedMs(const CostModel& model, const FrameLoad& load) {
  return predict(model.coefficients(load), load).total();
}

TEST(CostModel, knowsNothingBeforeSomeImages) {
  Machine machine;
  CostModel model;
  for (int i = 0; i < 7; ++i) {
    EXPECT_FALSE(model.coefficients({}).known);
    const FrameLoad load = machine.nextLoad();
    model.observe(load, machine.cost(load));
  }
}

TEST(CostModel, predictsWhatItLearned) {
  Machine machine;
  CostModel model;
  std::vector<double> errors;
  int covered = 0;
  for (int i = 0; i < 1000; ++i) {
    const FrameLoad load = machine.nextLoad();
    const FrameCost cost = machine.cost(load);
    if (i >= 200) {
      const double error = predictedMs(model, load) - cost.total;
      errors.push_back(std::abs(error) / cost.total);
      covered += std::abs(error) <= model.coefficients(load).halfBandMs;
    }
    model.observe(load, cost);
  }
  std::nth_element(errors.begin(), errors.begin() + 400, errors.end());
  EXPECT_LT(errors[400], 0.05);
  EXPECT_GE(covered, 0.80 * 800);
  EXPECT_LE(covered, 0.97 * 800);
}

TEST(CostModel, aSpikeMovesItLittle) {
  Machine machine;
  CostModel model;
  for (int i = 0; i < 300; ++i) {
    const FrameLoad load = machine.nextLoad();
    model.observe(load, machine.cost(load));
  }
  const FrameLoad load{6e4, 0.5, 0.92, 0, false};
  const double before = predictedMs(model, load);
  FrameCost spike = machine.cost(load);
  spike.draw = spike.total = 700;
  model.observe(load, spike);
  EXPECT_NEAR(predictedMs(model, load), before, 0.1 * before);
}

TEST(CostModel, followsAMachineThatSlowsDownWithinThirtyImages) {
  Machine machine;
  CostModel model;
  for (int i = 0; i < 300; ++i) {
    const FrameLoad load = machine.nextLoad();
    model.observe(load, machine.cost(load));
  }
  machine.slowness = 2;
  for (int i = 0; i < 30; ++i) {
    const FrameLoad load = machine.nextLoad();
    model.observe(load, machine.cost(load));
  }
  const FrameLoad load{6e4, 0.5, 0.92, 0, false};
  EXPECT_NEAR(predictedMs(model, load), 2 * (Machine::ground(load) + 0.4), 0.2 * 2 * Machine::ground(load));
}

/// Trials come for some images and belong to no load; a method that stays is found within five images.
TEST(CostModel, trialsOfOcclusionMoveNothing) {
  const Machine machine;
  Machine same = machine;
  CostModel with, without;
  const auto draw = [](Machine& of, CostModel& model, double occlusionMs) {
    const FrameLoad load = of.nextLoad();
    FrameCost cost = of.cost(load);
    cost.occlusion = occlusionMs, cost.total += occlusionMs;
    model.observe(load, cost);
  };
  Machine tries = machine;
  for (int i = 0; i < 400; ++i) draw(tries, with, i % 20 < 4 ? 4 : 0), draw(same, without, 0);
  const CostCoefficients tried = with.coefficients({}), never = without.coefficients({});
  EXPECT_NEAR(tried.other, never.other, 1e-9);
  EXPECT_NEAR(tried.fixed, never.fixed, 1e-9);
  EXPECT_NEAR(tried.perTriangle, never.perTriangle, 1e-9);
  for (int i = 0; i < 5; ++i) draw(tries, with, 4);
  EXPECT_NEAR(with.coefficients({}).other, never.other + 4, 0.5);
}

TEST(CostModel, whatTheFirstImagePagedIsNotWhatEveryImageTakes) {
  Machine machine;
  CostModel model;
  for (int i = 0; i < 12; ++i) {
    const FrameLoad load = machine.nextLoad();
    FrameCost cost = machine.cost(load);
    cost.page = i == 0 ? 20 : 0.1;
    if (i == 0) cost.total += 20;
    model.observe(load, cost);
  }
  EXPECT_LT(model.coefficients({}).other, 1);
  CostModel later;
  later.restore(model.state());
  const FrameLoad load = machine.nextLoad();
  FrameCost cost = machine.cost(load);
  cost.page = 20, cost.total += 20;
  later.observe(load, cost);
  EXPECT_LT(later.coefficients({}).other, 1);
}

TEST(CostModel, timesThatNoImageTakesTeachNothing) {
  for (const double ms : {-3.0, 0.0, 1e-9, 7e4, 1e150, kNan, kInfinity}) {
    CostModel model;
    FrameCost cost;
    cost.total = ms;
    cost.gpu = kNan;
    model.observe({6e4, 0.5, 0.92, 0, false}, cost);
    EXPECT_EQ(model.images(), 0U) << ms;
    EXPECT_EQ(model.state().processor.ground.images, 0) << ms;
  }
}

TEST(CostModel, timersThatLieTeachNothing) {
  Machine machine;
  CostModel model;
  for (int i = 0; i < 100; ++i) {
    const FrameLoad load = machine.nextLoad();
    model.observe(load, machine.cost(load));
  }
  const FrameLoad load{6e4, 0.5, 0.92, 1, true};
  const double before = predictedMs(model, load);
  for (const double lie : {0.0, -3.0, kNan, std::numeric_limits<double>::infinity()}) {
    FrameCost cost = machine.cost(load);
    cost.total = lie;
    model.observe(load, cost);
    FrameLoad none = load;
    none.triangles = lie > 0 || lie < 0 ? lie : kNan;
    if (!(none.triangles > 0)) continue;
    model.observe(none, machine.cost(load));
  }
  // So may the timer of a stage, or that of the GPU, once in a while.
  for (double FrameCost::*stage : {&FrameCost::weather, &FrameCost::blur, &FrameCost::decide,
                                   &FrameCost::symbology, &FrameCost::occlusion, &FrameCost::gpu})
    for (const double lie : {-3.0, 1e9, kNan, kInfinity, -kInfinity}) {
      FrameCost cost = machine.cost(load);
      cost.*stage = lie;
      model.observe(load, cost);
      for (int i = 0; i < 8; ++i) model.observe(load, machine.cost(load));
    }
  EXPECT_TRUE(std::isfinite(predictedMs(model, load)));
  EXPECT_NEAR(predictedMs(model, load), before, 0.2 * before);
  FrameCost unmeasured = machine.cost(load);
  unmeasured.weather = kNan;
  const std::size_t images = model.images();
  model.observe(load, unmeasured);
  EXPECT_EQ(model.images(), images);
}

/// Loads and times over many orders of magnitude, each learned for a while: what a file would be refused for
/// is never learned.
TEST(CostModel, learnsNoNumberOutsideItsRange) {
  Machine machine;
  const auto anyOf = [&machine](double least, double most) {
    return std::exp(machine.between(std::log(least), std::log(most)));
  };
  for (int flight = 0; flight < 200; ++flight) {
    CostModel model;
    for (int stay = 0; stay < 5; ++stay) {
      const FrameLoad around{anyOf(1, 1e9), anyOf(1e-9, 100), anyOf(1e-4, 100), 0, false};
      const double ms = anyOf(1e-3, 5e4);
      for (int i = 0; i < 300; ++i) {
        FrameLoad load = around;
        load.triangles = i % 7 == 0 ? 0 : around.triangles * machine.between(0.5, 2);
        load.groundMpx *= machine.between(0, 1);
        if (i % 3 == 0) load.particles = machine.between(0, 1);
        load.blurs = i % 5 == 0;
        FrameCost cost;
        cost.total = ms * machine.between(0.7, 1.3);
        cost.weather = cost.blur = cost.total / 10;
        cost.gpu = kNan;
        model.observe(load, cost);
        const CostModel::State state = model.state();
        CostModel::State::forEachNumber(
            state, [&](const std::string& key, double number, double low, double high) {
              ASSERT_TRUE(number >= low && number <= high) << key << " = " << number << ", flight " << flight;
            });
      }
    }
  }
}

/// Numbers of a file that are in their ranges, but were never learned here, and so certain that nothing could
/// be learned.
TEST(CostModel, thatPredictsNothingIsLearnedAgain) {
  Machine machine;
  CostModel good;
  for (int i = 0; i < 200; ++i) {
    const FrameLoad load = machine.nextLoad();
    good.observe(load, machine.cost(load));
  }
  CostModel::State state = good.state();
  state.processor.ground.coefficient[0] = 5e4;
  for (std::size_t i = 0; i < 4; ++i) {
    state.processor.ground.scale[i] *= 1e-6;
    for (std::size_t j = 0; j < 4; ++j) state.processor.ground.covariance[i][j] *= 1e-12;
  }
  CostModel model;
  model.restore(state);
  for (int i = 0; i < 300; ++i) {
    const FrameLoad load = machine.nextLoad();
    model.observe(load, machine.cost(load));
  }
  const FrameLoad load = machine.nextLoad();
  EXPECT_NEAR(predictedMs(model, load) / machine.cost(load).total, 1, 0.3);
}

TEST(CostModel, whoseNumbersAreNotFiniteBeginsAnewAtOnceAndSaysSo) {
  for (const double bad : {kNan, kInfinity}) {
    Machine machine;
    CostModel::State state;
    {
      CostModel good;
      for (int i = 0; i < 50; ++i) {
        const FrameLoad load = machine.nextLoad();
        good.observe(load, machine.cost(load));
      }
      state = good.state();
    }
    state.processor.ground.covariance[1][1] = bad;
    CostModel model;
    model.restore(state);
    for (int i = 0; i < 100; ++i) {
      const FrameLoad load = machine.nextLoad();
      model.observe(load, machine.cost(load));
    }
    ASSERT_TRUE(model.whyAnew());
    EXPECT_NE(toString(*model.whyAnew()).find("expected finite numbers"), std::string::npos);
    EXPECT_TRUE(std::isfinite(predictedMs(model, machine.nextLoad())));
    EXPECT_EQ(model.images(), 99U);
  }
}

/// Three times as slow within an image, and as quick again: what is learned follows, and nothing begins
/// anew.
TEST(CostModel, ofAMachineThatChangesDoesNotBeginAnew) {
  Machine machine;
  CostModel model;
  for (int i = 0; i < 2000; ++i) {
    machine.slowness = i / 300 % 2 == 0 ? 1 : 3;
    const FrameLoad load = machine.nextLoad();
    model.observe(load, machine.cost(load));
  }
  EXPECT_FALSE(model.whyAnew());
}

/// Numbers of a saved model that are within their ranges, far off and sure of themselves do not blind the
/// budget for good: the model corrects them to less than twice too long or too short, or begins anew.
TEST(CostModel, recoversFromSavedNumbersThatAreFarOff) {
  for (const double factor : {1e-6, 1e-3, 1e3, 1e6}) {
    Machine machine;
    CostModel model;
    for (int i = 0; i < 300; ++i) {
      const FrameLoad load = machine.nextLoad();
      model.observe(load, machine.cost(load));
    }
    CostModel::State state = model.state();
    auto& ground = state.processor.ground;
    for (double& coefficient : ground.coefficient) coefficient *= factor;
    // As sure of them as if they were small.
    for (double& scale : ground.scale) scale *= 1e-6;
    for (auto& row : ground.covariance)
      for (double& covariance : row) covariance *= 1e-12;
    model.restore(state);
    std::vector<double> errors;
    for (int i = 0; i < 400; ++i) {
      const FrameLoad load = machine.nextLoad();
      const FrameCost cost = machine.cost(load);
      if (i >= 200) errors.push_back(std::abs(predictedMs(model, load) / cost.total - 1));
      model.observe(load, cost);
    }
    std::nth_element(errors.begin(), errors.begin() + 100, errors.end());
    EXPECT_LT(errors[100], 0.5) << factor;
  }
}

/// Times of the GPU come up to three images late, so those that arrive after a move may be of the image
/// before.
TEST(CostModel, aTimeOfTheGpuFromBeforeALeverMovedTeachesNothing) {
  CostModel model;
  const auto cost = [](double gpuMs) {
    FrameCost c;
    c.total = 2;
    c.gpu = gpuMs;
    return c;
  };
  const FrameLoad fine{100'000, 0.5, 0.9, 0, false}, coarse{10'000, 0.5, 0.9, 0, false};
  for (int i = 0; i < 100; ++i) model.observe(fine, cost(10));
  const double before = predict(model.coefficients(coarse), coarse).total();
  model.leversMoved();
  for (int i = 0; i < 3; ++i) model.observe(coarse, cost(10));
  EXPECT_EQ(predict(model.coefficients(coarse), coarse).total(), before);
  for (int i = 0; i < 100; ++i) model.observe(coarse, cost(4));
  EXPECT_NEAR(predict(model.coefficients(coarse), coarse).total(), 4, 0.2);
}

}  // namespace
}  // namespace trimtab
