#include "fuzzy_names.h"

#include "condition.h"

namespace trimtab::fuzzy_system {

std::string lowered(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string wordOf(std::string_view name) {
  constexpr std::size_t kLongest = 40;
  std::string word;
  for (const char c : name) {
    const bool digit = c >= '0' && c <= '9';
    const bool allowed = digit || c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (word.empty() && digit) word = "_";
    const bool continues = (static_cast<unsigned char>(c) & 0xc0) == 0x80;  // a character of UTF-8
    if (allowed || !continues) word += allowed ? c : '_';
    if (word.size() == kLongest) break;
  }
  if (!word.empty() && !isTermName(word)) word += '_';
  return word;
}

}  // namespace trimtab::fuzzy_system
