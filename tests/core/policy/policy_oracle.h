#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trimtab/policy/levers.h"
#include "trimtab/policy/signals.h"

/// fuzzylite as the oracle of policies; `fll` is what toFuzzyLite() wrote.
namespace trimtab::test {

/// Returns what fuzzylite computes of each row of signals. It sets `error` if fuzzylite refuses or stops
/// early.
std::vector<LeverValues> byFuzzylite(const std::string& fll, const std::vector<SignalValues>& rows,
                                     std::string& error);

/// Returns fuzzylite's own measure of the time of one evaluation, nanoseconds; nothing if it fails.
std::optional<double> fuzzyliteNanoseconds(const std::string& fll, const std::vector<SignalValues>& rows,
                                           int runs);

}  // namespace trimtab::test
