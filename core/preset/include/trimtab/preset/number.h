#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace trimtab {

/// C locale, the fewest digits that read back bit for bit; plain notation unless very large or small.
/// Not-a-number and infinities become "nan" and "inf".
std::string numberText(double value);

/// The whole text as a number, C locale, bit for bit; none where it is anything else. Reads "nan" and "inf".
std::optional<double> readNumber(std::string_view text);

}  // namespace trimtab
