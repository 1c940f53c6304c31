#include "trimtab/policy/compiled_policy.h"

#include <algorithm>
#include <cmath>

#include "membership_at.h"

namespace trimtab {

double CompiledPolicy::conditionOf(const Rule& rule, const double* memberships) const {
  double stack[kMostConditionParts];
  double* top = stack - 1;  // the compiler allows no more steps than places
  for (const Step step : std::span(steps_).subspan(rule.firstStep, rule.steps)) switch (step.op) {
      case Op::term:
        *++top = memberships[step.term];
        break;
      case Op::one:
        *++top = 1;
        break;
      case Op::both: {
        const double b = *top--;
        *top = norm_ == PolicyNorm::minimum ? std::min(*top, b) : *top * b;
        break;
      }
      case Op::either: {
        const double b = *top--;
        *top = norm_ == PolicyNorm::minimum ? std::max(*top, b) : *top + b - *top * b;
        break;
      }
      case Op::invert:
        *top = 1 - *top;
        break;
      case Op::very:
        *top *= *top;
        break;
      case Op::somewhat:
        *top = std::sqrt(*top);
        break;
      case Op::extremely:
        *top = *top <= 0.5 ? 2 * *top * *top : 1 - 2 * (1 - *top) * (1 - *top);
        break;
      case Op::seldom:
        *top = *top <= 0.5 ? std::sqrt(0.5 * *top) : 1 - std::sqrt(0.5 * (1 - *top));
        break;
    }
  return *top;
}

void CompiledPolicy::decide(const SignalValues& signals, PolicyDecision& decision) const {
  decision.membership.resize(terms_.size());
  decision.firing.resize(rules_.size());
  std::array<double, kSignals> x;
  std::uint32_t unknown = 0;
  for (std::size_t s = 0; s < kSignals; ++s) {
    const bool known = !std::isnan(signals.value[s]);
    unknown |= known ? 0 : 1u << s;
    x[s] = std::clamp(signals.value[s], kSignalRows[s].range.low, kSignalRows[s].range.high);
  }
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    const Term& term = terms_[t];
    decision.membership[t] =
        unknown >> term.signal & 1
            ? std::numeric_limits<double>::quiet_NaN()
            : membershipAt(term.shape, std::span(numbers_).subspan(term.first, term.count), x[term.signal]);
  }
  std::array<double, kLevers> sum{}, weight{}, least, most;
  least.fill(std::numeric_limits<double>::infinity());
  most.fill(-std::numeric_limits<double>::infinity());
  decision.unknownAsked = 0;
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    const Rule& rule = rules_[r];
    decision.firing[r] = 0;
    if (!(rule.weight > 0)) continue;
    if (const std::uint32_t asked = rule.signals & unknown) {
      decision.unknownAsked |= asked;
      continue;
    }
    const double w = rule.weight * conditionOf(rule, decision.membership.data());
    decision.firing[r] = w;
    if (!(w > 0)) continue;
    for (const LeverSetting& setting : std::span(settings_).subspan(rule.firstSetting, rule.settings)) {
      const auto l = static_cast<std::size_t>(setting.lever);
      sum[l] += w * setting.value;
      weight[l] += w;
      least[l] = std::min(least[l], setting.value);
      most[l] = std::max(most[l], setting.value);
    }
  }
  for (std::size_t l = 0; l < kLevers; ++l)
    decision.target.value[l] = weight[l] > 0 ? std::clamp(sum[l] / weight[l], least[l], most[l])
                                             : std::numeric_limits<double>::quiet_NaN();
}

double CompiledPolicy::share(std::size_t rule, Lever lever, const PolicyDecision& decision) const {
  double all = 0, own = 0;
  for (std::size_t r = 0; r < rules_.size(); ++r)
    for (const LeverSetting& setting :
         std::span(settings_).subspan(rules_[r].firstSetting, rules_[r].settings))
      if (setting.lever == lever) {
        all += decision.firing[r];
        if (r == rule) own += decision.firing[r];
      }
  return all > 0 ? own / all : 0;
}

}  // namespace trimtab
