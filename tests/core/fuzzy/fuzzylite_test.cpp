#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "support.h"
#include "trimtab/fuzzy/combination.h"
#include "trimtab/fuzzy/membership.h"

/// The `fuzzylite` program as an independent oracle of the fuzzy arithmetic.
namespace trimtab {
namespace {

using test::run;

constexpr double kAgreement = 1e-9;

std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// Piecewise linear term; `complement` is one minus the curve.
std::string discrete(const char* name, const CurvePoints& curve, bool complement) {
  std::string text = std::string("  term: ") + name + " Discrete";
  for (const CurvePoint& p : curve.span()) text += ' ' + exact(p.x) + ' ' + exact(complement ? 1 - p.y : p.y);
  return text + '\n';
}

std::string output(const char* name, const char* defuzzifier, const std::string& terms) {
  return std::string("OutputVariable: ") + name +
         "\n  enabled: true\n  range: 0 2\n  lock-range: false\n  aggregation: none\n  defuzzifier: " +
         defuzzifier + " TakagiSugeno\n  default: 0\n  lock-previous: false\n" + terms;
}

/// The same decision as ours, in the oracle's language: the sum by WeightedSum, Eq. (2) by WeightedAverage.
std::string engine(const AltitudeParameters& altitude, const PitchParameters& pitch,
                   const RuleParameters& r) {
  const auto constant = [](const char* name, double value) {
    return std::string("  term: ") + name + " Constant " + exact(value) + '\n';
  };
  std::string text = "Engine: trimtab\n";
  text += "InputVariable: altitude\n  enabled: true\n  range: -100000 100000\n  lock-range: false\n" +
          discrete("low", altitude.curve, false) + discrete("high", altitude.curve, true);
  text += "InputVariable: pitch\n  enabled: true\n  range: -90 90\n  lock-range: false\n" +
          discrete("down", pitch.curve, false) + discrete("up", pitch.curve, true);
  text += output("altitudeMembership", "WeightedSum", constant("one", 1));
  text += output("pitchMembership", "WeightedSum", constant("one", 1));
  text += output("sum", "WeightedSum", constant("one", 1));
  text += output("twiceMinimum", "WeightedSum", constant("two", 2));
  text +=
      output("rules", "WeightedAverage",
             constant("lowDown", r.lowDownOutput.value()) + constant("lowUp", r.lowUpOutput.value()) +
                 constant("highDown", r.highDownOutput.value()) + constant("highUp", r.highUpOutput.value()));
  const auto weighted = [](Ratio weight) { return " with " + exact(weight.value()) + '\n'; };
  text +=
      "RuleBlock: base\n  enabled: true\n  conjunction: Minimum\n  disjunction: none\n"
      "  implication: AlgebraicProduct\n  activation: General\n"
      "  rule: if altitude is low then altitudeMembership is one\n"
      "  rule: if pitch is down then pitchMembership is one\n"
      "  rule: if altitude is low then sum is one\n"
      "  rule: if pitch is down then sum is one\n"
      "  rule: if altitude is low and pitch is down then twiceMinimum is two\n";
  text += "  rule: if altitude is low and pitch is down then rules is lowDown" + weighted(r.lowDownWeight);
  text += "  rule: if altitude is low and pitch is up then rules is lowUp" + weighted(r.lowUpWeight);
  text += "  rule: if altitude is high and pitch is down then rules is highDown" + weighted(r.highDownWeight);
  text += "  rule: if altitude is high and pitch is up then rules is highUp" + weighted(r.highUpWeight);
  return text;
}

/// Every pair of altitude and pitch. The curves' own points are among them.
struct Grid {
  std::vector<double> altitude, pitch;
};
Grid grid(const AltitudeParameters& a, const PitchParameters& p, int altitudes, int pitches) {
  Grid g;
  for (int i = 0; i < altitudes; ++i) g.altitude.push_back(2500 + 7000.0 * i / (altitudes - 1));
  for (int i = 0; i < pitches; ++i) g.pitch.push_back(-45 + 90.0 * i / (pitches - 1));
  for (const CurvePoint& point : a.curve.span()) g.altitude.push_back(point.x);
  for (const CurvePoint& point : p.curve.span()) g.pitch.push_back(point.x);
  return g;
}

/// Evaluates the grid by the oracle and by us; returns how many points were compared.
std::size_t compare(const AltitudeParameters& altitude, const PitchParameters& pitch,
                    const RuleParameters& rules, const Grid& points) {
  test::ScratchDir dir;
  test::writeFile(dir / "engine.fll", engine(altitude, pitch, rules));
  std::string inputs;
  for (const double a : points.altitude)
    for (const double p : points.pitch) inputs += exact(a) + ' ' + exact(p) + '\n';
  test::writeFile(dir / "in.fld", inputs);
  const test::Ran ran = run("cd " + dir.path().string() +
                            " && fuzzylite -i engine.fll -if fll -o out.fld -of fld -d in.fld -decimals 12");
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  std::istringstream out(test::readFile(dir / "out.fld"));
  std::string line;
  std::getline(out, line);
  EXPECT_EQ(line, "altitude pitch altitudeMembership pitchMembership sum twiceMinimum rules");

  std::size_t compared = 0, differing = 0;
  double worst = 0;
  for (const double a : points.altitude) {
    for (const double p : points.pitch) {
      if (!std::getline(out, line)) {
        ADD_FAILURE() << "the oracle stopped after " << compared << " points\n" << ran.err;
        return compared;
      }
      double theirs[7] = {};
      const char* at = line.data();
      for (double& value : theirs) at = std::from_chars(at, line.data() + line.size(), value).ptr + 1;
      const double mu = altitudeMembership(altitude, a), nu = pitchMembership(pitch, p);
      const double ours[7] = {a,
                              p,
                              mu,
                              nu,
                              combine(Combination::sum, rules, mu, nu).total,
                              combine(Combination::twice_minimum, rules, mu, nu).total,
                              combine(Combination::rules, rules, mu, nu).total};
      for (int i = 2; i < 7; ++i) {
        const double difference = std::abs(ours[i] - theirs[i]);
        worst = std::max(worst, std::isnan(difference) ? INFINITY : difference);
        if (!(difference <= kAgreement) && ++differing <= 5)
          ADD_FAILURE() << a << " ft, " << p << " deg, column " << i << ": " << ours[i] << " against "
                        << line;
      }
      ++compared;
    }
  }
  EXPECT_EQ(differing, 0u);
  std::printf("fuzzylite: %zu points, largest difference %.2g\n", compared, worst);
  return compared;
}

#define NEEDS_FUZZYLITE() \
  if (run("command -v fuzzylite").exitCode != 0) GTEST_SKIP() << "needs the fuzzylite program"

TEST(FuzzyArithmetic, agreesWithFuzzyliteOverTheDefaults) {
  NEEDS_FUZZYLITE();
  const AltitudeParameters altitude;
  const PitchParameters pitch;
  EXPECT_GE(compare(altitude, pitch, {}, grid(altitude, pitch, 401, 251)), 100000u);
}

TEST(FuzzyArithmetic, agreesWithFuzzyliteOverEditedCurvesAndRules) {
  NEEDS_FUZZYLITE();
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 3; ++round) {
    AltitudeParameters altitude;
    altitude.curve.size = 0;
    for (int i = 0; i < 6; ++i)
      altitude.curve.point[altitude.curve.size++] = {3000.0 + 1000 * i + 800 * unit(random), unit(random)};
    PitchParameters pitch;
    pitch.curve.size = 0;
    for (int i = 0; i < 5; ++i)
      pitch.curve.point[pitch.curve.size++] = {-40.0 + 20 * i + 15 * unit(random), unit(random)};
    RuleParameters rules;
    rules.lowDownWeight = Ratio{unit(random)};
    rules.highUpWeight = Ratio{3 * unit(random)};
    rules.lowUpOutput = Membership{2 * unit(random)};
    rules.highDownOutput = Membership{2 * unit(random)};
    compare(altitude, pitch, rules, grid(altitude, pitch, 101, 71));
  }
}

}  // namespace
}  // namespace trimtab
