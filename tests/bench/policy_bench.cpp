#include "policy_bench.h"

#include <algorithm>
#include <cmath>

#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/core/policy/policy_oracle.h"
#include "tests/core/policy/random_policy.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/policy_file.h"

namespace trimtab::bench {
namespace {

/// Signals that change smoothly, as a flight's do: straight lines between random places.
std::vector<SignalValues> flight(std::mt19937_64& random, const Policy& policy, std::size_t states) {
  constexpr std::size_t kLeg = 100;
  std::vector<SignalValues> signals;
  SignalValues from = test::randomSignals(random, policy), to = from;
  for (std::size_t i = 0; i < states; ++i) {
    if (i % kLeg == 0) from = to, to = test::randomSignals(random, policy);
    SignalValues now;
    for (std::size_t s = 0; s < kSignals; ++s)
      now.value[s] = std::lerp(from.value[s], to.value[s], static_cast<double>(i % kLeg) / kLeg);
    signals.push_back(now);
  }
  return signals;
}

}  // namespace

void policies(Report& report) {
  // The median policy of several: a random one may be all exponentials, or have none.
  constexpr std::size_t kPolicies = 5, kStates = 2000;
  std::mt19937_64 random(23);
  std::vector<std::pair<double, std::optional<double>>> times;
  for (std::size_t i = 0; i < kPolicies; ++i) {
    const Policy policy = test::randomPolicy(random, {.signals = 8, .terms = 24, .rules = 40, .levers = 6});
    const auto compiled = compile(policy, "bench");
    const auto fll = toFuzzyLite(policy, "bench");
    if (!compiled || !fll) return;
    const std::vector<SignalValues> states = flight(random, policy, kStates);
    PolicyDecision decision;
    const double mine = leastSeconds(report.quick() ? 20 : 100, [&] {
      for (const SignalValues& state : states) {
        compiled->decide(state, decision);
        keep(decision.target);
      }
    });
    std::optional<double> peer;
    if (test::fuzzylitePresent()) peer = test::fuzzyliteNanoseconds(*fll, states, 5);
    times.push_back({mine / kStates * 1e9, peer});
  }
  std::sort(times.begin(), times.end());
  const auto [mine, peer] = times[kPolicies / 2];
  report.add(valueAtMost(400, {.id = "decisions.policy_time",
                               .what = "time of a policy's decision: 8 signals, 24 terms, 40 rules, 6 levers",
                               .value = mine,
                               .unit = "ns"}));
  report.add(
      ratioAtMost(0.2, {.id = "decisions.policy_peer",
                        .what = "the same beside fuzzylite 6.0 evaluating the same rules, its own benchmark",
                        .value = mine,
                        .unit = "ns",
                        .peer = "fuzzylite 6.0",
                        .peerValue = peer,
                        .peerFrom = "run"}));
}

}  // namespace trimtab::bench
