#include "fuzzylite_oracle.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "tests/support.h"
#include "trimtab/fuzzy/combination.h"
#include "trimtab/fuzzy/membership.h"

namespace trimtab::test {
namespace {

const AltitudeParameters kAltitude;
const PitchParameters kPitch;

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

std::string constant(const char* name, double value) {
  return std::string("  term: ") + name + " Constant " + exact(value) + '\n';
}

std::string output(const char* name, const char* defuzzifier, const std::string& terms) {
  return std::string("OutputVariable: ") + name +
         "\n  enabled: true\n  range: 0 2\n  lock-range: false\n  aggregation: none\n  defuzzifier: " +
         defuzzifier + " TakagiSugeno\n  default: 0\n  lock-previous: false\n" + terms;
}

std::string inputs(const AltitudeParameters& altitude, const PitchParameters& pitch) {
  return "Engine: trimtab\nInputVariable: altitude\n  enabled: true\n  range: -100000 100000\n  lock-range: "
         "false\n" +
         discrete("low", altitude.curve, false) + discrete("high", altitude.curve, true) +
         "InputVariable: pitch\n  enabled: true\n  range: -90 90\n  lock-range: false\n" +
         discrete("down", pitch.curve, false) + discrete("up", pitch.curve, true);
}

std::string outputTerm(std::size_t index) {
  return "u" + std::to_string(index);
}

std::string equationOutput(const RuleList& rules) {
  std::string terms;
  for (std::size_t i = 0; i < rules.size; ++i) terms += constant(outputTerm(i).c_str(), rules.rule[i].output);
  return output("rules", "WeightedAverage", terms);
}

constexpr const char* kRuleBlock =
    "RuleBlock: base\n  enabled: true\n  conjunction: Minimum\n  disjunction: none\n"
    "  implication: AlgebraicProduct\n  activation: General\n";

std::string equationRules(const RuleList& rules) {
  static constexpr const char *altitudeTerms[] = {"any", "low", "high"},
                              *pitchTerms[] = {"any", "down", "up"};
  std::string text;
  for (std::size_t i = 0; i < rules.size; ++i) {
    const FuzzyRule& r = rules.rule[i];
    text += std::string("  rule: if altitude is ") + altitudeTerms[static_cast<std::size_t>(r.altitude)] +
            " and pitch is " + pitchTerms[static_cast<std::size_t>(r.pitch)] + " then rules is " +
            outputTerm(i) + " with " + exact(r.weight) + '\n';
  }
  return text;
}

/// The same decision as ours, in the oracle's language: the sum by WeightedSum, Eq. (2) by WeightedAverage.
std::string engine(const AltitudeParameters& altitude, const PitchParameters& pitch, const RuleList& rules) {
  return inputs(altitude, pitch) + output("altitudeMembership", "WeightedSum", constant("one", 1)) +
         output("pitchMembership", "WeightedSum", constant("one", 1)) +
         output("sum", "WeightedSum", constant("one", 1)) +
         output("twiceMinimum", "WeightedSum", constant("two", 2)) + equationOutput(rules) + kRuleBlock +
         "  rule: if altitude is low then altitudeMembership is one\n"
         "  rule: if pitch is down then pitchMembership is one\n"
         "  rule: if altitude is low then sum is one\n"
         "  rule: if pitch is down then sum is one\n"
         "  rule: if altitude is low and pitch is down then twiceMinimum is two\n" +
         equationRules(rules);
}

std::string gridText(const Grid& grid) {
  std::string text;
  for (const double a : grid.altitude)
    for (const double p : grid.pitch) text += exact(a) + ' ' + exact(p) + '\n';
  return text;
}

/// Runs the engine over the grid; the oracle's file, its header first.
std::string evaluate(const ScratchDir& dir, const std::string& engineText, const Grid& grid,
                     std::string& error, const std::string& format = "fll") {
  writeFile(dir / ("engine." + format), engineText);
  writeFile(dir / "in.fld", gridText(grid));
  const Ran ran = run("cd " + dir.path().string() + " && fuzzylite -i engine." + format + " -if " + format +
                      " -o out.fld -of fld -d in.fld -decimals 12");
  if (ran.exitCode != 0)
    error = "fuzzylite ended with status " + std::to_string(ran.exitCode) + ": " + ran.err;
  return readFile(dir / "out.fld");
}

}  // namespace

bool fuzzylitePresent() {
  return run("command -v fuzzylite").exitCode == 0;
}

Grid gridFor(const AltitudeParameters& altitude, const PitchParameters& pitch, int altitudes, int pitches) {
  Grid grid;
  for (int i = 0; i < altitudes; ++i) grid.altitude.push_back(2500 + 7000.0 * i / (altitudes - 1));
  for (int i = 0; i < pitches; ++i) grid.pitch.push_back(-45 + 90.0 * i / (pitches - 1));
  for (const CurvePoint& point : altitude.curve.span()) grid.altitude.push_back(point.x);
  for (const CurvePoint& point : pitch.curve.span()) grid.pitch.push_back(point.x);
  return grid;
}

std::vector<FuzzyResult> byFuzzylite(const AltitudeParameters& altitude, const PitchParameters& pitch,
                                     const RuleList& rules, const Grid& grid, std::string& error) {
  const ScratchDir dir;
  std::istringstream out(evaluate(dir, engine(altitude, pitch, rules), grid, error));
  std::string line;
  std::getline(out, line);
  if (line != "altitude pitch altitudeMembership pitchMembership sum twiceMinimum rules")
    error += "unexpected header: " + line;
  std::vector<FuzzyResult> results;
  while (std::getline(out, line)) {
    const char* at = line.data();
    const char* const end = at + line.size();
    double skipped = 0;
    FuzzyResult result;
    result.fill(std::numeric_limits<double>::quiet_NaN());
    const auto read = [&at, end](double& value) {
      at = std::from_chars(at, end, value).ptr;
      if (at < end) ++at;
    };
    read(skipped);
    read(skipped);
    for (double& value : result) read(value);
    results.push_back(result);
  }
  if (results.size() != grid.size() && error.empty()) error = "the oracle stopped early";
  return results;
}

std::vector<double> byFuzzylite(const std::string& engineText, const std::string& format, const Grid& grid,
                                std::string& error) {
  const ScratchDir dir;
  std::istringstream out(evaluate(dir, engineText, grid, error, format));
  std::string line;
  std::getline(out, line);
  std::vector<double> totals;
  while (std::getline(out, line)) totals.push_back(std::strtod(line.c_str() + line.rfind(' ') + 1, nullptr));
  if (totals.size() != grid.size() && error.empty()) error = "the oracle stopped early";
  return totals;
}

std::string convertedByFuzzylite(const std::string& engineText, const std::string& from,
                                 const std::string& to) {
  const ScratchDir dir;
  writeFile(dir / ("in." + from), engineText);
  const Ran ran = run("cd " + dir.path().string() + " && fuzzylite -i in." + from + " -if " + from +
                      " -o out." + to + " -of " + to + " -decimals 12");
  return ran.exitCode == 0 ? readFile(dir / ("out." + to)) : std::string();
}

FuzzyResult byUs(const AltitudeParameters& altitude, const PitchParameters& pitch, const RuleList& rules,
                 double altitudeFt, double pitchDeg) {
  const double mu = altitudeMembership(altitude, altitudeFt), nu = pitchMembership(pitch, pitchDeg);
  return {mu, nu, combine(Combination::sum, rules, mu, nu).total,
          combine(Combination::twice_minimum, rules, mu, nu).total,
          combine(Combination::rules, rules, mu, nu).total};
}

std::optional<double> fuzzyliteNanoseconds(const Grid& grid, int runs) {
  const ScratchDir dir;
  std::string error;
  // Its benchmark reads the outputs that it expects from the same file.
  evaluate(dir, inputs(kAltitude, kPitch) + equationOutput(kRuleBase) + kRuleBlock + equationRules(kRuleBase),
           grid, error);
  return error.empty() ? benchmarkNanoseconds(dir.path(), grid.size(), runs) : std::nullopt;
}

std::optional<double> benchmarkNanoseconds(const std::filesystem::path& dir, std::size_t rows, int runs) {
  const Ran ran =
      run("cd " + dir.string() + " && fuzzylite benchmark engine.fll out.fld " + std::to_string(runs));
  // Two lines, tab-separated: names and values; t1, t2 ... are nanoseconds for all evaluations of a run.
  std::istringstream lines(ran.out);
  std::string names, values;
  std::getline(lines, names);
  std::getline(lines, values);
  std::istringstream nameCells(names), valueCells(values);
  std::string name, value;
  std::optional<double> least;
  while (std::getline(nameCells, name, '\t') && std::getline(valueCells, value, '\t')) {
    if (name.size() < 2 || name[0] != 't' || name[1] < '0' || name[1] > '9') continue;
    const double each = std::strtod(value.c_str(), nullptr) / static_cast<double>(rows);
    least = least ? std::min(*least, each) : each;
  }
  return least;
}

}  // namespace trimtab::test
