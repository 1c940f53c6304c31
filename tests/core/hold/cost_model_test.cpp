#include "trimtab/hold/cost_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "trimtab/hold/cost_model_file.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

/// A machine whose images cost what a line says, with noise.
class Machine {
 public:
  double slowness = 1, noise = 0.05;

  FrameLoad nextLoad() {
    FrameLoad load;
    load.triangles = between(2e4, 1.5e5);
    load.groundMpx = between(0.1, 0.9);
    load.sceneMpx = 0.92;
    load.particles = between(0, 1) < 0.3 ? between(0.2, 1) : 0;
    load.blurs = between(0, 1) < 0.2;
    return load;
  }
  FrameCost cost(const FrameLoad& load) {
    const auto noisy = [&](double ms) { return ms * slowness * (1 + noise * normal_(random_)); };
    FrameCost c;
    c.decide = 0.01;
    c.symbology = noisy(0.4);
    c.blur = load.blurs ? noisy(3 * load.sceneMpx) : kNan;
    c.weather = load.particles > 0 ? noisy(10 * load.particles + 2 * load.sceneMpx) : kNan;
    c.draw =
        noisy(ground(load)) + c.symbology + (load.blurs ? c.blur : 0) + (load.particles > 0 ? c.weather : 0);
    c.total = c.draw + c.decide;
    c.gpu = kNan;
    return c;
  }
  static double ground(const FrameLoad& load) { return 1.5 + 8e-5 * load.triangles + 14 * load.groundMpx; }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  std::mt19937 random_{3};
  std::normal_distribution<double> normal_;
};

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
      covered += std::abs(error) <= model.coefficients(load).bandMs;
    }
    model.observe(load, cost);
  }
  std::nth_element(errors.begin(), errors.begin() + 400, errors.end());
  EXPECT_LT(errors[400], 0.05);
  EXPECT_GE(covered, 0.80 * 800);
  EXPECT_LE(covered, 0.97 * 800);
}

/// Triangles that cost by their number, by their length in pixels, or half by each: what was learned at full
/// and half the render scale must hold between them.
TEST(CostModel, learnsWhatATriangleCostsAtAnyScale) {
  for (const double byLength : {0.0, 0.5, 1.0}) {
    const auto costOf = [byLength](const FrameLoad& load) {
      const double side = std::sqrt(load.sceneMpx);
      FrameCost c;
      c.total = 2 + 1.6e-4 * load.triangles * (1 - byLength + byLength * side) + 4 * load.groundMpx;
      c.gpu = kNan;
      return c;
    };
    Machine machine;
    CostModel model;
    for (int i = 0; i < 600; ++i) {
      FrameLoad load = machine.nextLoad();
      const double part = i % 50 < 25 ? 1 : 0.25;
      load = {load.triangles, load.groundMpx * part, load.sceneMpx * part, 0, false};
      model.observe(load, costOf(load));
    }
    const FrameLoad load{1.4e5, 0.1, 0.45, 0, false};
    EXPECT_NEAR(predictedMs(model, load) / costOf(load).total, 1, 0.005) << byLength;
  }
}

/// All images show as many pixels of ground as triangles, so no image told the two apart.
TEST(CostModel, theBandGrowsForLoadsUnlikeThoseDrawn) {
  Machine machine;
  CostModel model;
  FrameLoad load{6e4, 0.3, 0.6, 0, false};
  for (int i = 0; i < 400; ++i) {
    load.triangles = 4e4 + 100 * (i % 400);
    load.groundMpx = 5e-6 * load.triangles;
    load.sceneMpx = 2 * load.groundMpx;
    model.observe(load, machine.cost(load));
  }
  const CostCoefficients cost = model.coefficients(load);
  const double like = coefficientBandMs(cost, load);
  FrameLoad unlike = load;
  unlike.groundMpx = 0;
  EXPECT_GT(coefficientBandMs(cost, unlike), 5 * like);
  EXPECT_LE(like, cost.bandMs);
  // The filter itself is the oracle: without noise, bands times its deviation.
  const auto& ground = model.state().ground;
  const double triangles = unlike.triangles * 1e-4;
  const std::array<double, 4> x{1, triangles, triangles * std::sqrt(unlike.sceneMpx), 0};
  double variance = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) variance += x[i] * x[j] * ground.covariance[i][j];
  EXPECT_NEAR(coefficientBandMs(cost, unlike), 1.645 * std::sqrt(variance), 1e-6);
  EXPECT_EQ(coefficientBandMs({}, load), 0);
}

TEST(CostModel, noImageTakesLongerThanItsGreatestRatioOfALoad) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const CostCoefficients cost{.fixed = uniform(random),
                                .perTriangle = 1e-4 * uniform(random),
                                .perTriangleSide = 1e-4 * uniform(random),
                                .perGroundMpx = 20 * uniform(random),
                                .perParticles = 3 * uniform(random),
                                .perWeatherMpx = uniform(random),
                                .perBlurMpx = uniform(random),
                                .other = uniform(random),
                                .bandMs = 0,
                                .known = true};
    const auto load = [&] {
      return FrameLoad{1e5 * uniform(random), uniform(random), uniform(random), uniform(random) + 0.01,
                       i % 2 == 0};
    };
    const FrameLoad from = load(), to = load();
    EXPECT_LE(predict(cost, to).total(),
              predict(cost, from).total() * mostTimesAsLong(from, to) * (1 + 1e-12));
  }
  EXPECT_DOUBLE_EQ(mostTimesAsLong({100, 1, 1, 0, false}, {50, 0.5, 1.21, 0, false}), 1.21);
  EXPECT_DOUBLE_EQ(mostTimesAsLong({100, 1, 1, 0, false}, {50, 0.5, 1, 0, false}), 1);
  EXPECT_TRUE(std::isinf(mostTimesAsLong({100, 1, 1, 0, false}, {50, 0.5, 1, 0, true})));
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

class CostModelFile : public testing::Test {
 protected:
  std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "cost-model";
  std::filesystem::path file = folder / "deep" / "model.txt";
  void SetUp() override { std::filesystem::remove_all(folder); }
  CostModel learned() {
    Machine machine;
    CostModel model;
    for (int i = 0; i < 50; ++i) {
      const FrameLoad load = machine.nextLoad();
      model.observe(load, machine.cost(load));
    }
    return model;
  }
  std::string text() {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void rewrite(const std::string& bytes) { std::ofstream(file) << bytes; }
};

TEST_F(CostModelFile, readsBackToTheBit) {
  const CostModel model = learned();
  ASSERT_TRUE(writeCostModel(file, "llvmpipe", model).ok());
  const auto state = readCostModel(file, "llvmpipe");
  ASSERT_TRUE(state.ok()) << toString(state.findings());
  EXPECT_EQ(state->ground.coefficient, model.state().ground.coefficient);
  EXPECT_EQ(state->ground.covariance, model.state().ground.covariance);
  EXPECT_EQ(state->weather.coefficient, model.state().weather.coefficient);
  EXPECT_EQ(state->other, model.state().other);
}

TEST_F(CostModelFile, ofAnotherMachineIsDistrusted) {
  ASSERT_TRUE(writeCostModel(file, "llvmpipe", learned()).ok());
  const auto state = readCostModel(file, "a GPU");
  ASSERT_FALSE(state.ok());
  EXPECT_NE(toString(state.findings()).find("llvmpipe"), std::string::npos);
}

TEST_F(CostModelFile, numbersThatNoModelCanHaveAreRefused) {
  const CostModel::State good = learned().state();
  ASSERT_TRUE(good.ground.canBe() && good.weather.canBe() && good.blur.canBe());
  const auto refused = [&](const auto& spoil) {
    CostModel::State state = good;
    spoil(state);
    CostModel model;
    model.restore(state);
    EXPECT_TRUE(writeCostModel(file, "llvmpipe", model).ok());
    return !readCostModel(file, "llvmpipe").ok();
  };
  EXPECT_FALSE(refused([](CostModel::State&) {}));
  EXPECT_TRUE(refused([](CostModel::State& s) { s.ground.coefficient[1] = -1e-6; }));
  EXPECT_TRUE(refused([](CostModel::State& s) { s.ground.noise = -1; }));
  EXPECT_TRUE(refused([](CostModel::State& s) { s.weather.noise = 0; }));
  EXPECT_TRUE(refused([](CostModel::State& s) { s.ground.covariance[0][0] = -1e6; }));
  EXPECT_TRUE(refused([](CostModel::State& s) { s.ground.covariance[0][1] *= 1.5; }));
  EXPECT_TRUE(
      refused([](CostModel::State& s) { s.ground.covariance[0][1] = s.ground.covariance[1][0] = 1e9; }));
  EXPECT_TRUE(refused([](CostModel::State& s) { s.other = -1; }));
}

TEST_F(CostModelFile, everyMachineKeepsItsOwn) {
  const char* const set = std::getenv("XDG_CACHE_HOME");
  const std::string before = set ? set : "";
  ::setenv("XDG_CACHE_HOME", folder.c_str(), 1);
  Machine machine;
  CostModel model, other;
  for (int i = 0; i < 150; ++i) {
    const FrameLoad load = machine.nextLoad();
    model.observe(load, machine.cost(load));
  }
  EXPECT_TRUE(recallCostModel(other, "GPU/one (rev 2)").empty())
      << "nothing is there yet, which is no finding";
  EXPECT_TRUE(rememberCostModel(model, "GPU/one (rev 2)").empty());
  EXPECT_TRUE(rememberCostModel(model, "llvmpipe").empty());
  EXPECT_NE(costModelFile("GPU/one (rev 2)"), costModelFile("llvmpipe"));
  EXPECT_EQ(costModelFile("GPU/one (rev 2)").parent_path(), costModelFile("llvmpipe").parent_path());
  EXPECT_TRUE(recallCostModel(other, "GPU/one (rev 2)").empty());
  EXPECT_EQ(other.state().ground.coefficient, model.state().ground.coefficient);
  EXPECT_TRUE(rememberCostModel(learned(), "new").empty());
  EXPECT_FALSE(std::filesystem::exists(costModelFile("new"))) << "50 images are not worth it";
  set ? ::setenv("XDG_CACHE_HOME", before.c_str(), 1) : ::unsetenv("XDG_CACHE_HOME");
}

TEST_F(CostModelFile, damageIsSaidWithItsLine) {
  ASSERT_TRUE(writeCostModel(file, "llvmpipe", learned()).ok());
  const std::string good = text();
  for (const std::string& bad : {good.substr(0, good.size() / 2), std::string(), "x" + good, good + "7\n"}) {
    rewrite(bad);
    const auto state = readCostModel(file, "llvmpipe");
    ASSERT_FALSE(state.ok());
    EXPECT_NE(state.findings()[0].where.find("model.txt:"), std::string::npos);
  }
  std::string nan = good;
  nan.replace(nan.find("llvmpipe\n") + 9,
              nan.find('\n', nan.find("llvmpipe\n") + 9) - nan.find("llvmpipe\n") - 9, "nan");
  rewrite(nan);
  const auto state = readCostModel(file, "llvmpipe");
  ASSERT_FALSE(state.ok());
  EXPECT_NE(state.findings()[0].where.find(":3"), std::string::npos);
}

}  // namespace
}  // namespace trimtab
