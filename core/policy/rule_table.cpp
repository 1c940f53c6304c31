#include "rule_table.h"

#include <algorithm>
#include <cmath>

#include "constant_fit.h"
#include "trimtab/policy/policy.h"
#include "trimtab/units/number.h"

namespace trimtab::fuzzy_system {
namespace {

/// The steps of the grid, rising from the first to the last, at which an input has a level.
using Levels = std::vector<std::vector<std::size_t>>;

bool fitsPolicy(const Levels& levels) {
  std::size_t rules = 1, terms = 0;
  for (const auto& each : levels) {
    rules *= each.size();
    terms += each.size();
  }
  return rules <= kMostPolicyRules && terms <= kMostPolicyTerms;
}

std::size_t rulesOf(const Levels& levels) {
  std::size_t rules = 1;
  for (const auto& each : levels) rules *= each.size();
  return rules;
}

/// A level below a step, and how far the step is from it towards the next.
struct Between {
  std::size_t level;
  double part;
};

std::vector<Between> betweenLevels(const std::vector<std::size_t>& levels, std::size_t side) {
  std::vector<Between> all;
  for (std::size_t step = 0, level = 0; step < side; ++step) {
    if (step > levels[level + 1]) ++level;
    all.push_back({level, static_cast<double>(step - levels[level]) /
                              static_cast<double>(levels[level + 1] - levels[level])});
  }
  return all;
}

ConstantMeans meansOf(const Levels& levels, const RuleGrid& grid) {
  std::vector<std::vector<Between>> between;
  for (const auto& each : levels) between.push_back(betweenLevels(each, grid.side()));
  ConstantMeans means;
  std::vector<std::size_t> step;
  for (std::size_t place = 0; place < grid.places(); ++place) {
    grid.stepsTo(place, step);
    means.addPlace();
    for (std::size_t corner = 0; corner < std::size_t{1} << levels.size(); ++corner) {
      double share = 1;
      std::size_t rule = 0, stride = 1;
      for (std::size_t i = 0; i < levels.size(); ++i) {
        const Between& at = between[i][step[i]];
        const bool upper = corner >> i & 1;
        share *= upper ? at.part : 1 - at.part;
        rule += stride * (at.level + upper);
        stride *= levels[i].size();
      }
      if (share > 0) means.addShare(rule, share);
    }
  }
  return means;
}

class TableSearch {
 public:
  TableSearch(const RuleGrid& grid, const Surface& surface, const std::vector<double>& most)
      : grid_(grid), surface_(surface), most_(most) {
    for (const auto& output : surface) {
      const auto [low, high] = std::minmax_element(output.begin(), output.end());
      span_.push_back({*low, *high});
    }
  }

  struct Table {
    Levels levels;
    std::vector<std::vector<double>> constants;  ///< of each output
    std::vector<double> squares;                 ///< of the differences at each place, as parts of most_
    double worst = 0;                            ///< the greatest of these differences
  };

  Table fit(Levels levels, int rounds) const {
    const ConstantMeans means = meansOf(levels, grid_);
    Table table{std::move(levels), {}, std::vector<double>(grid_.places(), 0), 0};
    for (std::size_t o = 0; o < surface_.size(); ++o) {
      auto fitted = fitConstants(means, surface_[o], rulesOf(table.levels), span_[o], rounds);
      for (std::size_t p = 0; p < grid_.places(); ++p) {
        const double part = fitted.differences[p] / most_[o];
        table.squares[p] = std::max(table.squares[p], part * part);
      }
      table.worst = std::max(table.worst, fitted.most / most_[o]);
      table.constants.push_back(std::move(fitted.constants));
    }
    return table;
  }

  /// Adds a level where it halves the squares of the worst stretch of one input; which input, a trial says.
  std::optional<Table> refined(const Table& table) const {
    std::optional<Table> best;
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < table.levels.size(); ++i) {
      Levels levels = table.levels;
      const std::size_t level = worstMiddle(table, i);
      if (level == 0) continue;
      levels[i].insert(std::upper_bound(levels[i].begin(), levels[i].end(), level), level);
      if (!fitsPolicy(levels)) continue;
      Table trial = fit(std::move(levels), 1);
      double score = 0;
      for (const double square : trial.squares) score += square;
      if (score < least) {
        least = score;
        best = std::move(trial);
      }
    }
    return best;
  }

 private:
  /// Returns the step in the middle of the squares of the stretch between two levels that has the most of
  /// them; 0 if no stretch has a step inside.
  std::size_t worstMiddle(const Table& table, std::size_t input) const {
    std::vector<double> squares(grid_.side(), 0);
    std::vector<std::size_t> step;
    for (std::size_t place = 0; place < grid_.places(); ++place) {
      grid_.stepsTo(place, step);
      squares[step[input]] += table.squares[place];
    }
    double most = 0;
    std::size_t middle = 0;
    const auto& levels = table.levels[input];
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
      double sum = 0, half = 0;
      for (std::size_t s = levels[k] + 1; s < levels[k + 1]; ++s) sum += squares[s];
      if (sum <= most) continue;
      most = sum;
      middle = levels[k] + 1;
      while ((half += squares[middle]) < sum / 2) ++middle;
    }
    return middle;
  }

  const RuleGrid& grid_;
  const Surface& surface_;
  const std::vector<double>& most_;
  std::vector<Range> span_;
};

/// Returns a term that is 1 at a level and 0 at its neighbours; beyond the last level it stays 1.
Term levelTerm(const RuleGrid& grid, std::size_t input, const std::vector<std::size_t>& levels, std::size_t k,
               const std::string& where) {
  const double x = grid.x(input, levels[k]);
  const double left = k == 0 ? -HUGE_VAL : grid.x(input, levels[k - 1]),
               right = k + 1 == levels.size() ? HUGE_VAL : grid.x(input, levels[k + 1]);
  return {"level_" + std::to_string(k + 1), "Trapezoid", {left, x, x, right}, where};
}

System systemOf(const TableSearch::Table& table, const System& like, const RuleGrid& grid) {
  System made;
  made.name = like.name;
  made.conjunction = {"AlgebraicProduct", like.conjunction.where};
  made.inputs = like.inputs;
  made.outputs = like.outputs;
  for (std::size_t i = 0; i < made.inputs.size(); ++i) {
    made.inputs[i].terms.clear();
    for (std::size_t k = 0; k < table.levels[i].size(); ++k)
      made.inputs[i].terms.push_back(levelTerm(grid, i, table.levels[i], k, made.inputs[i].where));
  }
  for (Variable& output : made.outputs) output.terms.clear();
  const std::string where = like.rules.front().where;
  for (std::size_t r = 0; r < rulesOf(table.levels); ++r) {
    Rule rule;
    rule.where = where;
    std::size_t rest = r;
    for (const Variable& input : made.inputs) {
      rule.condition += (rule.condition.empty() ? "" : " and ") + input.name + " is " +
                        input.terms[rest % input.terms.size()].name;
      rest /= input.terms.size();
    }
    for (std::size_t o = 0; o < made.outputs.size(); ++o) {
      made.outputs[o].terms.push_back(
          {"rule_" + std::to_string(r + 1), "Constant", {roundedFit(table.constants[o][r])}, where});
      rule.conclusions.push_back({o, r});
    }
    made.rules.push_back(std::move(rule));
  }
  return made;
}

}  // namespace

std::optional<System> tableOf(const System& like, const RuleGrid& grid, const Surface& surface,
                              const std::vector<double>& most) {
  constexpr std::size_t kMostInputs = 3;
  constexpr int kRounds = 10;
  if (like.inputs.size() > kMostInputs) return std::nullopt;
  for (const auto& output : surface)
    if (std::any_of(output.begin(), output.end(), [](double y) { return std::isnan(y); }))
      return std::nullopt;
  const TableSearch search(grid, surface, most);
  std::optional table = search.fit(Levels(like.inputs.size(), {0, grid.side() - 1}), 1);
  for (; table && std::isfinite(table->worst); table = search.refined(*table)) {
    if (table->worst > 2) continue;  // the rounds that follow do not halve it
    const auto fitted = search.fit(table->levels, kRounds);
    if (fitted.worst <= 1) return systemOf(fitted, like, grid);
  }
  return std::nullopt;
}

}  // namespace trimtab::fuzzy_system
