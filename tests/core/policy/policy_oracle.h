#pragma once

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "trimtab/policy/fuzzy_system.h"
#include "trimtab/policy/levers.h"
#include "trimtab/policy/policy.h"
#include "trimtab/policy/signals.h"

/// fuzzylite as the oracle of policies.
namespace trimtab::test {

/// Returns what fuzzylite computes of each row of signals by a file that policyFileText() wrote. It sets
/// `error` if fuzzylite refuses or stops early.
std::vector<LeverValues> byFuzzylite(const std::string& text, const std::vector<SignalValues>& rows,
                                     std::string& error, RuleFormat format = RuleFormat::fuzzylite);

/// Compares our decisions with fuzzylite's over so many random signals, and over `rows`; each difference
/// above 1e-9 is a failure. Returns the largest one.
double differenceFromFuzzylite(const Policy& policy, RuleFormat format, std::mt19937_64& random, int points,
                               std::vector<SignalValues> rows = {});

/// Returns fuzzylite's own measure of the time of one evaluation, nanoseconds; nothing if it fails.
std::optional<double> fuzzyliteNanoseconds(const std::string& fll, const std::vector<SignalValues>& rows,
                                           int runs);

}  // namespace trimtab::test
