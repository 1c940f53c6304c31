#include "order_zero.h"

#include <algorithm>
#include <cmath>

#include "constant_fit.h"
#include "fuzzy_shapes.h"
#include "rule_surface.h"
#include "rule_table.h"
#include "system_text.h"
#include "trimtab/units/number.h"

namespace trimtab::fuzzy_system {
namespace {

constexpr double kMostDifference = 0.05;  // of the output's range
constexpr std::size_t kMostPlaces = 101 * 101, kMostPlacesOfMore = 25 * 25 * 25, kFewestPlaces = 64;
/// Operations that a grid may cost, so that reading takes a second at most.
constexpr std::size_t kWork = 50'000'000;

std::string keyOf(const Term& term) {
  return "term " + term.name.substr(0, 40);
}

/// Replaces MATLAB's other shapes by points.
void usePoints(Variable& input, Lines& lines) {
  for (Term& term : input.terms) {
    if (policyShapeOf(term)) continue;
    if (const auto flaw = membershipFlaw(term)) {
      lines.refuseAt(term.where, keyOf(term), flaw->expected, flaw->found);
      continue;
    }
    CurvePoints points = pointsOf(term);
    lines.noteAt(term.where, keyOf(term),
                 term.shape + ", read as " + std::to_string(points.xy.size() / 2) +
                     " points; the lines between them differ from it by at most " +
                     numberText(points.difference, 2));
    term.shape = systemNameOf(TermShape::points);
    term.numbers = std::move(points.xy);
  }
}

/// A plane that no input tilts is a constant.
void useConstants(Variable& output) {
  for (Term& term : output.terms) {
    if (term.shape != "Linear" || term.numbers.empty()) continue;
    if (std::any_of(term.numbers.begin(), term.numbers.end() - 1, [](double each) { return each != 0; }))
      continue;
    term.shape = "Constant";
    term.numbers = {term.numbers.back()};
  }
}

bool hasPlanes(const Variable& output) {
  return std::any_of(output.terms.begin(), output.terms.end(),
                     [](const Term& term) { return term.shape == "Linear"; });
}

void checkAreas(const System& system, std::size_t output, Lines& lines) {
  const MamdaniOutput terms(system, output);
  for (std::size_t t = 0; t < system.outputs[output].terms.size(); ++t)
    if (const Term& term = system.outputs[output].terms[t]; !terms.hasArea(t))
      lines.refuseAt(term.where, keyOf(term), "a term within the output's range", numbersText(term.numbers));
}

/// Refuses what has no surface.
void checkSurface(const System& system, Lines& lines) {
  const auto checkRange = [&lines](const Variable& variable) {
    if (!(variable.range.low < variable.range.high &&
          std::isfinite(variable.range.high - variable.range.low)))
      lines.refuseAt(variable.where, "Range", "[low high] with low below high",
                     numberText(variable.range.low) + " " + numberText(variable.range.high));
  };
  const auto checkTerms = [&lines](const Variable& variable) {
    for (const Term& term : variable.terms)
      if (const auto flaw = membershipFlaw(term))
        lines.refuseAt(term.where, keyOf(term), flaw->expected, flaw->found);
  };
  for (const Variable& input : system.inputs) {
    checkRange(input);
    checkTerms(input);
  }
  for (std::size_t o = 0; o < system.outputs.size(); ++o) {
    const Variable& output = system.outputs[o];
    if (system.mamdani) {
      checkRange(output);
      checkTerms(output);
      if (lines.empty()) checkAreas(system, o, lines);
      continue;
    }
    for (const Term& term : output.terms) {
      const std::size_t wanted = term.shape == "Linear" ? system.inputs.size() + 1 : 1;
      const bool finite =
          std::all_of(term.numbers.begin(), term.numbers.end(), [](double n) { return std::isfinite(n); });
      if ((term.shape != "Linear" && term.shape != "Constant") || term.numbers.size() != wanted || !finite)
        lines.refuseAt(term.where, keyOf(term),
                       "Constant with one number, or Linear with one for each input and one",
                       term.shape + " of " + std::to_string(term.numbers.size()) + " numbers");
    }
  }
  for (const Rule& rule : system.rules) {
    const auto flat = flatCondition(rule.condition);
    if (!flat) {
      lines.refuseAt(rule.where, "rule", flat.findings()[0].expected, flat.findings()[0].found);
      continue;
    }
    for (const Proposition& part : flat->propositions) {
      const std::size_t input = indexOf(system.inputs, part.input);
      const bool known = input < system.inputs.size() &&
                         (part.term == "any" ||
                          indexOf(system.inputs[input].terms, part.term) < system.inputs[input].terms.size());
      if (!known) lines.refuseAt(rule.where, "rule", "an input and one of its terms", part.input);
    }
  }
}

/// How far a surface is from another.
struct Difference {
  double most = 0, sum = 0, low = HUGE_VAL, high = -HUGE_VAL;  ///< low and high: of the first surface
  std::size_t places = 0;

  void add(double first, double second) {
    if (std::isnan(first) || std::isnan(second)) return;
    most = std::max(most, std::abs(first - second));
    sum += std::abs(first - second);
    low = std::min(low, first);
    high = std::max(high, first);
    ++places;
  }
};

/// Makes constants of planes and of Mamdani's terms.
class Reduction {
 public:
  /// `made` is `system` with points instead of other shapes.
  Reduction(const System& system, System made)
      : system_(system),
        made_(std::move(made)),
        grid_(system.inputs, placesFor(system)),
        surface_(surfaceOf(system, grid_)) {
    made_.mamdani.reset();
    for (std::size_t o = 0; o < system_.outputs.size(); ++o)
      if (needsConstants(o)) keepRules(o);
  }

  bool needsConstants(std::size_t o) const { return system_.mamdani || hasPlanes(system_.outputs[o]); }
  const System& withRules() const { return made_; }
  std::optional<System> table(const std::vector<double>& most) const {
    return tableOf(system_, grid_, surface_, most);
  }

  /// Compares the surface of each output with that of the file.
  std::vector<Difference> differencesOf(const System& made) const {
    std::vector<Difference> differences(surface_.size());
    const Surface now = surfaceOf(made, grid_);
    for (std::size_t o = 0; o < now.size(); ++o)
      for (std::size_t place = 0; place < grid_.places(); ++place)
        differences[o].add(surface_[o][place], now[o][place]);
    return differences;
  }

 private:
  static std::size_t placesFor(const System& system) {
    const std::size_t each = system.mamdani ? 100 * system.outputs.size() : 4;
    const std::size_t most = system.inputs.size() > 2 ? kMostPlacesOfMore : kMostPlaces;
    return std::clamp(kWork / std::max<std::size_t>(1, each * system.rules.size()), kFewestPlaces, most);
  }

  /// Gives each rule a constant of its own.
  void keepRules(std::size_t o) {
    ConstantMeans means;
    std::vector<double> wanted;
    RuleFirings firings(made_, grid_);
    std::vector<std::size_t> step;
    Range within{HUGE_VAL, -HUGE_VAL};
    for (std::size_t place = 0; place < grid_.places(); ++place) {
      grid_.stepsTo(place, step);
      const std::vector<double>& firing = firings.at(step);
      double all = 0;
      for (std::size_t r = 0; r < firing.size(); ++r)
        if (sets(r, o)) all += firing[r] * weightOf(system_.rules[r]);
      if (!(all > 0) || std::isnan(surface_[o][place])) continue;
      wanted.push_back(surface_[o][place]);
      within = {std::min(within.low, wanted.back()), std::max(within.high, wanted.back())};
      means.addPlace();
      for (std::size_t r = 0; r < firing.size(); ++r)
        if (const double part = firing[r] * weightOf(system_.rules[r]); sets(r, o) && part > 0)
          means.addShare(r, part / all);
    }
    const Range range = system_.outputs[o].range;
    if (range.low < range.high) within = {std::min(within.low, range.low), std::max(within.high, range.high)};
    if (!(within.low <= within.high)) within = {0, 0};
    constexpr int kRounds = 12;
    const auto fitted = fitConstants(means, wanted, made_.rules.size(), within, kRounds);
    std::vector<Term> terms;
    for (std::size_t r = 0; r < made_.rules.size(); ++r)
      for (Conclusion& conclusion : made_.rules[r].conclusions) {
        if (conclusion.output != o) continue;
        const Term& term = made_.outputs[o].terms[conclusion.term];
        terms.push_back({term.name, "Constant", {roundedFit(fitted.constants[r])}, term.where});
        conclusion.term = terms.size() - 1;
      }
    made_.outputs[o].terms = std::move(terms);
  }

  bool sets(std::size_t rule, std::size_t output) const {
    const auto& all = system_.rules[rule].conclusions;
    return std::any_of(all.begin(), all.end(), [&](const Conclusion& each) { return each.output == output; });
  }

  const System& system_;
  System made_;
  RuleGrid grid_;
  Surface surface_;
};

/// What of an output the difference is compared with.
double rangeOf(const Variable& output, const Difference& difference) {
  return std::max(output.range.high - output.range.low, difference.high - difference.low);
}

void say(const Variable& output, const Difference& difference, bool good, Lines& lines) {
  const double range = rangeOf(output, difference);
  const std::string text = "at most " + numberText(difference.most, 4) + " and on average " +
                           numberText(difference.sum / static_cast<double>(difference.places), 4) + ", " +
                           numberText(100 * difference.most / range, 3) + " % of " + numberText(range, 4) +
                           ", at " + std::to_string(difference.places) + " places of a grid";
  const std::string key = "difference of " + output.name;
  if (difference.places == 0)
    lines.refuseAt(output.where, key, "a rule that fires", "none within the ranges of the inputs");
  else if (!good)
    lines.refuseAt(output.where, key,
                   "at most 5 % of its range between the file and constants for its outputs, or "
                   "--accept-difference; no table of rules comes so near either",
                   text);
  else
    lines.noteAt(output.where, key, text + ", between the file and constants for its outputs");
}

/// Says that the file's rules are gone.
void sayTable(const System& system, const System& table, double worst, Lines& lines) {
  std::string levels;
  for (const Variable& input : table.inputs)
    levels += (levels.empty() ? "" : ", ") + std::to_string(input.terms.size()) + " levels of " +
              input.name.substr(0, 40);
  lines.warnAt(system.rules.front().where, "rules",
               "the " + std::to_string(system.rules.size()) +
                   " rules of the file were replaced by a table of " + std::to_string(table.rules.size()) +
                   " rules, " + levels + "; with constants they differ from the file by up to " +
                   numberText(100 * worst, 3) +
                   " % of an output's range, and --accept-difference imports them so");
}

}  // namespace

Result<System> orderZeroOf(System system, const std::string& where, bool acceptDifference) {
  Lines lines({}, where);
  for (Variable& output : system.outputs) useConstants(output);
  System made = system;
  Lines points({}, where);
  for (Variable& input : made.inputs) usePoints(input, points);
  if (!points.empty()) return points.findings();
  Findings notes = points.findings();
  if (system.mamdani || std::any_of(system.outputs.begin(), system.outputs.end(), hasPlanes)) {
    checkSurface(system, lines);
    if (!lines.empty()) return lines.findings();
    const Reduction reduction(system, std::move(made));
    made = reduction.withRules();
    auto differences = reduction.differencesOf(made);
    std::vector<double> most;
    double worst = 0;
    for (std::size_t o = 0; o < differences.size(); ++o) {
      most.push_back(kMostDifference * rangeOf(system.outputs[o], differences[o]));
      worst = std::max(worst, kMostDifference * differences[o].most / most[o]);
    }
    bool good = worst <= kMostDifference || acceptDifference;
    if (!good)
      if (auto table = reduction.table(most)) {
        notes.clear();  // its terms have no points
        sayTable(system, *table, worst, lines);
        made = std::move(*table);
        differences = reduction.differencesOf(made);
        good = true;
      }
    for (std::size_t o = 0; o < differences.size(); ++o)
      if (good ? reduction.needsConstants(o) : differences[o].most > most[o])
        say(system.outputs[o], differences[o], good, lines);
  }
  if (!lines.empty()) return lines.findings();
  const Findings more = lines.findings();
  notes.insert(notes.end(), more.begin(), more.end());
  return {std::move(made), std::move(notes)};
}

}  // namespace trimtab::fuzzy_system
