#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "ig_support.h"

/// What images cost, kept from one run of the image generator to the next in the folder of the user's caches.
namespace trimtab {
namespace {

using test::IgProcess;
using testing::HasSubstr;
using testing::Not;

/// The first number of a model is in this line of its file.
constexpr std::size_t kFirst = 2;
constexpr unsigned kImages = 300;

class IgCostModel : public testing::Test {
 protected:
  IgCostModel() {
    if (const char* set = std::getenv("XDG_CACHE_HOME")) before_ = set;
    ::setenv("XDG_CACHE_HOME", dir_.path().c_str(), 1);
    const auto held = test::edited([](TuningParameters& p) { p.hold.enabled = true; });
    test::writeFile(dir_ / "preset.json", test::exported(held));
    test::writeFile(dir_ / "flight.csv", flightCsv(test::weavingFlight(kImages)));
  }
  ~IgCostModel() override {
    before_ ? ::setenv("XDG_CACHE_HOME", before_->c_str(), 1) : ::unsetenv("XDG_CACHE_HOME");
  }

  struct Flown {
    std::string err;
    std::uint64_t unknown = 0;  ///< images whose cost was not known yet
  };
  Flown fly() const {
    IgProcess ig({"--preset", (dir_ / "preset.json").string(), "--terrain", test::smallTerrain().string(),
                  "--flight", (dir_ / "flight.csv").string(), "--headless", "--size", "160x100", "--json"});
    EXPECT_EQ(ig.end(), 0) << ig.err();
    return {ig.err(), ig.summary()["hold"]["cost_unknown"]};
  }
  /// Returns the images of a run whose cost was not known yet, the fewest of three: where another program
  /// takes the machine, what was learned before is off, and is learned anew.
  std::uint64_t unknownAtBest() const {
    std::uint64_t fewest = fly().unknown;
    for (int more = 0; more < 2 && fewest > 0; ++more) fewest = std::min(fewest, fly().unknown);
    return fewest;
  }
  std::filesystem::path file() const {
    for (const auto& entry : std::filesystem::directory_iterator(dir_ / "trimtab")) return entry.path();
    return {};
  }
  std::vector<std::string> lines() const {
    std::istringstream in(test::readFile(file()));
    std::vector<std::string> all;
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }
  void write(const std::vector<std::string>& lines) const {
    std::string text;
    for (const std::string& line : lines) text += line + '\n';
    test::writeFile(file(), text);
  }

  test::ScratchDir dir_;
  std::optional<std::string> before_;
};

TEST_F(IgCostModel, withANumberThatNoneCanHaveIsNamedAndLearnedAnew) {
  fly();
  const std::vector<std::string> good = lines();
  ASSERT_GT(good.size(), kFirst);
  EXPECT_EQ(unknownAtBest(), 0U) << "what was learned is known from the first image on";
  struct Damage {
    std::size_t line;
    const char *number, *key;
  };
  for (const Damage& damage : {Damage{0, "1e308", "processor.ground.coefficient[0]"},
                               {1, "1e150", "processor.ground.coefficient[1]"},
                               {3, "1e308", "processor.ground.covariance[0][0]"},
                               {12, "5e-324", "processor.ground.scale[0]"},
                               {15, "5e-324", "processor.ground.noise"},
                               {3, "nan", ""}}) {
    SCOPED_TRACE(std::string(damage.number) + " as " + damage.key);
    std::vector<std::string> damaged = good;
    damaged[kFirst + damage.line] = damage.number;
    write(damaged);
    const Flown flown = fly();
    EXPECT_THAT(flown.err, HasSubstr("warning: " + file().string() + ':' +
                                     std::to_string(kFirst + damage.line + 1) + ": " + damage.key));
    EXPECT_GT(flown.unknown, 0U);
    // Some 15 images where little else runs, and more where another program takes the machine.
    EXPECT_LT(flown.unknown, kImages / 2U) << "and then it was known";
    for (const std::string& line : lines()) {
      EXPECT_THAT(line, Not(HasSubstr("nan")));
      EXPECT_THAT(line, Not(HasSubstr("inf")));
    }
    EXPECT_EQ(unknownAtBest(), 0U);
  }
}

TEST_F(IgCostModel, thatPredictsNothingRightIsLearnedAnew) {
  fly();
  std::vector<std::string> stuck = lines();
  // An image would take ten seconds; and so little is uncertain that nothing could be learned.
  stuck[kFirst] = "10000";
  for (std::size_t i = 3; i < 12; ++i) stuck[kFirst + i] = "0";
  for (std::size_t i = 0; i < 3; ++i) {
    stuck[kFirst + 3 + 4 * i] = "1e-20";
    stuck[kFirst + 12 + i] = "1e-10";
  }
  write(stuck);
  fly();
  EXPECT_LT(std::stod(lines()[kFirst]), 1000);
}

}  // namespace
}  // namespace trimtab
