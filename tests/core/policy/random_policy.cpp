#include "random_policy.h"

#include <algorithm>
#include <cmath>

namespace trimtab::test {
namespace {

/// Where most of a signal's life takes place: a narrower range than it may have.
Range extentOf(Signal signal) {
  const Range r = rowOf(signal).range;
  return r.high > 1e6 ? Range{0, 2e5} : r;
}

class Maker {
 public:
  Maker(std::mt19937_64& random, const PolicySize& size) : random_(random), size_(size) {}

  Policy make() {
    Policy policy;
    policy.norm = below(2) == 0 ? PolicyNorm::minimum : PolicyNorm::product;
    const std::size_t first = below(kSignals);
    for (std::size_t t = 0; t < size_.terms; ++t) {
      PolicyTerm term;
      term.signal = kSignalRows[(first + t % size_.signals) % kSignals].signal;
      term.name = "t" + std::to_string(t);
      shape(term);
      policy.terms.push_back(std::move(term));
    }
    const std::size_t firstLever = below(kLevers);
    for (std::size_t r = 0; r < size_.rules; ++r) {
      PolicyRule rule;
      rule.condition = size_.numeric ? numericCondition(policy) : condition(policy, 0);
      rule.weight = below(3) == 0 ? unit() : 1;
      // fuzzylite rounds the weights that it reads to the decimals that it writes, which are 12.
      if (size_.numeric) rule.weight = std::round(rule.weight * 1e9) / 1e9;
      for (std::size_t l = 0, levers = 1 + below(std::min<std::size_t>(2, size_.levers)); l < levers; ++l) {
        const LeverRow& row = kLeverRows[(firstLever + (r + l) % size_.levers) % kLevers];
        rule.settings.push_back({row.lever, std::lerp(row.hard.low, row.hard.high, unit())});
      }
      policy.rules.push_back(std::move(rule));
    }
    return policy;
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

  void shape(PolicyTerm& term) {
    const Range extent = extentOf(term.signal);
    const double width = extent.high - extent.low;
    std::vector<double> x(4);
    for (double& each : x) each = std::lerp(extent.low, extent.high, unit());
    std::sort(x.begin(), x.end());
    term.shape = static_cast<TermShape>(below(kTermShapes.size()));
    switch (term.shape) {
      case TermShape::points:
        for (const double each : x) term.numbers.insert(term.numbers.end(), {each, unit()});
        break;
      case TermShape::triangle:
        term.numbers = {x[0], x[1], x[3]};
        break;
      case TermShape::trapezoid:
        term.numbers = x;
        if (below(4) == 0) term.numbers[0] = -std::numeric_limits<double>::infinity();
        if (below(4) == 0) term.numbers[3] = std::numeric_limits<double>::infinity();
        break;
      case TermShape::ramp:
        term.numbers = {x[below(2)], x[2 + below(2)]};
        if (below(2) == 0) std::swap(term.numbers[0], term.numbers[1]);
        break;
      case TermShape::gaussian:
        term.numbers = {x[1], width * (0.02 + 0.3 * unit())};
        break;
      case TermShape::bell:
        term.numbers = {x[1], width * (0.02 + 0.3 * unit()), 0.5 + 4 * unit()};
        break;
      case TermShape::sigmoid:
        term.numbers = {x[1], (below(2) == 0 ? 30 : -30) * (0.1 + unit()) / width};
        break;
    }
  }

  std::string proposition(const Policy& policy) {
    static constexpr const char* kHedges[] = {
        "", "", "", "not ", "very ", "somewhat ", "extremely ", "seldom ", "not very ", "somewhat not "};
    const PolicyTerm& term = policy.terms[below(policy.terms.size())];
    return std::string(rowOf(term.signal).key) + " is " +
           (below(12) == 0 ? "any" : kHedges[below(std::size(kHedges))] + term.name);
  }

  std::string condition(const Policy& policy, int depth) {
    std::string text;
    const std::size_t parts = 1 + below(depth == 0 ? 3 : 2);
    for (std::size_t i = 0; i < parts; ++i) {
      if (i > 0) text += below(2) == 0 ? " and " : " or ";
      if (depth < 2 && below(5) == 0)
        text += (below(2) == 0 ? "not (" : "(") + condition(policy, depth + 1) + ")";
      else
        text += proposition(policy);
    }
    return text;
  }

  /// Each signal once, by one connective, perhaps as a negated group.
  std::string numericCondition(const Policy& policy) {
    static constexpr const char* kHedges[] = {"",        "",          "not ",       "very ",    "somewhat ",
                                              "seldom ", "not very ", "very very ", "not not ", "extremely "};
    const char* const connective = below(2) == 0 ? " and " : " or ";
    std::uint32_t named = 0;
    std::string text;
    for (std::size_t parts = 1 + below(4); parts > 0; --parts) {
      const PolicyTerm& term = policy.terms[below(policy.terms.size())];
      const std::uint32_t bit = 1u << indexOf(term.signal);
      if (named & bit) continue;
      named |= bit;
      text += (text.empty() ? "" : connective) + std::string(rowOf(term.signal).key) + " is " +
              (below(10) == 0 ? "any" : kHedges[below(std::size(kHedges))] + term.name);
    }
    return below(4) == 0 ? "not (" + text + ")" : text;
  }

  std::mt19937_64& random_;
  const PolicySize& size_;
};

}  // namespace

Policy randomPolicy(std::mt19937_64& random, const PolicySize& size) {
  return Maker(random, size).make();
}

SignalValues randomSignals(std::mt19937_64& random, const Policy& policy) {
  std::uniform_real_distribution<double> unit(0, 1);
  SignalValues values;
  for (const SignalRow& row : kSignalRows) {
    const Range extent = extentOf(row.signal);
    values[row.signal] = std::lerp(extent.low, extent.high, unit(random));
  }
  for (const PolicyTerm& term : policy.terms)
    if (unit(random) < 0.1) {
      const bool xy = term.shape == TermShape::points;
      const std::size_t at = xy ? 2 * (term.numbers.size() / 4) : 0;
      if (std::isfinite(term.numbers[at])) values[term.signal] = term.numbers[at];
    }
  return values;
}

}  // namespace trimtab::test
