// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameter_lines.h"

#include <QGridLayout>

#include "parameter_line.h"

namespace trimtab::views {
namespace {

std::vector<const ParameterRow*> rowsOf(std::span<const char* const> keys) {
  std::vector<const ParameterRow*> rows;
  for (const char* key : keys) rows.push_back(findRow(key));
  return rows;
}

std::vector<const ParameterRow*> rowsFrom(std::string_view prefix) {
  std::vector<const ParameterRow*> rows;
  for (const ParameterRow& row : parameterRows())
    if (row.key.starts_with(prefix)) rows.push_back(&row);
  return rows;
}

}  // namespace

ParameterLines::ParameterLines(Draft& draft, std::span<const char* const> keys)
    : ParameterLines(draft, rowsOf(keys)) {}

ParameterLines::ParameterLines(Draft& draft, std::string_view prefix)
    : ParameterLines(draft, rowsFrom(prefix)) {}

ParameterLines::ParameterLines(Draft& draft, const std::vector<const ParameterRow*>& rows) {
  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setColumnStretch(1, 1);
  int gridRow = 0;
  for (const ParameterRow* row : rows) {
    auto* line = new ParameterLine(draft, *row, *grid, gridRow);
    line->setCompact(true);
    lines_.push_back(line);
    ++gridRow;
  }
  connect(&draft, &Draft::findingsChanged, this, [this] {
    for (ParameterLine* line : lines_) line->refresh();
  });
}

}  // namespace trimtab::views
