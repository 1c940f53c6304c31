#include "policy_bench.h"

#include <algorithm>

#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/core/policy/policy_oracle.h"
#include "tests/core/policy/random_policy.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/policy_file.h"

namespace trimtab::bench {

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
    std::vector<SignalValues> states;
    for (std::size_t k = 0; k < kStates; ++k) states.push_back(test::randomSignals(random, policy));
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
