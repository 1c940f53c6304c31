#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/policy/random_policy.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

PolicyTerm term(Signal signal, const char* name, const char* shape) {
  auto read = readShape(shape, "test");
  EXPECT_TRUE(read) << toString(read.findings());
  PolicyTerm made = read ? *read : PolicyTerm{};
  made.signal = signal;
  made.name = name;
  return made;
}

PolicyRule rule(const char* text) {
  auto read = readPolicyRule(text, "test");
  EXPECT_TRUE(read) << toString(read.findings());
  return read ? *read : PolicyRule{};
}

double at(const char* shape, double x) {
  return membershipOf(term(Signal::speed, "t", shape), x);
}

TEST(PolicyTerms, haveTheValuesOfTheirFormulas) {
  EXPECT_EQ(at("points 0 0 10 1 20 0.5", 5), 0.5);
  EXPECT_EQ(at("points 0 0 10 1 20 0.5", -kInfinity), 0);
  EXPECT_EQ(at("points 0 0 10 1 20 0.5", kInfinity), 0.5);
  EXPECT_EQ(at("points 0 0.25 10 0.25 10 1 20 1", 10), 1) << "at a step the later point counts";
  EXPECT_EQ(at("points 0 0.25 10 0.25 10 1 20 1", std::nextafter(10.0, 0.0)), 0.25);
  EXPECT_EQ(at("triangle 0 10 20", 10), 1);
  EXPECT_EQ(at("triangle 0 10 20", 15), 0.5);
  EXPECT_EQ(at("triangle 0 0 20", 0), 1) << "an upright flank";
  EXPECT_EQ(at("triangle 0 20 20", 20), 1);
  EXPECT_EQ(at("triangle 0 10 20", 20), 0);
  EXPECT_EQ(at("trapezoid -inf 0 10 20", -1e300), 1);
  EXPECT_EQ(at("trapezoid 0 10 20 inf", kInfinity), 1);
  EXPECT_EQ(at("trapezoid 0 10 10 20", 10), 1);
  EXPECT_EQ(at("ramp 10 20", 12.5), 0.25);
  EXPECT_EQ(at("ramp 20 10", 12.5), 0.75);
  EXPECT_EQ(at("ramp 20 10", kInfinity), 0);
  EXPECT_NEAR(at("gaussian 5 2", 7), std::exp(-0.5), 1e-15);
  EXPECT_EQ(at("gaussian 5 1e-12", 5), 1);
  EXPECT_EQ(at("gaussian 5 1e-12", 6), 0);
  EXPECT_EQ(at("bell 5 2 3", 7), 0.5);
  EXPECT_EQ(at("bell 5 2 3", kInfinity), 0);
  EXPECT_EQ(at("sigmoid 5 2", 5), 0.5);
  EXPECT_EQ(at("sigmoid 5 2", -kInfinity), 0);
  EXPECT_EQ(at("sigmoid 5 -2", -kInfinity), 1);
  for (const char* shape :
       {"points 0 0 1 1", "triangle 0 1 2", "ramp 0 1", "gaussian 0 1", "bell 0 1 1", "sigmoid 0 1"})
    EXPECT_TRUE(std::isnan(at(shape, kNan))) << shape;
}

TEST(PolicyTerms, stayBetweenZeroAndOneForAnyNumbersThatCompile) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 300; ++i)
    for (const PolicyTerm& each : test::randomPolicy(random, {}).terms)
      for (const double x : {-kInfinity, -1e300, -1.0, 0.0, 1e-300, 1.0, 777.7, 1e300, kInfinity}) {
        const double mu = membershipOf(each, x);
        ASSERT_TRUE(mu >= 0 && mu <= 1) << shapeText(each) << " at " << x;
      }
}

/// A policy over height and speed.
Policy lowAndFast() {
  Policy policy;
  policy.terms = {term(Signal::above_ground, "low", "ramp 2000 1000"),
                  term(Signal::above_ground, "high", "ramp 1000 2000"),
                  term(Signal::speed, "fast", "ramp 200 400")};
  return policy;
}

TEST(PolicyRules, areTheWeightedMeanOfEq2ForEachLeverByItself) {
  Policy policy = lowAndFast();
  policy.rules = {rule("if above_ground is low then screen_space_error = 2, lod_scale = 1"),
                  rule("if above_ground is high and speed is fast then screen_space_error = 8 with 0.5")};
  const auto compiled = compile(policy, "test");
  ASSERT_TRUE(compiled) << toString(compiled.findings());
  SignalValues signals;
  signals[Signal::above_ground] = 1250;  // low 0.75, high 0.25
  signals[Signal::speed] = 300;          // fast 0.5
  PolicyDecision d;
  compiled->decide(signals, d);
  EXPECT_EQ(d.firing[0], 0.75);
  EXPECT_EQ(d.firing[1], 0.125);
  EXPECT_DOUBLE_EQ(d.target[Lever::screen_space_error], (0.75 * 2 + 0.125 * 8) / 0.875);
  EXPECT_EQ(d.target[Lever::lod_scale], 1);
  EXPECT_TRUE(std::isnan(d.target[Lever::render_scale])) << "no rule moves it";
  EXPECT_DOUBLE_EQ(compiled->share(1, Lever::screen_space_error, d), 0.125 / 0.875);
  EXPECT_EQ(compiled->share(1, Lever::lod_scale, d), 0);
  EXPECT_TRUE(compiled->moves(Lever::lod_scale));
  EXPECT_FALSE(compiled->moves(Lever::blur_strength));
  EXPECT_EQ(d.unknownAsked, 0u);
}

TEST(PolicyRules, doNotFireForASignalThatNobodyKnowsAndSaySo) {
  Policy policy = lowAndFast();
  policy.rules = {rule("if above_ground is low or speed is fast then lod_scale = 2"),
                  rule("if speed is fast and above_ground is any then lod_scale = 4")};
  const auto compiled = compile(policy, "test");
  ASSERT_TRUE(compiled) << toString(compiled.findings());
  SignalValues signals;
  signals[Signal::speed] = 400;
  PolicyDecision d;
  compiled->decide(signals, d);
  EXPECT_EQ(d.firing[0], 0) << "although the other part is 1";
  EXPECT_EQ(d.firing[1], 1) << "any asks nothing";
  EXPECT_EQ(d.target[Lever::lod_scale], 4);
  EXPECT_EQ(d.unknownAsked, 1u << static_cast<unsigned>(Signal::above_ground));
  EXPECT_TRUE(std::isnan(d.membership[0]));
}

TEST(PolicyRules, bindNotBeforeAndBeforeOr) {
  Policy policy = lowAndFast();
  const auto value = [&](const char* condition, double height, double speed) {
    policy.rules = {rule((std::string("if ") + condition + " then lod_scale = 2").c_str())};
    const auto compiled = compile(policy, "test");
    EXPECT_TRUE(compiled) << toString(compiled.findings());
    SignalValues signals;
    signals[Signal::above_ground] = height;
    signals[Signal::speed] = speed;
    PolicyDecision d;
    if (compiled) compiled->decide(signals, d);
    return d.firing.empty() ? kNan : d.firing[0];
  };
  EXPECT_EQ(value("above_ground is low or above_ground is high and speed is fast", 1000, 200), 1);
  EXPECT_EQ(value("(above_ground is low or above_ground is high) and speed is fast", 1000, 200), 0);
  EXPECT_EQ(value("not above_ground is low and speed is fast", 1000, 400), 0);
  EXPECT_EQ(value("not (above_ground is low and speed is fast)", 1000, 200), 1);
  EXPECT_EQ(value("above_ground is very low", 1500, 0), 0.25);
  EXPECT_EQ(value("above_ground is not very low", 1500, 0), 0.75);
  EXPECT_EQ(value("above_ground is very not low", 1500, 0), 0.25);
  EXPECT_EQ(value("above_ground is somewhat low", 1750, 0), 0.5);
  EXPECT_EQ(value("above_ground is extremely low", 1500, 0), 0.5);
  EXPECT_EQ(value("above_ground is seldom low", 1500, 0), 0.5);
  policy.norm = PolicyNorm::product;
  EXPECT_EQ(value("above_ground is low and speed is fast", 1500, 300), 0.25);
  EXPECT_EQ(value("above_ground is low or speed is fast", 1500, 300), 0.75);
}

TEST(PolicyRules, neverLeaveWhatTheRulesThatFireAskFor) {
  std::mt19937_64 random(5);
  PolicyDecision d;
  for (int i = 0; i < 500; ++i) {
    const Policy policy = test::randomPolicy(random, {});
    const auto compiled = compile(policy, "test");
    ASSERT_TRUE(compiled) << toString(compiled.findings());
    for (int k = 0; k < 20; ++k) {
      SignalValues signals = test::randomSignals(random, policy);
      if (k % 5 == 4) signals.value[static_cast<std::size_t>(k) % kSignals] = k % 2 ? kInfinity : kNan;
      compiled->decide(signals, d);
      for (const LeverRow& row : kLeverRows) {
        double least = kInfinity, most = -kInfinity;
        for (std::size_t r = 0; r < policy.rules.size(); ++r)
          for (const LeverSetting& s : policy.rules[r].settings)
            if (s.lever == row.lever && d.firing[r] > 0)
              least = std::min(least, s.value), most = std::max(most, s.value);
        const double value = d.target[row.lever];
        ASSERT_TRUE(least > most ? std::isnan(value) : value >= least && value <= most)
            << row.key << " " << value;
      }
    }
  }
}

TEST(PolicyText, comesBackAsItWas) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 100; ++i) {
    const Policy policy = test::randomPolicy(random, {});
    for (const PolicyRule& each : policy.rules) {
      const auto read = readPolicyRule(ruleText(each), "test");
      ASSERT_TRUE(read) << toString(read.findings());
      EXPECT_EQ(ruleText(*read), ruleText(each));
      EXPECT_EQ(read->settings, each.settings);
      EXPECT_EQ(read->weight, each.weight);
    }
    for (const PolicyTerm& each : policy.terms) {
      const auto read = readShape(shapeText(each), "test");
      ASSERT_TRUE(read) << toString(read.findings());
      EXPECT_EQ(read->numbers, each.numbers);
      EXPECT_EQ(read->shape, each.shape);
    }
  }
}

struct BadPolicy {
  const char *text, *expected, *found;
};

TEST(PolicyBadInput, ofARuleIsRefusedWithPlaceExpectedAndFound) {
  for (const BadPolicy& bad :
       {BadPolicy{"", "if CONDITION then LEVER = VALUE", "nothing"},
        BadPolicy{"if then lod_scale = 2", "a condition between if and then", "if then"},
        BadPolicy{"if speed is fast", "a condition between if and then", "if speed"},
        BadPolicy{"if speed is fast then", "a lever after then", "nothing"},
        BadPolicy{"if speed is fast then colour = 2", "a lever after then", "colour"},
        BadPolicy{"if speed is fast then lod_scale 2", "= after the lever", "2"},
        BadPolicy{"if speed is fast then lod_scale = two", "a number", "two"},
        BadPolicy{"if speed is fast then lod_scale = 2 with", "a weight", "nothing"},
        BadPolicy{"if speed is fast then lod_scale = 2 2", "the end of the rule", "2"}}) {
    const auto read = readPolicyRule(bad.text, "rules.txt:7");
    ASSERT_FALSE(read) << bad.text;
    const std::string text = toString(read.findings());
    EXPECT_NE(text.find("rules.txt:7"), std::string::npos) << text;
    EXPECT_NE(text.find(bad.expected), std::string::npos) << text;
    EXPECT_NE(text.find(bad.found), std::string::npos) << text;
  }
}

TEST(PolicyBadInput, ofAConditionIsRefusedByTheRulesNumber) {
  const std::string deep(200, '('), tooMany = [] {
    std::string text = "speed is fast";
    for (int i = 0; i < 70; ++i) text += " and speed is fast";
    return text;
  }();
  for (const BadPolicy& bad :
       {BadPolicy{"pressure is low", "a signal: altitude", "pressure"},
        BadPolicy{"speed fast", "is after the signal", "fast"},
        BadPolicy{"speed is slow", "a term of speed: fast", "slow"},
        BadPolicy{"roll is steep", "which has none", "steep"},
        BadPolicy{"speed is fast and", "a signal", "nothing"}, BadPolicy{"(speed is fast", ")", "nothing"},
        BadPolicy{"speed is fast speed", "and, or, or the end", "speed"},
        BadPolicy{"speed is very", "a term", "nothing"}, BadPolicy{deep.c_str(), "less nesting", "("},
        BadPolicy{tooMany.c_str(), "at most 64", "141"}}) {
    Policy policy = lowAndFast();
    policy.rules = {rule("if speed is fast then lod_scale = 2"), rule("if speed is fast then lod_scale = 2")};
    policy.rules[1].condition = bad.text;
    const auto compiled = compile(policy, "p.json");
    ASSERT_FALSE(compiled) << bad.text;
    ASSERT_EQ(compiled.findings().size(), 1u) << toString(compiled.findings());
    EXPECT_EQ(compiled.findings()[0].key, "rules.2");
    const std::string text = toString(compiled.findings());
    EXPECT_NE(text.find(bad.expected), std::string::npos) << text;
    EXPECT_NE(text.find(bad.found), std::string::npos) << text;
  }
}

TEST(PolicyBadInput, ofTermsWeightsAndSettingsIsRefusedAllAtOnce) {
  Policy policy = lowAndFast();
  policy.terms.push_back(policy.terms[0]);
  for (const char* shape : {"points 0 0", "points 0 0 1 2", "points 5 0 1 1", "points 1 0 1 0.5 1 1",
                            "triangle 5 5 5", "triangle 5 4 6", "triangle 1 2", "trapezoid 0 inf inf inf",
                            "trapezoid 3 3 3 3", "ramp 4 4", "gaussian 0 0", "gaussian 0 -1", "bell 0 0 1",
                            "bell 0 1 0", "sigmoid 0 0", "ramp nan 1", "gaussian 1e13 1", "ramp 0 inf"}) {
    policy.terms.push_back(term(Signal::roll, ("t" + std::to_string(policy.terms.size())).c_str(), shape));
  }
  policy.terms.push_back(term(Signal::roll, "very", "ramp 0 1"));
  policy.terms.push_back(term(Signal::roll, "two words", "ramp 0 1"));
  policy.rules = {rule("if speed is fast then lod_scale = 99"), rule("if speed is fast then lod_scale = nan"),
                  rule("if speed is fast then lod_scale = 2 with 1.5"),
                  rule("if speed is fast then lod_scale = 2 with nan")};
  policy.rules.push_back({"speed is fast", {}, 1, true, ""});
  const auto compiled = compile(policy, "p.json");
  ASSERT_FALSE(compiled);
  EXPECT_EQ(compiled.findings().size(), 1u + 18 + 2 + 5) << toString(compiled.findings());
  policy = lowAndFast();
  policy.rules.assign(10000, rule("if speed is fast then lod_scale = 2"));
  const auto many = compile(policy, "p.json");
  ASSERT_FALSE(many);
  EXPECT_EQ(toString(many.findings()), "p.json: rules: expected at most 1024, found 10000");
}

TEST(PolicyRules, ofWeightZeroOrSwitchedOffChangeNothing) {
  Policy policy = lowAndFast();
  policy.rules = {rule("if speed is fast then lod_scale = 2 with 0"),
                  rule("if speed is fast then lod_scale = 4")};
  policy.rules[1].enabled = false;
  const auto compiled = compile(policy, "test");
  ASSERT_TRUE(compiled);
  SignalValues signals;
  signals[Signal::speed] = 400;
  PolicyDecision d;
  compiled->decide(signals, d);
  EXPECT_TRUE(std::isnan(d.target[Lever::lod_scale]));
  EXPECT_FALSE(compiled->moves(Lever::lod_scale));
}

}  // namespace
}  // namespace trimtab
