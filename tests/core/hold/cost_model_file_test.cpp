#include "trimtab/hold/cost_model_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "noisy_machine.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

using Machine = test::NoisyMachine;

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
  EXPECT_EQ(state->processor.ground.coefficient, model.state().processor.ground.coefficient);
  EXPECT_EQ(state->processor.ground.covariance, model.state().processor.ground.covariance);
  EXPECT_EQ(state->processor.weather.coefficient, model.state().processor.weather.coefficient);
  EXPECT_EQ(state->processor.other, model.state().processor.other);
}

TEST_F(CostModelFile, ofAnotherMachineIsDistrusted) {
  ASSERT_TRUE(writeCostModel(file, "llvmpipe", learned()).ok());
  const auto state = readCostModel(file, "a GPU");
  ASSERT_FALSE(state.ok());
  EXPECT_NE(toString(state.findings()).find("llvmpipe"), std::string::npos);
}

TEST_F(CostModelFile, numbersThatNoModelCanHaveAreRefusedByName) {
  const CostModel model = learned();
  ASSERT_TRUE(writeCostModel(file, "llvmpipe", model).ok());
  const std::string good = text();
  std::vector<std::string> lines;
  std::istringstream in(good);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  std::vector<std::string> keys(2);
  const CostModel::State state = model.state();
  CostModel::State::forEachNumber(
      state, [&](const std::string& key, double, double, double) { keys.push_back(key); });
  ASSERT_EQ(lines.size(), keys.size());
  const auto refusal = [&](std::size_t line, const std::string& number) -> std::string {
    std::string damaged;
    for (std::size_t i = 0; i < lines.size(); ++i) damaged += (i == line ? number : lines[i]) + '\n';
    rewrite(damaged);
    const auto read = readCostModel(file, "llvmpipe");
    return read ? std::string() : toString(read.findings());
  };
  for (std::size_t line = 2; line < lines.size(); ++line) {
    for (const char* number : {"1e308", "1e150", "1e13", "-1e13", "-1e308"}) {
      const std::string said = refusal(line, number);
      EXPECT_NE(said.find("model.txt:" + std::to_string(line + 1) + ": " + keys[line] + ": expected "),
                std::string::npos)
          << number << " as " << keys[line] << ": " << said;
    }
    const bool isDiagonal =
        keys[line].find("covariance") != std::string::npos &&
        keys[line].substr(keys[line].size() - 3) == keys[line].substr(keys[line].size() - 6, 3);
    if (isDiagonal || keys[line].find("scale") != std::string::npos || keys[line].ends_with("noise")) {
      EXPECT_NE(refusal(line, "5e-324").find(keys[line]), std::string::npos) << keys[line];
    }
  }
  EXPECT_EQ(refusal(lines.size(), ""), "") << "undamaged";
}

TEST_F(CostModelFile, uncertaintiesOfNothingAreRefused) {
  ASSERT_TRUE(writeCostModel(file, "llvmpipe", learned()).ok());
  CostModel::State state = learned().state();
  const auto refused = [&](double& number, double value) {
    const double before = std::exchange(number, value);
    bool out = false;
    CostModel::State::forEachNumber(state, [&](const std::string&, double n, double low, double high) {
      out = out || !(n >= low && n <= high);
    });
    number = before;
    return out;
  };
  EXPECT_FALSE(refused(state.processor.other, state.processor.other));
  EXPECT_TRUE(refused(state.processor.ground.covariance[0][0], 5e-324)) << "it would learn nothing any more";
  EXPECT_TRUE(
      refused(state.processor.ground.covariance[0][1], state.processor.ground.covariance[0][1] * 1.5));
  EXPECT_TRUE(refused(state.processor.ground.covariance[2][2],
                      state.processor.ground.scale[2] * state.processor.ground.scale[2] * 1.1));
  EXPECT_TRUE(refused(state.processor.ground.scale[1], 5e-324));
  EXPECT_TRUE(refused(state.processor.weather.noise, 0));
  EXPECT_TRUE(refused(state.processor.blur.images, 0)) << "what has seen no image knows nothing";
}

TEST_F(CostModelFile, whatCouldNotBeReadAgainIsNotWritten) {
  const CostModel good = learned();
  ASSERT_TRUE(writeCostModel(file, "llvmpipe", good).ok());
  const std::string before = text();
  CostModel::State state = good.state();
  state.processor.ground.coefficient[0] = kNan;
  CostModel bad;
  bad.restore(state);
  const auto written = writeCostModel(file, "llvmpipe", bad);
  ASSERT_FALSE(written.ok());
  EXPECT_NE(toString(written.findings())
                .find("processor.ground.coefficient[0]: expected 0..60000000000, found nan"),
            std::string::npos)
      << toString(written.findings());
  EXPECT_EQ(text(), before);
}

TEST_F(CostModelFile, aModelThatRestsThroughManyRunsStaysReadable) {
  // No rain falls in any of them, so nothing takes the distrust back.
  CostModel model = learned();
  for (int run = 0; run < 100; ++run) {
    ASSERT_TRUE(writeCostModel(file, "llvmpipe", model).ok());
    const auto state = readCostModel(file, "llvmpipe");
    ASSERT_TRUE(state.ok()) << "run " << run << ": " << toString(state.findings());
    model.restore(*state);
  }
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
  EXPECT_EQ(other.state().processor.ground.coefficient, model.state().processor.ground.coefficient);
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
