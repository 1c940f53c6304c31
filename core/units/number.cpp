#include "trimtab/units/number.h"

#include <charconv>
#include <cmath>

namespace trimtab {

std::string numberText(double value) {
  char text[64];
  const double size = std::abs(value);
  const bool plain = size == 0 || (size >= 1e-4 && size < 1e15);
  const auto format = plain ? std::chars_format::fixed : std::chars_format::general;
  const auto end = std::to_chars(text, text + sizeof text, value, format);
  return {text, end.ptr};
}

std::string numberText(double value, int digits) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits);
  return numberText(readNumber({text, static_cast<std::size_t>(end.ptr - text)}).value_or(value));
}

std::optional<double> readNumber(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (read.ec != std::errc{} || read.ptr != end || text.empty()) return std::nullopt;
  return value;
}

}  // namespace trimtab
