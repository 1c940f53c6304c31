#include "app/tune/search_space.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "trimtab/preset/preset.h"

namespace trimtab::tune {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::vector<std::string> namesOf(const SearchSpace& space) {
  std::vector<std::string> names;
  for (const Axis& axis : space.axes()) names.push_back(axis.name);
  return names;
}

std::string refusal(const std::vector<std::string>& free, const TuningParameters& start = {}) {
  const Result<SearchSpace> space = SearchSpace::make(start, free);
  return space ? std::string() : toString(space.findings());
}

TuningParameters lowLevel() {
  return loadPreset("low-level").value().parameters;
}

TEST(SearchSpace, freesScalarsGroupsPointsBandsTermsAndRules) {
  const auto space = SearchSpace::make(lowLevel(), {"lod.scale", "fuzzy.altitude.curve_ft", "fuzzy.bands_px",
                                                    "policy.terms", "policy.rules", "hold.enabled"});
  ASSERT_TRUE(space) << toString(space.findings());
  const std::vector<std::string> names = namesOf(*space);
  for (const char* name :
       {"lod.scale", "fuzzy.altitude.curve_ft point 1 x", "fuzzy.altitude.curve_ft point 5 y",
        "fuzzy.bands_px band 4 from", "policy.terms triangles many 1", "policy.rules 2 screen_space_error",
        "policy.rules 3 weight", "hold.enabled"})
    EXPECT_THAT(names, Contains(name));
  const auto group = SearchSpace::make({}, {"motion.*"});
  ASSERT_TRUE(group);
  EXPECT_GT(group->size(), 8u);
}

TEST(SearchSpace, aPresetComesBackToTheBit) {
  for (const std::string_view name : shippedPresets()) {
    const TuningParameters preset = loadPreset(std::string(name)).value().parameters;
    const auto space = SearchSpace::make(
        preset, {"lod.*", "objects.*", "fuzzy.*", "motion.*", "hold.*", "policy.terms", "policy.rules"});
    ASSERT_TRUE(space) << name << toString(space.findings());
    EXPECT_THAT(differences(space->at(space->placeOf(preset)), preset), testing::IsEmpty()) << name;
  }
}

TEST(SearchSpace, everyPlaceIsInOrderAndWithinItsEnds) {
  const TuningParameters start = lowLevel();
  const auto space = SearchSpace::make(start, {"fuzzy.altitude.curve_ft", "fuzzy.bands_px", "lod.scale=1..3",
                                               "objects.small_feature_px", "policy.terms", "policy.rules"});
  ASSERT_TRUE(space) << toString(space.findings());
  std::mt19937 random(3);
  std::size_t valid = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<double> place(space->size());
    // The ends are tried too.
    for (double& at : place) {
      const double number = std::uniform_real_distribution<double>(-0.2, 1.2)(random);
      at = std::clamp(number, 0.0, 1.0);
    }
    const TuningParameters moved = space->at(place);
    const auto points = moved.altitude.curve.span();
    EXPECT_TRUE(std::is_sorted(points.begin(), points.end(),
                               [](const CurvePoint& a, const CurvePoint& b) { return a.x < b.x; }));
    EXPECT_GE(moved.lod.scale.value(), 1);
    EXPECT_LE(moved.lod.scale.value(), 3);
    valid += validate(moved).ok();
  }
  EXPECT_GT(valid, 270u) << "few places break a rule";
}

TEST(SearchSpace, endsAreExactAndTheMiddleOfALogarithmIsItsMean) {
  const auto space = SearchSpace::make({}, {"lod.screen_space_error_px=1..16"});
  ASSERT_TRUE(space);
  const auto at = [&](double place) { return space->at(std::vector{place}).lod.screenSpaceError.value(); };
  EXPECT_EQ(at(0), 1);
  EXPECT_EQ(at(1), 16);
  EXPECT_DOUBLE_EQ(at(0.5), 4);
}

TEST(SearchSpace, refusesWhatNoSearchCanDo) {
  EXPECT_THAT(refusal({}), HasSubstr("at least one parameter"));
  EXPECT_THAT(refusal({"lod.sclae"}), HasSubstr("lod.sclae"));
  EXPECT_THAT(refusal({"lod.scale", "lod.scale"}), HasSubstr("each parameter once"));
  EXPECT_THAT(refusal({"lod.scale", "lod.*"}), HasSubstr("each parameter once"));
  EXPECT_THAT(refusal({"lod.scale=3..1"}), HasSubstr("LOW below HIGH"));
  EXPECT_THAT(refusal({"lod.scale=nan..2"}), HasSubstr("LOW below HIGH"));
  EXPECT_THAT(refusal({"lod.*=1..2"}), HasSubstr("LOW below HIGH"));
  EXPECT_THAT(refusal({"lod.scale=2..3"}), HasSubstr("where the preset is, 1"));
  EXPECT_THAT(refusal({"lod.scale=0.5..1e9"}), HasSubstr("ends within"));
  EXPECT_THAT(refusal({"host.silence_after_ms"}), HasSubstr("trades time for error"));
  EXPECT_THAT(refusal({"view.*"}), HasSubstr("trades time for error"));
  EXPECT_THAT(refusal({"objects.light_px"}), HasSubstr("trades time for error"));
  // A preset without a policy has no rules to move.
  EXPECT_THAT(refusal({"policy.rules"}), HasSubstr("at least one parameter"));
}

}  // namespace
}  // namespace trimtab::tune
