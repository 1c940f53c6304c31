// SPDX-License-Identifier: GPL-3.0-or-later
#include "rule_edit.h"

#include <QObject>
#include <algorithm>
#include <utility>

namespace trimtab::views {

QStringList altitudeConditions() {
  return {QObject::tr("Any"), QObject::tr("Low"), QObject::tr("High")};
}

QStringList pitchConditions() {
  return {QObject::tr("Any"), QObject::tr("Nose down"), QObject::tr("Nose up")};
}

QString ruleLabel(const FuzzyRule& rule) {
  QStringList said;
  if (rule.altitude != AltitudeCondition::any)
    said << altitudeConditions().value(static_cast<int>(rule.altitude));
  if (rule.pitch != PitchCondition::any) {
    const QString pitch = pitchConditions().value(static_cast<int>(rule.pitch));
    said << (said.isEmpty() ? pitch : pitch.toLower());
  }
  return said.isEmpty() ? QObject::tr("Always") : said.join(QStringLiteral(", "));
}

std::optional<InsertedRule> withRule(const RuleList& rules, std::optional<std::size_t> after,
                                     const FuzzyRule& rule) {
  if (rules.size >= RuleList::kCapacity) return std::nullopt;
  InsertedRule inserted{rules, after ? std::min(*after + 1, rules.size) : rules.size};
  RuleList& list = inserted.rules;
  for (std::size_t i = list.size; i > inserted.index; --i) list.rule[i] = list.rule[i - 1];
  ++list.size;
  list.rule[inserted.index] = rule;
  return inserted;
}

std::optional<RuleList> withoutRule(const RuleList& rules, std::size_t index) {
  if (rules.size <= 1 || index >= rules.size) return std::nullopt;
  RuleList removed = rules;
  for (std::size_t i = index; i + 1 < removed.size; ++i) removed.rule[i] = removed.rule[i + 1];
  removed.rule[--removed.size] = {};
  return removed;
}

std::optional<RuleList> withRuleMoved(const RuleList& rules, std::size_t index, int by) {
  const auto to = static_cast<std::ptrdiff_t>(index) + by;
  if (index >= rules.size || to < 0 || to >= static_cast<std::ptrdiff_t>(rules.size)) return std::nullopt;
  RuleList moved = rules;
  std::swap(moved.rule[index], moved.rule[static_cast<std::size_t>(to)]);
  return moved;
}

}  // namespace trimtab::views
