#pragma once

#include <string>
#include <string_view>

#include "report.h"

namespace trimtab::experiment {

/// Returns the bars of one name: the numbers of `column` in the rows whose `key` says `value`, or in all rows
/// if there is no key.
inline Series barsOf(const std::string& name, const Table& table, const char* column,
                     const char* key = nullptr, std::string_view value = {}) {
  Series series{name, {}, {}};
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    if (key == nullptr || table.text(row, key) == value) series.y.push_back(table.number(row, column));
  return series;
}

}  // namespace trimtab::experiment
