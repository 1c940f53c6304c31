#include "trimtab/fuzzy/rule_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <vector>

#include "fuzzylite_oracle.h"
#include "tests/support.h"
#include "trimtab/fuzzy/combination.h"
#include "trimtab/fuzzy/membership.h"
#include "trimtab/preset/rules.h"
#include "trimtab/preset/table.h"

namespace trimtab {
namespace {

using test::Grid;
using ::testing::HasSubstr;

struct Language {
  RuleFormat format;
  const char* ending;
};
constexpr Language kLanguages[] = {{RuleFormat::fuzzylite, "fll"}, {RuleFormat::matlab, "fis"}};

/// Rising points, some of them steps, and rules of every pair of conditions.
TuningParameters randomRules(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  TuningParameters p;
  const auto curve = [&](CurvePoints& c, double low, double width) {
    c.size = 0;
    for (double x = low; c.size < 7; x += c.size % 3 == 2 ? 0 : width * (0.2 + unit(random)))
      c.point[c.size++] = {x, unit(random)};
  };
  curve(p.altitude.curve, -500, 2000);
  curve(p.pitch.curve, -60, 14);
  p.scheme.combination = Combination::rules;
  p.scheme.rules.size = 0;
  for (int i = 0; i < 12; ++i)
    p.scheme.rules.rule[p.scheme.rules.size++] = {static_cast<AltitudeCondition>(i % 9 / 3),
                                                  static_cast<PitchCondition>(i % 3),
                                                  i % 5 == 4 ? 0 : 3 * unit(random), 2 * unit(random)};
  return p;
}

std::string written(const TuningParameters& p, RuleFormat format) {
  const auto text = ruleFileText(p, "a name", format);
  EXPECT_TRUE(text.ok()) << toString(text.findings());
  return text ? *text : std::string();
}

void expectSameRules(const TuningParameters& read, const TuningParameters& p) {
  EXPECT_EQ(read.scheme.rules, p.scheme.rules);
  EXPECT_EQ(static_cast<const CurvePoints&>(read.altitude.curve), p.altitude.curve);
  EXPECT_EQ(static_cast<const CurvePoints&>(read.pitch.curve), p.pitch.curve);
  EXPECT_EQ(read.scheme.combination, Combination::rules);
}

TEST(RuleFile, readsBackEveryNumberOfBothLanguages) {
  std::mt19937_64 random(21);
  for (int round = 0; round < 200; ++round) {
    const TuningParameters p = randomRules(random);
    for (const Language& language : kLanguages) {
      const auto read = readRuleFile(written(p, language.format), "f", language.format, {});
      ASSERT_TRUE(read.ok()) << toString(read.findings());
      expectSameRules(*read, p);
      EXPECT_TRUE(validate(*read).ok());
    }
  }
}

TEST(RuleFile, isWrittenAsItWasWhenTheseFilesWereKept) {
  for (const Language& language : kLanguages)
    EXPECT_EQ(
        *ruleFileText({}, "default", language.format),
        test::readFile(test::sourceDir() / "tests/data/rules" / (std::string("default.") + language.ending)));
}

TEST(RuleFile, keepsEverythingElseOfThePresetItIsTakenInto) {
  TuningParameters onto;
  onto.scheme.hysteresis = Membership{0.01};
  onto.scheme.bands = {{0.3, 64, 64}};
  onto.lod.scale = Ratio{4};
  onto.altitude.reading = AltitudeReading::equation_a;
  onto.pitch.reading = PitchReading::rounded_step;
  const auto read = readRuleFile(written({}, RuleFormat::fuzzylite), "f", RuleFormat::fuzzylite, onto);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->scheme.bands, onto.scheme.bands);
  EXPECT_EQ(read->scheme.hysteresis, onto.scheme.hysteresis);
  EXPECT_EQ(read->lod.scale, onto.lod.scale);
  EXPECT_EQ(read->altitude.reading, AltitudeReading::table) << "the reading that uses the curve";
  EXPECT_EQ(read->pitch.reading, PitchReading::linear);
}

#define NEEDS_FUZZYLITE() \
  if (!test::fuzzylitePresent()) GTEST_SKIP() << "needs the fuzzylite program"

/// The grid and places just beside every point of a curve; not nearer, because a rule that fires by less than
/// 1e-6 does not fire to fuzzylite.
Grid gridOf(const TuningParameters& p, int altitudes, int pitches) {
  Grid grid = test::gridFor(p.altitude, p.pitch, altitudes, pitches);
  for (const CurvePoint& point : p.altitude.curve.span()) grid.altitude.push_back(point.x - 0.5);
  for (const CurvePoint& point : p.pitch.curve.span()) grid.pitch.push_back(point.x - 0.01);
  return grid;
}

void expectAgreement(const TuningParameters& p, const std::string& engine, const std::string& format,
                     const Grid& grid, double tolerance) {
  std::string error;
  const std::vector<double> theirs = test::byFuzzylite(engine, format, grid, error);
  ASSERT_EQ(error, "") << engine;
  ASSERT_EQ(theirs.size(), grid.size());
  std::size_t point = 0, differing = 0;
  double worst = 0;
  for (const double a : grid.altitude)
    for (const double pitch : grid.pitch) {
      const TotalMembership ours =
          combine(Combination::rules, p.scheme.rules, altitudeMembership(p.altitude, a),
                  pitchMembership(p.pitch, pitch));
      // MATLAB's language cannot say what no rule fires for.
      const double theirTotal = ours.anyFires || format == "fll" ? theirs[point] : 0;
      const double difference = std::abs(ours.total - theirTotal);
      worst = std::max(worst, difference);
      if (!(difference <= tolerance) && ++differing <= 5)
        ADD_FAILURE() << format << ": " << a << " ft, " << pitch << " deg: " << ours.total << " against "
                      << theirs[point];
      ++point;
    }
  EXPECT_EQ(differing, 0u);
  std::printf("fuzzylite by %s: %zu points, largest difference %.2g\n", format.c_str(), grid.size(), worst);
}

TEST(RuleFile, meansTheSameToFuzzyliteOverAHundredThousandPoints) {
  NEEDS_FUZZYLITE();
  const TuningParameters p;
  const Grid grid = gridOf(p, 401, 251);
  ASSERT_GE(grid.size(), 100000u);
  for (const Language& language : kLanguages)
    expectAgreement(p, written(p, language.format), language.ending, grid, 1e-9);
}

TEST(RuleFile, meansTheSameToFuzzyliteWithStepsAndEveryPairOfConditions) {
  NEEDS_FUZZYLITE();
  std::mt19937_64 random(22);
  for (int round = 0; round < 3; ++round) {
    const TuningParameters p = randomRules(random);
    for (const Language& language : kLanguages)
      expectAgreement(p, written(p, language.format), language.ending, gridOf(p, 91, 71), 1e-9);
  }
}

TEST(RuleFile, writesTheRoundedStepButForLevelFlightItself) {
  for (const auto& [step, limit] : {std::pair{0.017, 30.0}, {0.05, 30.0}, {0.0, 30.0}, {0.1, 0.0}}) {
    TuningParameters p;
    p.pitch.reading = PitchReading::rounded_step;
    p.pitch.step = Membership{step};
    p.pitch.limit = Degrees{limit};
    const auto text = ruleFileText(p, "n", RuleFormat::fuzzylite);
    ASSERT_TRUE(text.ok());
    ASSERT_EQ(text.findings().size(), 1u);
    EXPECT_EQ(text.findings()[0].severity, Severity::warning);
    const auto read = readRuleFile(*text, "f", RuleFormat::fuzzylite, {});
    ASSERT_TRUE(read.ok()) << toString(read.findings());
    for (double pitch = -89.95; pitch < 90; pitch += 0.1)
      EXPECT_NEAR(pitchMembership(read->pitch, pitch), pitchMembership(p.pitch, pitch), 1e-12) << pitch;
  }
}

TEST(RuleFile, isNotWrittenForThePrintedEquations) {
  TuningParameters p;
  p.altitude.reading = AltitudeReading::equation_b;
  const auto text = ruleFileText(p, "n", RuleFormat::matlab);
  ASSERT_FALSE(text.ok());
  EXPECT_EQ(text.findings()[0].key, "fuzzy.altitude.reading");
}

TEST(RuleFile, warnsOfWeightsThatMatlabDoesNotTake) {
  TuningParameters p;
  p.scheme.rules.rule[1].weight = 2;
  EXPECT_TRUE(ruleFileText(p, "n", RuleFormat::fuzzylite).findings().empty());
  ASSERT_EQ(ruleFileText(p, "n", RuleFormat::matlab).findings().size(), 1u);
}

TEST(RuleFile, readsWhatFuzzyliteConvertsTo) {
  NEEDS_FUZZYLITE();
  std::mt19937_64 random(23);
  std::vector<TuningParameters> all{{}};
  for (int i = 0; i < 3; ++i) all.push_back(randomRules(random));
  for (const TuningParameters& p : all)
    for (const auto& [from, to] : {std::pair{0, 1}, {1, 0}, {0, 0}, {1, 1}}) {
      const std::string text = test::convertedByFuzzylite(written(p, kLanguages[from].format),
                                                          kLanguages[from].ending, kLanguages[to].ending);
      ASSERT_NE(text, "");
      const auto read = readRuleFile(text, "f", kLanguages[to].format, {});
      ASSERT_TRUE(read.ok()) << toString(read.findings()) << text;
      ASSERT_EQ(read->scheme.rules.size, p.scheme.rules.size);
      for (double altitude = -600; altitude < 12000; altitude += 37.3)
        for (double pitch = -89; pitch < 90; pitch += 3.7) {
          const auto total = [&](const TuningParameters& q) {
            return combine(Combination::rules, q.scheme.rules, altitudeMembership(q.altitude, altitude),
                           pitchMembership(q.pitch, pitch))
                .total;
          };
          ASSERT_NEAR(total(*read), total(p), 1e-9) << altitude << " " << pitch;
        }
    }
}

TEST(RuleFile, readsOtherWaysToSayTheSame) {
  const std::string engine =
      "# by hand\nEngine: x\ndescription: y\n"
      "InputVariable: pitch\n  term: up Ramp -30 30\n"
      "InputVariable: altitude\n  term: low Trapezoid -2000 0 4000 8000  # ft\n"
      "OutputVariable: u\n  defuzzifier: WeightedAverage\n  default: nan\n  term: big Constant 2\n"
      "  term: small Constant 0.25\n"
      "RuleBlock:\n  conjunction: Minimum\n"
      "  rule: if altitude is not low and pitch is not up then u is big\n"
      "  rule: if altitude is any then u is small with 0.5\n";
  const auto read = readRuleFile(engine, "f", RuleFormat::fuzzylite, {});
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  EXPECT_EQ(toText(*findRow("fuzzy.rules"), read->scheme.rules), "high&down*1=2 any*0.5=0.25");
  EXPECT_EQ(toText(*findRow("fuzzy.pitch.curve_deg"), static_cast<const CurvePoints&>(read->pitch.curve)),
            "-30:1 30:0");
  const std::string fis =
      "% by hand\r\n[System]\r\nName='x'\r\nType='sugeno'\r\nAndMethod='min'\r\nDefuzzMethod='wtaver'\r\n"
      "[Input1]\r\nName='altitude'\r\nMF1='low':'linzmf',[4000 8000]\r\n"
      "[Input2]\r\nName='pitch'\r\nMF1='up':'linsmf',[-30 30]\r\n"
      "[Output1]\r\nName='u'\r\nMF1='big':'constant',[2]\r\n[Rules]\r\n-1 -1, 1 (1) : 1\r\n";
  const auto matlab = readRuleFile(fis, "f", RuleFormat::matlab, {});
  ASSERT_TRUE(matlab.ok()) << toString(matlab.findings());
  EXPECT_EQ(toText(*findRow("fuzzy.rules"), matlab->scheme.rules), "high&down*1=2");
  EXPECT_EQ(
      toText(*findRow("fuzzy.altitude.curve_ft"), static_cast<const CurvePoints&>(matlab->altitude.curve)),
      "4000:1 8000:0");
}

/// One mistake each: what of the good file is replaced, with what, and the finding.
struct Mistake {
  const char *what, *with, *finding;
};
constexpr Mistake kFuzzyLite[] = {
    {"low Discrete 4000", "low Gaussian 4000", "f:6: term low: expected straight lines: Discrete"},
    {"  term: high", "  term: medium Discrete 0 0 1 1\n  term: high",
     "f:7: term medium: expected low, high, or a term that is 1 everywhere"},
    {"Discrete 4000 1 5000", "Discrete 4000 1 inf", "f:6: term low: expected straight lines"},
    {"Discrete 4000 1 5000", "Discrete 4000 one 5000", "f:6: term low: expected numbers, found one"},
    {"high Discrete 4000 0", "high Discrete 4000 0.2",
     "f:7: term high: expected 1 minus \"low\", found another"},
    {"down Discrete -30 1 30 0\n  term: up Discrete -30 0 30 1",
     "down Discrete -130 1 30 0\n  term: up Discrete -130 0 30 1",
     "f: fuzzy.pitch.curve_deg: expected -90 to 90"},
    {"OutputVariable: total", "InputVariable: roll\nOutputVariable: total",
     "f:14: input roll: expected altitude or pitch"},
    {"WeightedAverage TakagiSugeno", "Centroid 100", "f:19: defuzzifier: expected WeightedAverage"},
    {"conjunction: Minimum", "conjunction: AlgebraicProduct", "f:28: conjunction: expected Minimum"},
    {"activation: General", "activation: Highest 1", "f:31: activation: expected General"},
    {"default: 0", "default: 1", "f:20: default: expected 0 or nan"},
    {"  enabled: true", "  enabled: false", "f:3: enabled: expected true, found false"},
    {"is low and pitch", "is low or pitch",
     "f:32: rule: expected disjunction: Maximum, found \"or\" without disjunction"},
    {"is low and pitch", "is very low and pitch",
     "f:32: rule: expected not, any or a term (low, high), found very"},
    {"if altitude is low and pitch", "if speed is low and pitch",
     "f:32: rule: expected an input (altitude, pitch), found speed"},
    {"low and pitch is down", "low and altitude is high", "f:32: rule: expected each input at most once"},
    {"is u1 with 1", "is u9 with 1", "f:32: rule: expected a term (u1, u2, u3, u4), found u9"},
    {"is u1 with 1", "is u1 with -1", "f: fuzzy.rules: expected weights of 0 to 1000"},
    {"is u1 with 1", "is u1 and total is u2", "f:32: rule: expected one term of the output, found several"},
    {"lock-range: false", "lock-range: true", "f:2: lock-range: expected false, found true"},
    {"is u1 with 1", "is u1 with", "f:32: rule: expected a weight, found the end of the line"},
    {"Constant 2", "Linear 2 1 0", "f:22: term u1: expected Constant with one number, found Linear"},
    {"Constant 2", "Constant 2.5", "f: fuzzy.rules: expected outputs of 0 to 2"},
    {"lock-range: false", "lock-range", "f:5: expected key: value, found lock-range"},
    {"lock-range: false", "colour: red", "f:5: colour: expected a property of InputVariable, found another"},
};

TEST(RuleFile, refusesWhatItCannotDoWithLineExpectedAndFound) {
  const std::string good = written({}, RuleFormat::fuzzylite);
  for (const Mistake& mistake : kFuzzyLite) {
    std::string text = good;
    ASSERT_NE(text.find(mistake.what), std::string::npos) << mistake.what;
    text.replace(text.find(mistake.what), std::string(mistake.what).size(), mistake.with);
    const auto read = readRuleFile(text, "f", RuleFormat::fuzzylite, {});
    EXPECT_FALSE(read.ok()) << mistake.with;
    EXPECT_THAT(toString(read.findings()), HasSubstr(mistake.finding)) << mistake.with;
  }
}

constexpr Mistake kMatlab[] = {
    {"Type='sugeno'", "Type='mamdani'", "f:3: Type: expected 'sugeno', found mamdani"},
    {"AndMethod='min'", "AndMethod='prod'", "f:8: conjunction: expected Minimum, found AlgebraicProduct"},
    {"DefuzzMethod='wtaver'", "DefuzzMethod='wtsum'", "f:12: DefuzzMethod: expected 'wtaver', found wtsum"},
    {"'low':'discretemf'", "'low':'gaussmf'", "f:18: term low: expected straight lines: Discrete"},
    {"[4000 1", "[4000 x", "f:18: MF1: expected numbers"},
    {"[-30 1 30 0]", "-30 1 30 0", "f:25: MF1: expected 'name':'shape',[numbers]"},
    {"\n1 1, 1 (1) : 1", "\n3 1, 1 (1) : 1",
     "f:38: Rules: expected the number of a term of altitude, found 3"},
    {"\n1 1, 1 (1) : 1", "\n1 1, 7 (1) : 1", "f:38: Rules: expected the number of a term of total, found 7"},
    {"\n1 1, 1 (1) : 1", "\n1 1, 1 (1) : 2", "f:38: rule: expected \"and\" or \"then\", found or"},
    {"\n1 1, 1 (1) : 1", "\n1 1 1, 1 (1) : 1", "f:38: Rules: expected terms of inputs"},
    {"\n1 1, 1 (1) : 1", "\n1.05 1, 1 (1) : 1",
     "f:38: rule: expected not, any or a term (low, high), found somewhat"},
    {"[Rules]", "[Rule]", "f:37: Rule: expected [System], [Input1], [Output1] or [Rules]"},
};

TEST(RuleFile, refusesWhatItCannotDoInMatlabsLanguage) {
  const std::string good = written({}, RuleFormat::matlab);
  for (const Mistake& mistake : kMatlab) {
    std::string text = good;
    ASSERT_NE(text.find(mistake.what), std::string::npos) << mistake.what;
    text.replace(text.find(mistake.what), std::string(mistake.what).size(), mistake.with);
    const auto read = readRuleFile(text, "f", RuleFormat::matlab, {});
    EXPECT_FALSE(read.ok()) << mistake.with;
    EXPECT_THAT(toString(read.findings()), HasSubstr(mistake.finding)) << mistake.with;
  }
}

TEST(RuleFile, takesADifferenceOfThreeDecimalsAsRoundingAndSaysSo) {
  std::string text = written({}, RuleFormat::fuzzylite);
  text.replace(text.find("5000 0.4"), 8, "5000 0.401");
  const auto read = readRuleFile(text, "f", RuleFormat::fuzzylite, {});
  ASSERT_TRUE(read.ok());
  ASSERT_EQ(read.findings().size(), 1u);
  EXPECT_EQ(read.findings()[0].severity, Severity::warning);
  EXPECT_EQ(read.findings()[0].where, "f:7");
}

TEST(RuleFile, isRefusedOrReadWhateverByteIsWrong) {
  std::mt19937_64 random(24);
  for (const Language& language : kLanguages) {
    const std::string good = written({}, language.format);
    for (std::size_t at = 0; at < good.size(); ++at) {
      const auto cut = readRuleFile(good.substr(0, at), "f", language.format, {});
      EXPECT_TRUE(cut.ok() || !cut.findings().empty());
      std::string bad = good;
      bad[at] = static_cast<char>(random());
      const auto read = readRuleFile(bad, "f", language.format, {});
      if (read) {
        for (const Finding& f : rangeFindings(*read)) EXPECT_NE(f.severity, Severity::error) << toString(f);
      } else {
        EXPECT_FALSE(read.findings().empty());
      }
    }
  }
}

}  // namespace
}  // namespace trimtab
