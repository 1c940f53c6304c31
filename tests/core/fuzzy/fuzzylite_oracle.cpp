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

constexpr const char* kRuleBlock =
    "RuleBlock: base\n  enabled: true\n  conjunction: Minimum\n  disjunction: none\n"
    "  implication: AlgebraicProduct\n  activation: General\n";

/// The same decision as ours, in the oracle's language.
std::string engine(const AltitudeParameters& altitude, const PitchParameters& pitch) {
  return inputs(altitude, pitch) + output("altitudeMembership", "WeightedSum", constant("one", 1)) +
         output("pitchMembership", "WeightedSum", constant("one", 1)) +
         output("sum", "WeightedSum", constant("one", 1)) +
         output("twiceMinimum", "WeightedSum", constant("two", 2)) + kRuleBlock +
         "  rule: if altitude is low then altitudeMembership is one\n"
         "  rule: if pitch is down then pitchMembership is one\n"
         "  rule: if altitude is low then sum is one\n"
         "  rule: if pitch is down then sum is one\n"
         "  rule: if altitude is low and pitch is down then twiceMinimum is two\n";
}

std::string gridText(const Grid& grid) {
  std::string text;
  for (const double a : grid.altitude)
    for (const double p : grid.pitch) text += exact(a) + ' ' + exact(p) + '\n';
  return text;
}

/// Runs the engine over the grid; the oracle's file, its header first.
std::string evaluate(const ScratchDir& dir, const std::string& engineText, const Grid& grid,
                     std::string& error) {
  writeFile(dir / "engine.fll", engineText);
  writeFile(dir / "in.fld", gridText(grid));
  const Ran ran = run("cd " + dir.path().string() +
                      " && fuzzylite -i engine.fll -if fll"
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
                                     const Grid& grid, std::string& error) {
  const ScratchDir dir;
  std::istringstream out(evaluate(dir, engine(altitude, pitch), grid, error));
  std::string line;
  std::getline(out, line);
  if (line != "altitude pitch altitudeMembership pitchMembership sum twiceMinimum")
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

std::string convertedByFuzzylite(const std::string& engineText, const std::string& from,
                                 const std::string& to) {
  const ScratchDir dir;
  writeFile(dir / ("in." + from), engineText);
  const Ran ran = run("cd " + dir.path().string() + " && fuzzylite -i in." + from + " -if " + from +
                      " -o out." + to + " -of " + to + " -decimals 12");
  return ran.exitCode == 0 ? readFile(dir / ("out." + to)) : std::string();
}

FuzzyResult byUs(const AltitudeParameters& altitude, const PitchParameters& pitch, double altitudeFt,
                 double pitchDeg) {
  const double mu = altitudeMembership(altitude, altitudeFt), nu = pitchMembership(pitch, pitchDeg);
  return {mu, nu, combine(Combination::sum, mu, nu), combine(Combination::twice_minimum, mu, nu)};
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
