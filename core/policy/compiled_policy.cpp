#include "trimtab/policy/compiled_policy.h"
#include "trimtab/units/not_finite.h"

#include <algorithm>
#include <cmath>

#include "membership_at.h"

namespace trimtab {
template <PolicyNorm kNorm>
void CompiledPolicy::computeParts(double* values) const {
  const Operands* at = operands_.data();
  double* next = values + terms_.size() + 1;
  const auto each = [&](std::uint32_t parts, auto&& compute) {
    for (const Operands* const end = at + parts; at != end; ++at)
      *next++ = compute(values[at->a], values[at->b]);
  };
  for (const Run run : runs_) switch (run.op) {
      case Op::both:
        each(run.parts,
             [](double a, double b) { return kNorm == PolicyNorm::minimum ? std::min(a, b) : a * b; });
        break;
      case Op::either:
        each(run.parts, [](double a, double b) {
          return kNorm == PolicyNorm::minimum ? std::max(a, b) : a + b - a * b;
        });
        break;
      case Op::invert:
        each(run.parts, [](double a, double) { return 1 - a; });
        break;
      case Op::very:
        each(run.parts, [](double a, double) { return a * a; });
        break;
      case Op::somewhat:
        each(run.parts, [](double a, double) { return std::sqrt(a); });
        break;
      case Op::extremely:
        each(run.parts, [](double a, double) { return a <= 0.5 ? 2 * a * a : 1 - 2 * (1 - a) * (1 - a); });
        break;
      case Op::seldom:
        each(run.parts,
             [](double a, double) { return a <= 0.5 ? std::sqrt(0.5 * a) : 1 - std::sqrt(0.5 * (1 - a)); });
        break;
    }
}

void CompiledPolicy::fireRules(std::uint32_t unknown, PolicyDecision& decision) const {
  decision.unknownAsked = 0;
  for (std::size_t r = 0; r < rules_.size(); ++r) {
    const Rule& rule = rules_[r];
    const std::uint32_t missing = rule.asked & unknown;
    decision.unknownAsked |= missing;
    decision.firing[r] = missing ? 0 : rule.weight * decision.membership[rule.condition];
  }
}

void CompiledPolicy::decide(const SignalValues& flight, PolicyDecision& decision) const {
  decision.membership.resize(terms_.size() + 1 + operands_.size());
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
  decision.membership[terms_.size()] = 1;
  norm_ == PolicyNorm::minimum ? computeParts<PolicyNorm::minimum>(decision.membership.data())
                               : computeParts<PolicyNorm::product>(decision.membership.data());
  fireRules(unknown, decision);

  for (std::size_t l = 0; l < kLevers; ++l) {
    double sum = 0, weight = 0, least = kInfinity, most = -kInfinity;
    for (const Setting& setting : settingsOf(l)) {
      const double w = decision.firing[setting.rule], unlessFired = w > 0 ? 0 : kInfinity;
      sum += w * setting.value;
      weight += w;
      least = std::min(least, setting.value + unlessFired);
      most = std::max(most, setting.value - unlessFired);
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
