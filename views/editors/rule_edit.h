// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QStringList>
#include <optional>

#include "trimtab/preset/table.h"

namespace trimtab::views {

/// Returns the conditions as people read them, in the enumerations' order: "Any", "Low", "High".
QStringList altitudeConditions();
QStringList pitchConditions();
/// Returns the conditions of a rule, such as "Low, nose down"; "Always" for a rule without any.
QString ruleLabel(const FuzzyRule& rule);

struct InsertedRule {
  RuleList rules;
  std::size_t index = 0;
};
/// Returns the list with a rule inserted behind `after`, or at the end without it; nothing if the list is
/// full.
std::optional<InsertedRule> withRule(const RuleList& rules, std::optional<std::size_t> after,
                                     const FuzzyRule& rule);
/// Returns the list without one rule; nothing if it is the only one.
std::optional<RuleList> withoutRule(const RuleList& rules, std::size_t index);
/// Returns the list with a rule moved up (-1) or down (+1) by one; nothing if it is at that end.
std::optional<RuleList> withRuleMoved(const RuleList& rules, std::size_t index, int by);

}  // namespace trimtab::views
