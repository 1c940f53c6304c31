#include <gmock/gmock.h>

#include <random>

#include "trimtab/decision/decide.h"
#include "trimtab/fuzzy/membership.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/number.h"

/// Presets of before had a rule base beside the policy, documents A and B's Eq. (2). It is read as a policy,
/// and decides what it decided.
namespace trimtab {
namespace {

using testing::HasSubstr;

struct Rule {
  const char *altitude, *pitch;
  double weight, output;
};

std::string presetWith(const std::vector<Rule>& rules, const std::string& more = "") {
  std::string list;
  for (const Rule& r : rules)
    list += (list.empty() ? "" : ", ") + std::string("{\"altitude\": \"") + r.altitude + "\", \"pitch\": \"" +
            r.pitch + "\", \"weight\": " + numberText(r.weight) + ", \"output\": " + numberText(r.output) +
            "}";
  return R"({"format": "trimtab-preset", "version": 3, "parameters": {"fuzzy.combination": "rules", )" +
         std::string("\"fuzzy.rules\": [") + list + "]" + more + "}}";
}

/// Eq. (2) as it was computed: u = sum(lambda mu u) / sum(lambda mu), within the outputs that count.
double equationTwo(const std::vector<Rule>& rules, double altitude, double pitch) {
  double weights = 0, outputs = 0, low = BandList::kTop, high = 0;
  for (const Rule& r : rules) {
    const double a = std::string(r.altitude) == "any" ? 1 : r.altitude[0] == 'l' ? altitude : 1 - altitude;
    const double p = std::string(r.pitch) == "any" ? 1 : r.pitch[0] == 'd' ? pitch : 1 - pitch;
    const double weight = r.weight * std::min(a, p);
    if (!(weight > 0)) continue;
    low = std::min(low, r.output), high = std::max(high, r.output);
    weights += weight, outputs += weight * r.output;
  }
  return std::clamp(outputs / weights, low, high);
}

FrameInput inFlight(double feet, double pitch) {
  FrameInput input;
  input.state.position.height = Feet{feet}.as<Metres>();
  input.state.attitude.pitch = Degrees{pitch};
  return input;
}

TEST(FormerRules, decideAsTheyDidToTheBit) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const char *altitudes[] = {"any", "low", "high"}, *pitches[] = {"any", "down", "up"};
  const char* readings[] = {"\"table\"", "\"equation_a\"", "\"equation_b\""};
  for (int round = 0; round < 60; ++round) {
    // One rule without a condition, so that some rule always fires.
    std::vector<Rule> rules{{"any", "any", 0.01 + 0.9 * unit(random), 2 * unit(random)}};
    for (std::size_t more = random() % 12; more > 0; --more)
      rules.push_back({altitudes[random() % 3], pitches[random() % 3], more == 3 ? 0 : unit(random),
                       more == 5 ? 2 : 2 * unit(random)});
    const auto preset = parsePreset(
        presetWith(rules,
                   std::string(", \"fuzzy.altitude.reading\": ") + readings[round % 3] +
                       ", \"fuzzy.pitch.reading\": " + (round % 2 ? "\"rounded_step\"" : "\"linear\"")),
        "p.json");
    ASSERT_TRUE(preset) << toString(preset.findings());
    EXPECT_THAT(toString(preset.findings()),
                HasSubstr("p.json:1: fuzzy.rules: expected rules of the policy"));
    const auto parameters = validate(preset->parameters);
    ASSERT_TRUE(parameters) << toString(parameters.findings());
    DecisionMemory memory;
    for (int i = 0; i < 200; ++i) {
      FrameInput input = inFlight(std::round(9000 * unit(random)), i % 9 == 0 ? 0 : 90 * unit(random) - 45);
      input.state.time = i / 60.0;
      const FrameDecision d = decide(input, *parameters, memory);
      ASSERT_EQ(d.totalMembership, equationTwo(rules, d.altitudeMembership, d.pitchMembership))
          << round << ": " << d.altitudeFt << " ft, " << d.pitchDeg << " deg";
    }
  }
}

TEST(FormerRules, ofVersion2AndOfAnIniExportAreReadToo) {
  const auto two = parsePreset(R"({"format": "trimtab-preset", "version": 2, "parameters": {)"
                               R"("fuzzy.combination": "rules", "fuzzy.rules.low_up_output": 1.25}})",
                               "two.json");
  ASSERT_TRUE(two) << toString(two.findings());
  const std::vector<Rule> shipped{
      {"low", "down", 1, 2}, {"low", "up", 1, 1.25}, {"high", "down", 1, 0.5}, {"high", "up", 1, 0}};
  DecisionMemory memory;
  const FrameDecision d = decide(inFlight(5500, -3), *validate(two->parameters), memory);
  EXPECT_EQ(d.totalMembership, equationTwo(shipped, d.altitudeMembership, d.pitchMembership));
  // An INI export has the list as text.
  const auto ini =
      parsePreset(R"({"format": "trimtab-preset", "version": 3, "parameters": {)"
                  R"("fuzzy.combination": "rules", "fuzzy.rules": "low&down*2=1.5 any*1=0.25"}})",
                  "ini.json");
  ASSERT_TRUE(ini) << toString(ini.findings());
  EXPECT_THAT(ini->parameters.policy.rules.line,
              testing::ElementsAre(
                  "if altitude_membership is low and pitch_membership is down then occlusion = 1.5 # Eq. (2)",
                  "if altitude_membership is any then occlusion = 0.25 with 0.5 # Eq. (2)"));
}

TEST(FormerRules, keepThePolicyThatThePresetHas) {
  const std::string own = R"(, "policy.terms": ["speed fast = ramp 100 400"],
      "policy.rules": ["if speed is fast then lod_scale = 2"])";
  const auto off = parsePreset(presetWith({{"low", "any", 1, 2}}, own), "p.json");
  ASSERT_TRUE(off) << toString(off.findings());
  EXPECT_THAT(off->parameters.policy.rules.line,
              testing::ElementsAre("off if speed is fast then lod_scale = 2",
                                   "if altitude_membership is low then occlusion = 2 # Eq. (2)"));
  EXPECT_THAT(toString(off.findings()), HasSubstr("states in which none fires"));
  const auto on = parsePreset(
      presetWith({{"low", "any", 4, 2}, {"any", "up", 1, 0}}, own + ", \"policy.enabled\": true"), "p.json");
  ASSERT_TRUE(on) << toString(on.findings());
  EXPECT_THAT(on->parameters.policy.rules.line,
              testing::ElementsAre("if speed is fast then lod_scale = 2",
                                   "if altitude_membership is low then occlusion = 2 # Eq. (2)",
                                   "if not pitch_membership is down then occlusion = 0 with 0.25 # Eq. (2)"));
  EXPECT_TRUE(validate(on->parameters));
}

TEST(FormerRules, areLeftOutWhereTheyDecidedNothingAndRefusedWhereTheyAreNone) {
  const auto unused = parsePreset(
      R"({"format": "trimtab-preset", "version": 3, "parameters": {"fuzzy.rules": [{"weight": 1, "output": 2}]}})",
      "p.json");
  ASSERT_TRUE(unused);
  EXPECT_FALSE(unused->parameters.policy.enabled);
  EXPECT_THAT(toString(unused.findings()), HasSubstr("it is left out"));
  for (const char* bad :
       {"{}", "7", R"([{"weight": 1}])", R"([{"weight": -1, "output": 2}])",
        R"([{"weight": 1, "output": 2.5}])", R"([{"altitude": "middle", "weight": 1, "output": 2}])",
        R"([{"weight": "1", "output": 2}])", R"([{"roll": "left", "weight": 1, "output": 2}])"}) {
    const auto preset = parsePreset(
        std::string(R"({"format": "trimtab-preset", "version": 3, "parameters": {"fuzzy.rules": )") + bad +
            "}}",
        "p.json");
    EXPECT_FALSE(preset) << bad;
    EXPECT_THAT(toString(preset.findings()), HasSubstr("p.json:1: fuzzy.rules: expected rules with")) << bad;
  }
}

}  // namespace
}  // namespace trimtab
