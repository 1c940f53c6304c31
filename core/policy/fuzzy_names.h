#pragma once

#include <set>
#include <string>
#include <string_view>

#include "system_text.h"

/// Makes words of the names of variables and terms, which MATLAB takes from any characters.
namespace trimtab::fuzzy_system {

/// Returns the text with small letters of ASCII.
std::string lowered(std::string_view text);

/// Returns a name of at most 40 letters, digits and _ that is no word of rules: _ stands for each other
/// character of UTF-8, before a digit, and after a word of rules. An empty name stays empty.
std::string wordOf(std::string_view name);

/// Gives each of the list such a name, with a number behind one that another has by itself, and notes each
/// change other than that of blanks. Names that were the same before stay the same.
template <class Named>
void makeNamesWords(std::vector<Named>& list, Lines& lines) {
  std::set<std::string, std::less<>> taken;
  for (const Named& each : list)
    if (wordOf(each.name) == each.name) taken.insert(each.name);
  std::size_t number = 1;
  for (Named& each : list) {
    std::string word = wordOf(each.name);
    if (word == each.name) continue;
    while (!taken.insert(word).second)
      word = wordOf(each.name).substr(0, 34) + "_" + std::to_string(++number);
    std::string blanksAside = each.name;
    for (char& c : blanksAside)
      if (c == ' ' || c == '\t') c = '_';
    if (blanksAside != word)
      lines.noteAt(each.where, "name", "'" + each.name.substr(0, 40) + "', read as " + word);
    each.name = std::move(word);
  }
}

}  // namespace trimtab::fuzzy_system
