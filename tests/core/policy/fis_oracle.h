#pragma once

#include <string>
#include <vector>

/// fuzzylite as the oracle of MATLAB's files as they stand, with inputs and outputs of any name.
namespace trimtab::test {

/// Returns what fuzzylite computes of each row of inputs, in the file's order; NaN where no rule fires. It
/// sets `error` if fuzzylite refuses or stops early.
std::vector<std::vector<double>> fisByFuzzylite(const std::string& fis,
                                                const std::vector<std::vector<double>>& rows,
                                                std::string& error);

}  // namespace trimtab::test
