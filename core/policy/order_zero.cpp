#include "order_zero.h"

#include <algorithm>
#include <cmath>

#include "fuzzy_shapes.h"
#include "rule_surface.h"
#include "system_text.h"
#include "trimtab/units/number.h"

namespace trimtab::fuzzy_system {
namespace {

constexpr double kMostDifference = 0.05;  // of the output's range
constexpr std::size_t kMostPlaces = 101 * 101, kFewestPlaces = 64;
/// Operations that a grid may cost, so that reading takes a second at most.
constexpr std::size_t kWork = 100'000'000;

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
    if (const Term& term = system.outputs[output].terms[t]; std::isnan(terms.centroidOf(t)))
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

class Reduction {
 public:
  /// `made` is `system` with points instead of other shapes.
  Reduction(const System& system, System made)
      : system_(system), made_(std::move(made)), grid_(system.inputs, placesFor(system)) {}

  System run() {
    made_.mamdani.reset();
    for (std::size_t o = 0; o < system_.outputs.size(); ++o)
      if (system_.mamdani) useCentroids(o);
    if (!system_.mamdani) fitPlanes();
    return made_;
  }

  /// Compares both surfaces of each output.
  std::vector<Difference> differences() const {
    std::vector<Difference> differences(system_.outputs.size());
    std::vector<MamdaniOutput> mamdani;
    if (system_.mamdani)
      for (std::size_t o = 0; o < system_.outputs.size(); ++o) mamdani.emplace_back(system_, o);
    RuleFirings before(system_, grid_), after(made_, grid_);
    std::vector<std::size_t> step;
    std::vector<double> old, now;
    for (std::size_t place = 0; place < grid_.places(); ++place) {
      grid_.stepsTo(place, step);
      weigh(before.at(step), old);
      weigh(after.at(step), now);
      for (std::size_t o = 0; o < system_.outputs.size(); ++o)
        differences[o].add(system_.mamdani ? mamdani[o].value(old) : mean(system_, o, old, step),
                           mean(made_, o, now, step));
    }
    return differences;
  }

 private:
  static std::size_t placesFor(const System& system) {
    const std::size_t each = system.mamdani ? 100 * system.outputs.size() : 4;
    return std::clamp(kWork / std::max<std::size_t>(1, each * system.rules.size()), kFewestPlaces,
                      kMostPlaces);
  }

  void weigh(const std::vector<double>& firing, std::vector<double>& weighted) const {
    weighted = firing;
    for (std::size_t r = 0; r < firing.size(); ++r)
      weighted[r] *= system_.rules[r].enabled ? system_.rules[r].weight : 0;
  }

  double valueOf(const Term& term, const std::vector<std::size_t>& step) const {
    double value = term.numbers.back();
    if (term.shape == "Linear")
      for (std::size_t i = 0; i < step.size(); ++i) value += term.numbers[i] * grid_.x(i, step[i]);
    return value;
  }

  double mean(const System& system, std::size_t output, const std::vector<double>& firing,
              const std::vector<std::size_t>& step) const {
    double sum = 0, weight = 0;
    for (std::size_t r = 0; r < firing.size(); ++r)
      for (const Conclusion& conclusion : system.rules[r].conclusions)
        if (conclusion.output == output && firing[r] > 0) {
          sum += firing[r] * valueOf(system.outputs[output].terms[conclusion.term], step);
          weight += firing[r];
        }
    return sum / weight;
  }

  void useCentroids(std::size_t o) {
    const MamdaniOutput output(system_, o);
    for (std::size_t t = 0; t < system_.outputs[o].terms.size(); ++t) {
      Term& term = made_.outputs[o].terms[t];
      term.shape = "Constant";
      term.numbers = {rounded(output.centroidOf(t))};
    }
  }

  /// Gives each rule a term of its own instead of a plane.
  void fitPlanes() {
    std::vector<std::size_t> step;
    std::vector<std::vector<double>> sums(system_.rules.size());
    std::vector<double> weights(system_.rules.size(), 0);
    for (std::size_t r = 0; r < sums.size(); ++r) sums[r].assign(system_.rules[r].conclusions.size(), 0);
    RuleFirings firings(made_, grid_);
    for (std::size_t place = 0; place < grid_.places(); ++place) {
      grid_.stepsTo(place, step);
      const std::vector<double>& firing = firings.at(step);
      for (std::size_t r = 0; r < sums.size(); ++r) {
        weights[r] += firing[r];
        for (std::size_t c = 0; firing[r] > 0 && c < sums[r].size(); ++c)
          sums[r][c] += firing[r] * valueOf(termOf(system_.rules[r].conclusions[c]), step);
      }
    }
    for (std::size_t r = 0; r < sums.size(); ++r)
      for (std::size_t c = 0; c < sums[r].size(); ++c) {
        Conclusion& conclusion = made_.rules[r].conclusions[c];
        const Term& plane = termOf(system_.rules[r].conclusions[c]);
        if (plane.shape != "Linear") continue;
        auto& terms = made_.outputs[conclusion.output].terms;
        const double constant = weights[r] > 0 ? sums[r][c] / weights[r] : plane.numbers.back();
        terms.push_back({plane.name, "Constant", {rounded(constant)}, plane.where});
        conclusion.term = terms.size() - 1;
      }
    for (Variable& output : made_.outputs) dropPlanes(output, made_.rules, &output - made_.outputs.data());
  }

  static void dropPlanes(Variable& output, std::vector<Rule>& rules, std::ptrdiff_t index) {
    std::vector<std::size_t> kept(output.terms.size());
    std::vector<Term> terms;
    for (std::size_t t = 0; t < output.terms.size(); ++t) {
      kept[t] = terms.size();
      if (output.terms[t].shape != "Linear") terms.push_back(output.terms[t]);
    }
    for (Rule& rule : rules)
      for (Conclusion& conclusion : rule.conclusions)
        if (conclusion.output == static_cast<std::size_t>(index)) conclusion.term = kept[conclusion.term];
    output.terms = std::move(terms);
  }

  const Term& termOf(const Conclusion& conclusion) const {
    return system_.outputs[conclusion.output].terms[conclusion.term];
  }

  /// More digits would claim what a fit does not know.
  static double rounded(double value) { return *readNumber(numberText(value, 6)); }

  const System& system_;
  System made_;
  RuleGrid grid_;
};

void say(const Variable& output, const Difference& difference, bool accept, Lines& lines) {
  const double range = std::max(output.range.high - output.range.low, difference.high - difference.low);
  const double part = difference.most / range;
  const std::string text = "at most " + numberText(difference.most, 4) + " and on average " +
                           numberText(difference.sum / static_cast<double>(difference.places), 4) + ", " +
                           numberText(100 * part, 3) + " % of " + numberText(range, 4) + ", at " +
                           std::to_string(difference.places) + " places of a grid";
  const std::string key = "difference of " + output.name;
  if (difference.places == 0)
    lines.refuseAt(output.where, key, "a rule that fires", "none within the ranges of the inputs");
  else if (part > kMostDifference && !accept)
    lines.refuseAt(output.where, key,
                   "at most 5 % of its range between the file and constants for its outputs, "
                   "or --accept-difference",
                   text);
  else
    lines.noteAt(output.where, key, text + ", between the file and constants for its outputs");
}

}  // namespace

Result<System> orderZeroOf(System system, const std::string& where, bool acceptDifference) {
  Lines lines({}, where);
  for (Variable& output : system.outputs) useConstants(output);
  System made = system;
  for (Variable& input : made.inputs) usePoints(input, lines);
  if (!lines.empty()) return lines.findings();
  if (system.mamdani || std::any_of(system.outputs.begin(), system.outputs.end(), hasPlanes)) {
    checkSurface(system, lines);
    if (!lines.empty()) return lines.findings();
    Reduction reduction(system, std::move(made));
    made = reduction.run();
    const auto differences = reduction.differences();
    for (std::size_t o = 0; o < differences.size(); ++o)
      if (system.mamdani || hasPlanes(system.outputs[o]))
        say(system.outputs[o], differences[o], acceptDifference, lines);
  }
  if (!lines.empty()) return lines.findings();
  return {std::move(made), lines.findings()};
}

}  // namespace trimtab::fuzzy_system
