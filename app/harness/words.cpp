#include "words.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace trimtab::harness {
namespace {

std::string grouped(std::string digits) {
  const std::size_t start = digits.starts_with('-') ? 1 : 0;
  for (std::size_t at = std::min(digits.find('.'), digits.size()); at > start + 3;) {
    at -= 3;
    digits.insert(at, ",");
  }
  return digits;
}

}  // namespace

std::string caseText(const std::string& method) {
  std::string text = method;
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string fixedText(double value, int decimals) {
  char text[400];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr;
  std::string out(text, end);
  if (out.find('.') != std::string::npos) {
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out.pop_back();
  }
  return out == "-0" ? "0" : out;
}

std::string roundedText(double value) {
  if (std::isnan(value)) return {};
  if (std::isinf(value)) return value > 0 ? "\xe2\x88\x9e" : "\xe2\x88\x92\xe2\x88\x9e";
  const double size = std::abs(value);
  if (size == 0) return "0";
  if (size >= 100) return grouped(fixedText(value, size >= 1000 ? 0 : 1));
  return fixedText(value, 2 - static_cast<int>(std::floor(std::log10(size))));
}

std::string enumerated(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return text;
}

std::string counted(std::size_t count, std::string_view what) {
  return std::to_string(count) + ' ' + std::string(what) + (count == 1 ? "" : "s");
}

}  // namespace trimtab::harness
