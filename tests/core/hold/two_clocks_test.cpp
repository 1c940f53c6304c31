#include <gtest/gtest.h>

#include <cstdio>

#include "two_clock_flight.h"

namespace trimtab {
namespace {

using test::p99Of;
using test::TwoClockCase;
using test::TwoClockRun;

/// Wherever some setting fits the budget, the budget is held; elsewhere holding does no harm.
TEST(TwoClocks, holdsWhatCanBeHeldAndHarmsNothingElse) {
  test::TwoClockFlight flight;
  std::size_t reachable = 0, unreachable = 0;
  for (const TwoClockCase& c : test::twoClockCases()) {
    const TwoClockRun off = flight.fly(c, false), held = flight.fly(c, true);
    std::printf("%s: %zu images %.2f to %.2f budgets, %zu images %.2f to %.2f, %d lowered, %d not trusted\n",
                c.name.c_str(), held.reachable.size(), p99Of(off.reachable) / c.budgetMs,
                p99Of(held.reachable) / c.budgetMs, held.unreachable.size(),
                p99Of(off.unreachable) / c.budgetMs, p99Of(held.unreachable) / c.budgetMs, held.lowered,
                held.notTrusted);
    reachable += held.reachable.size(), unreachable += held.unreachable.size();
    if (held.notTrusted == 0 && !held.reachable.empty()) {
      EXPECT_LE(p99Of(held.reachable), 1.1 * c.budgetMs) << c.name;
    }
    if (!held.unreachable.empty()) {
      EXPECT_LE(p99Of(held.unreachable), 1.05 * p99Of(off.unreachable)) << c.name;
    }
  }
  EXPECT_GT(reachable, 2000u);
  EXPECT_GT(unreachable, 1000u);
}

}  // namespace
}  // namespace trimtab
