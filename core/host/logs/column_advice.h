#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

/// How refusals say which maps of columns would help.
namespace trimtab {

/// Returns a column's name as a map has it: in quotes if it has other characters than letters, digits, _, .
/// and #.
std::string columnText(std::string_view name);

/// Returns "name the unit, or map the column, as A or B". Empty maps are left out.
std::string mapAdvice(std::initializer_list<std::string> maps);

}  // namespace trimtab
