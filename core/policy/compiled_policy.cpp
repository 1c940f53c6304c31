#include "trimtab/policy/compiled_policy.h"

#include <algorithm>
#include <cmath>

#include "membership_at.h"

namespace trimtab {

template <PolicyNorm kNorm>
double CompiledPolicy::conditionOf(const Rule& rule, const double* memberships) const {
  const auto both = [](double a, double b) { return kNorm == PolicyNorm::minimum ? std::min(a, b) : a * b; };
  const auto either = [](double a, double b) {
    return kNorm == PolicyNorm::minimum ? std::max(a, b) : a + b - a * b;
  };
  double below[kMostConditionParts];  // the compiler allows no more steps than places
  std::size_t depth = 0;
  double top = 0;
  for (const Step step : std::span(steps_).subspan(rule.firstStep, rule.steps)) switch (step.op) {
      case Op::push:
        below[depth++] = top;
        [[fallthrough]];
      case Op::first:
        top = memberships[step.term];
        break;
      case Op::both_term:
        top = both(top, memberships[step.term]);
        break;
      case Op::either_term:
        top = either(top, memberships[step.term]);
        break;
      case Op::both:
        top = both(below[--depth], top);
        break;
      case Op::either:
        top = either(below[--depth], top);
        break;
      case Op::invert:
        top = 1 - top;
        break;
      case Op::very:
        top *= top;
        break;
      case Op::somewhat:
        top = std::sqrt(top);
        break;
      case Op::extremely:
        top = top <= 0.5 ? 2 * top * top : 1 - 2 * (1 - top) * (1 - top);
        break;
      case Op::seldom:
        top = top <= 0.5 ? std::sqrt(0.5 * top) : 1 - std::sqrt(0.5 * (1 - top));
        break;
    }
  return top;
}

template <PolicyNorm kNorm>
void CompiledPolicy::fireRules(std::uint32_t unknown, PolicyDecision& decision) const {
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    const Rule& rule = rules_[r];
    double& firing = decision.firing[r];
    firing = 0;
    if (!(rule.weight > 0)) continue;
    if (const std::uint32_t missing = rule.asked & unknown)
      decision.unknownAsked |= missing;
    else
      firing = rule.weight * conditionOf<kNorm>(rule, decision.membership.data());
  }
}

void CompiledPolicy::decide(const SignalValues& flight, PolicyDecision& decision) const {
  decision.membership.resize(terms_.size() + 1);
  decision.firing.resize(rules_.size());
  std::array<double, kSignals> x;
  std::uint32_t unknown = 0;
  for (std::size_t s = 0; s < kSignals; ++s) {
    const bool known = !std::isnan(flight.value[s]);
    unknown |= known ? 0 : 1u << s;
    x[s] = std::clamp(flight.value[s], kSignalRows[s].range.low, kSignalRows[s].range.high);
  }
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    const Term& term = terms_[t];
    decision.membership[t] =
        unknown >> term.signal & 1
            ? std::numeric_limits<double>::quiet_NaN()
            : membershipAt(term.shape, std::span(numbers_).subspan(term.first, term.count), x[term.signal]);
  }
  decision.membership.back() = 1;
  decision.unknownAsked = 0;
  norm_ == PolicyNorm::minimum ? fireRules<PolicyNorm::minimum>(unknown, decision)
                               : fireRules<PolicyNorm::product>(unknown, decision);

  for (std::size_t l = 0; l < kLevers; ++l) {
    double sum = 0, weight = 0, least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Setting& setting : settingsOf(l)) {
      const double w = decision.firing[setting.rule];
      sum += w * setting.value;
      weight += w;
      least = w > 0 ? std::min(least, setting.value) : least;
      most = w > 0 ? std::max(most, setting.value) : most;
    }
    decision.target.value[l] =
        weight > 0 ? std::clamp(sum / weight, least, most) : std::numeric_limits<double>::quiet_NaN();
  }
}

double CompiledPolicy::share(std::size_t rule, Lever lever, const PolicyDecision& decision) const {
  double all = 0, own = 0;
  for (const Setting& setting : settingsOf(static_cast<std::size_t>(lever))) {
    all += decision.firing[setting.rule];
    if (setting.rule == rule) own += decision.firing[setting.rule];
  }
  return all > 0 ? own / all : 0;
}

}  // namespace trimtab
