// SPDX-License-Identifier: GPL-3.0-or-later
#include "rules_model.h"

#include "keys.h"
#include "theme.h"
#include "views/editors/rule_edit.h"

namespace trimtab::views {

RulesModel::RulesModel(Draft& draft, QObject* parent) : RowsModel(parent), draft_(draft) {
  const auto refresh = [this] { refreshRows(static_cast<int>(rules().size)); };
  refresh();
  connect(&draft_, &Draft::valueChanged, this, [refresh](const QString& key) {
    if (key.toStdString() == key::kRules) refresh();
  });
}

QStringList RulesModel::conditionsOf(int column) {
  return column == kAltitude ? altitudeConditions() : column == kPitch ? pitchConditions() : QStringList();
}

RuleList RulesModel::rules() const {
  return std::get<RuleList>(draft_.value(key::kRules));
}

bool RulesModel::put(const RuleList& rules) {
  if (const Findings findings = draft_.setValue(key::kRules, rules); !findings.empty()) {
    emit refused(QString::fromStdString(toString(findings)));
    return false;
  }
  emit accepted();
  return true;
}

QVariant RulesModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const RuleList list = rules();
  const FuzzyRule& rule = list.rule[static_cast<std::size_t>(index.row())];
  const bool isCondition = index.column() <= kPitch;
  if (isCondition && (role == Qt::DisplayRole || role == Qt::EditRole)) {
    const int chosen =
        index.column() == kAltitude ? static_cast<int>(rule.altitude) : static_cast<int>(rule.pitch);
    return role == Qt::EditRole ? QVariant(chosen) : QVariant(conditionsOf(index.column()).value(chosen));
  }
  if (role == Qt::DisplayRole || role == Qt::EditRole)
    return numberText(index.column() == kWeight ? rule.weight : rule.output, 6);
  if (role == Qt::TextAlignmentRole && !isCondition) return QVariant(Qt::AlignRight | Qt::AlignVCenter);
  return {};
}

QVariant RulesModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation == Qt::Vertical) return role == Qt::DisplayRole ? QVariant(section + 1) : QVariant();
  if (role == Qt::ToolTipRole && section == kWeight)
    return tr("λ of Eq. (2): how much the rule counts when it fires; 0 leaves it out");
  if (role == Qt::ToolTipRole && section == kOutput)
    return tr("u of Eq. (2): the total, 0 to 2, that the rule asks for");
  if (role != Qt::DisplayRole) return {};
  switch (section) {
    case kAltitude:
      return tr("Altitude");
    case kPitch:
      return tr("Pitch");
    case kWeight:
      return tr("Weight λ");
    default:
      return tr("Output u");
  }
}

Qt::ItemFlags RulesModel::flags(const QModelIndex& index) const {
  return QAbstractTableModel::flags(index) | Qt::ItemIsEditable;
}

bool RulesModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || !index.isValid()) return false;
  RuleList changed = rules();
  FuzzyRule& rule = changed.rule[static_cast<std::size_t>(index.row())];
  const auto refuse = [&](const QString& why) {
    emit refused(why);
    return false;
  };
  if (index.column() <= kPitch) {
    const int chosen = value.toInt();
    if (chosen < 0 || chosen >= conditionsOf(index.column()).size()) return false;
    if (index.column() == kAltitude)
      rule.altitude = static_cast<AltitudeCondition>(chosen);
    else
      rule.pitch = static_cast<PitchCondition>(chosen);
    return put(changed);
  }
  const std::optional<double> number = parseNumber(value.toString(), {});
  if (!number) return refuse(tr("“%1” is not a number.").arg(value.toString()));
  const bool isWeight = index.column() == kWeight;
  const Range hard = isWeight ? findRow(key::kRules)->hard : Range{0, BandList::kTop};
  if (!(*number >= hard.low && *number <= hard.high))
    return refuse(
        (isWeight ? tr("A weight is from %1 to %2, not %3.") : tr("An output is from %1 to %2, not %3."))
            .arg(numberText(hard.low, 0), numberText(hard.high, 0), numberText(*number, 6)));
  (isWeight ? rule.weight : rule.output) = *number;
  return put(changed);
}

}  // namespace trimtab::views
