#pragma once

#include <cstdint>
#include <functional>
#include <sstream>
#include <string>

namespace trimtab::terrain {

/// A line of a list (`.stg`), without its comment.
struct StgLine {
  static constexpr std::size_t kMostBytes = 4096;

  std::uint32_t number = 0;  ///< from 1
  std::string verb;          ///< its first word; empty if the line is too long
  std::istringstream words;  ///< after the verb
  std::size_t bytes = 0;     ///< beyond kMostBytes the line is not read

  bool tooLong() const { return bytes > kMostBytes; }
};

/// Calls `use` for each line of a list that has a word, or is too long.
void forEachStgLine(const std::string& text, const std::function<void(StgLine&)>& use);

}  // namespace trimtab::terrain
