// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QStringList>
#include <optional>

#include "trimtab/preset/table.h"

namespace trimtab::views {

/// As people read the conditions, in the enumerations' order: "Any", "Low", "High".
QStringList altitudeConditions();
QStringList pitchConditions();
/// "Low, nose down"; "Always" for a rule without conditions.
QString ruleLabel(const FuzzyRule& rule);

struct InsertedRule {
  RuleList rules;
  std::size_t index = 0;
};
/// A rule behind `after` (none: at the end). None: the list is full.
std::optional<InsertedRule> withRule(const RuleList& rules, std::optional<std::size_t> after,
                                     const FuzzyRule& rule);
/// None: one rule must stay.
std::optional<RuleList> withoutRule(const RuleList& rules, std::size_t index);
/// The rule one place up (-1) or down (+1). None: it is at that end.
std::optional<RuleList> withRuleMoved(const RuleList& rules, std::size_t index, int by);

}  // namespace trimtab::views
