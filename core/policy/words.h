#pragma once

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace trimtab {

/// Splits text at blanks; each of `( ) , =` is a word of its own.
inline std::vector<std::string_view> policyWords(std::string_view text) {
  constexpr std::string_view kAlone = "(),=";
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    if (std::isspace(static_cast<unsigned char>(text[at]))) {
      ++at;
      continue;
    }
    std::size_t end = at + 1;
    if (kAlone.find(text[at]) == std::string_view::npos)
      while (end < text.size() && !std::isspace(static_cast<unsigned char>(text[end])) &&
             kAlone.find(text[end]) == std::string_view::npos)
        ++end;
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

/// Joins words with a blank between, but none inside of parentheses.
template <class Iterator>
std::string joinedWords(Iterator begin, Iterator end) {
  std::string text;
  for (; begin != end; ++begin) {
    const bool tight = text.empty() || text.back() == '(' || *begin == ")";
    text += (tight ? "" : " ") + std::string(*begin);
  }
  return text;
}

}  // namespace trimtab
