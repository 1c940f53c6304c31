// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

#include "views/model/draft.h"

/// Values of parameters as people read them.
namespace trimtab::views {

/// Returns a value as short as a cell of a table needs it: "0.05", "4 ft", "on", "Horizon" or "3 points".
QString shortText(const ParameterRow& row, const ParameterValue& value);
/// Returns the unit as it stands behind a number: after a blank, but for degrees; empty for a pure number.
QString unitAfter(const ParameterRow& row);

/// Returns authors and title of each document whose letter a source cites, such as "A, B: Table 2", as lines
/// of rich text; empty if it cites none.
QString documentsHtml(std::string_view source);

struct BeforeAfter {
  QString before, after;
};
/// Returns what a change made of a value. Of curves, bands, rules and lines, only the entries that differ are
/// named; a dash stands for none.
BeforeAfter changeText(const Change& change);
/// Returns the whole step as lines "Hysteresis: 0.05 → 0.03".
QString stepText(const Step& step);

}  // namespace trimtab::views
