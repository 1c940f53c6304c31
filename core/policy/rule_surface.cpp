#include "rule_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fuzzy_shapes.h"

namespace trimtab::fuzzy_system {
namespace {

double hedged(std::string_view hedge, double a) {
  if (hedge == "not") return 1 - a;
  if (hedge == "very") return a * a;
  if (hedge == "somewhat") return std::sqrt(a);
  if (hedge == "extremely") return a <= 0.5 ? 2 * a * a : 1 - 2 * (1 - a) * (1 - a);
  if (hedge == "seldom") return a <= 0.5 ? std::sqrt(0.5 * a) : 1 - std::sqrt(0.5 * (1 - a));
  return a;
}

double membershipOf(const Proposition& part, const Variable& input, double x) {
  const std::size_t term = indexOf(input.terms, part.term);
  double membership = term == input.terms.size() ? 1 : membershipIn(input.terms[term], x);
  for (auto hedge = part.hedges.rbegin(); hedge != part.hedges.rend(); ++hedge)
    membership = hedged(*hedge, membership);
  return membership;
}

}  // namespace

double weightOf(const Rule& rule) {
  return rule.enabled ? rule.weight : 0;
}

RuleGrid::RuleGrid(const std::vector<Variable>& inputs, std::size_t most) : inputs_(inputs) {
  const auto cells = [&inputs](std::size_t side) {
    return std::pow(static_cast<double>(side), static_cast<double>(inputs.size()));
  };
  while (side_ < 1001 && cells(side_ + 1) <= static_cast<double>(most)) ++side_;
  for (std::size_t i = 0; i < inputs.size() && places_ * side_ <= most; ++i) places_ *= side_;
}

void RuleGrid::stepsTo(std::size_t place, std::vector<std::size_t>& step) const {
  step.resize(inputs_.size());
  for (std::size_t& each : step) {
    each = place % side_;
    place /= side_;
  }
}

double RuleGrid::x(std::size_t input, std::size_t step) const {
  const Range range = inputs_[input].range;
  return std::lerp(range.low, range.high, static_cast<double>(step) / static_cast<double>(side_ - 1));
}

RuleFirings::RuleFirings(const System& system, const RuleGrid& grid)
    : productOfAnd_(system.conjunction.value == "AlgebraicProduct"),
      sumOfOr_(system.disjunction.value == "AlgebraicSum"),
      firing_(system.rules.size()) {
  for (const Rule& rule : system.rules) {
    Condition& condition = conditions_.emplace_back();
    const auto flat = flatCondition(rule.condition);
    condition.byOr = flat->connective == "or";
    for (const Proposition& part : flat->propositions) {
      const std::size_t input = indexOf(system.inputs, part.input);
      condition.parts.push_back({input, memberships_.size()});
      for (std::size_t step = 0; step < grid.side(); ++step)
        memberships_.push_back(membershipOf(part, system.inputs[input], grid.x(input, step)));
    }
  }
}

const std::vector<double>& RuleFirings::at(const std::vector<std::size_t>& step) {
  for (std::size_t r = 0; r < conditions_.size(); ++r) {
    const Condition& condition = conditions_[r];
    double all = condition.byOr ? 0 : 1;
    for (const Part& part : condition.parts) {
      const double m = memberships_[part.first + step[part.input]];
      if (condition.byOr)
        all = sumOfOr_ ? all + m - all * m : std::max(all, m);
      else
        all = productOfAnd_ ? all * m : std::min(all, m);
    }
    firing_[r] = all;
  }
  return firing_;
}

MamdaniOutput::MamdaniOutput(const System& system, std::size_t output) : system_(system), output_(output) {
  constexpr std::size_t kCells = 100;  // as in fuzzylite; MATLAB has 101 points
  const Variable& variable = system.outputs[output];
  for (std::size_t i = 0; i < kCells; ++i)
    y_.push_back(std::lerp(variable.range.low, variable.range.high, (static_cast<double>(i) + 0.5) / kCells));
  for (const Term& term : variable.terms) {
    term_.emplace_back();
    for (const double y : y_) term_.back().push_back(membershipIn(term, y));
  }
}

bool MamdaniOutput::hasArea(std::size_t term) const {
  return std::any_of(term_[term].begin(), term_[term].end(), [](double y) { return y > 0; });
}

void MamdaniOutput::aggregate(const std::vector<double>& firing) {
  const MamdaniMethods& how = *system_.mamdani;
  const bool product = how.implication == "prod", greatest = how.aggregation == "max",
             plain = how.aggregation == "sum";
  sum_.assign(y_.size(), 0);
  for (std::size_t r = 0; r < firing.size(); ++r) {
    const double w = firing[r];
    if (!(w > 0)) continue;
    for (const Conclusion& conclusion : system_.rules[r].conclusions) {
      if (conclusion.output != output_) continue;
      const std::vector<double>& term = term_[conclusion.term];
      for (std::size_t i = 0; i < y_.size(); ++i) {
        const double m = product ? w * term[i] : std::min(w, term[i]);
        sum_[i] = greatest ? std::max(sum_[i], m) : plain ? sum_[i] + m : sum_[i] + m - sum_[i] * m;
      }
    }
  }
}

double MamdaniOutput::value(const std::vector<double>& firing) {
  aggregate(firing);
  const std::string& how = system_.mamdani->defuzzifier;
  double area = 0, moment = 0;
  for (std::size_t i = 0; i < y_.size(); ++i) {
    area += sum_[i];
    moment += sum_[i] * y_[i];
  }
  if (!(area > 0)) return std::nan("");
  if (how == "centroid") return moment / area;
  if (how == "bisector") {
    double left = 0;
    std::size_t i = 0;
    while (left + sum_[i] < area / 2) left += sum_[i++];
    return y_[i];
  }
  const double top = *std::max_element(sum_.begin(), sum_.end()) - 1e-12;
  std::vector<double> highest;
  for (std::size_t i = 0; i < y_.size(); ++i)
    if (sum_[i] >= top) highest.push_back(y_[i]);
  if (how == "som") return highest.front();
  if (how == "lom") return highest.back();
  return std::accumulate(highest.begin(), highest.end(), 0.0) / static_cast<double>(highest.size());
}

namespace {

double planeAt(const Term& term, const RuleGrid& grid, const std::vector<std::size_t>& step) {
  double value = term.numbers.back();
  if (term.shape == "Linear")
    for (std::size_t i = 0; i < step.size(); ++i) value += term.numbers[i] * grid.x(i, step[i]);
  return value;
}

}  // namespace

Surface surfaceOf(const System& system, const RuleGrid& grid) {
  Surface surface(system.outputs.size(), std::vector<double>(grid.places()));
  std::vector<MamdaniOutput> mamdani;
  for (std::size_t o = 0; system.mamdani && o < system.outputs.size(); ++o) mamdani.emplace_back(system, o);
  RuleFirings firings(system, grid);
  std::vector<std::size_t> step;
  std::vector<double> weighted, sum, weight;
  for (std::size_t place = 0; place < grid.places(); ++place) {
    grid.stepsTo(place, step);
    weighted = firings.at(step);
    for (std::size_t r = 0; r < weighted.size(); ++r) weighted[r] *= weightOf(system.rules[r]);
    for (std::size_t o = 0; o < mamdani.size(); ++o) surface[o][place] = mamdani[o].value(weighted);
    if (system.mamdani) continue;
    sum.assign(surface.size(), 0);
    weight.assign(surface.size(), 0);
    for (std::size_t r = 0; r < weighted.size(); ++r)
      for (const Conclusion& conclusion : system.rules[r].conclusions)
        if (weighted[r] > 0) {
          sum[conclusion.output] +=
              weighted[r] * planeAt(system.outputs[conclusion.output].terms[conclusion.term], grid, step);
          weight[conclusion.output] += weighted[r];
        }
    for (std::size_t o = 0; o < surface.size(); ++o) surface[o][place] = sum[o] / weight[o];
  }
  return surface;
}

}  // namespace trimtab::fuzzy_system
