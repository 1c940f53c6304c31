#pragma once

#include <string>
#include <vector>

namespace trimtab::test {

/// The cells of a line of CSV without quotes, read without any code of the project's own.
inline std::vector<std::string> csvCells(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line)
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  return cells;
}

}  // namespace trimtab::test
