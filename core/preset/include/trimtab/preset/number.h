#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace trimtab {

/// C locale, the fewest digits that read back bit for bit; plain notation unless very large or small.
/// Not-a-number and infinities become "nan" and "inf".
std::string numberText(double value);

/// `value` rounded to `digits` significant digits (1 to 17), in the notation of `numberText(value)`. Use it
/// in messages for what was measured or computed; a count needs the exact form above.
std::string numberText(double value, int digits);

/// The whole text as a number, C locale, bit for bit; none where it is anything else. Reads "nan" and "inf".
std::optional<double> readNumber(std::string_view text);

}  // namespace trimtab
