#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Numbers and lists in the words of a sentence.
namespace trimtab::harness {

/// Returns the name of a case for people to read, such as "view frustum" for "view_frustum".
std::string caseText(const std::string& method);
/// Returns at most so many decimals, in the C locale, without trailing zeros.
std::string fixedText(double value, int decimals);
/// Returns three significant digits, or a whole number in groups of three digits. Empty for NaN.
std::string roundedText(double value);
/// Returns "a, b and c".
std::string enumerated(const std::vector<std::string>& words);
/// Returns a count with its noun: "1 frame", "2 frames".
std::string counted(std::size_t count, std::string_view what);

}  // namespace trimtab::harness
