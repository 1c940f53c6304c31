#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace trimtab {

/// Returns the number in the C locale with the fewest digits that read back bit for bit, in plain notation
/// unless it is very large or small. Not-a-number and infinities become "nan" and "inf".
std::string numberText(double value);

/// Returns the number rounded to `digits` significant digits (1 to 17), in the notation of
/// `numberText(value)`. Use it in messages for what was measured or computed; a count needs the exact form
/// above.
std::string numberText(double value, int digits);

/// Reads the whole text as a number in the C locale, bit for bit, "nan" and "inf" included; returns nothing
/// for any other text.
std::optional<double> readNumber(std::string_view text);

}  // namespace trimtab
