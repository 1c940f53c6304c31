// SPDX-License-Identifier: GPL-3.0-or-later
#include "policy_rules_model.h"

#include <QMimeData>
#include <algorithm>
#include <cmath>

#include "bar_cell.h"
#include "trimtab/units/not_finite.h"
#include "trimtab/units/number.h"
#include "views/model/ig_words.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

/// Reports whether a rule sets a lever that the image generator does not have.
bool setsWhatIsLacking(const PolicyRule& rule, const IgProfile* ig) {
  return std::ranges::any_of(rule.settings, [ig](const LeverSetting& setting) {
    return !lacksText(ig, rowOf(setting.lever).key).isEmpty();
  });
}

const QString kMime = QStringLiteral("application/x-trimtab-policy-rule");

}  // namespace

QString settingsText(const PolicyRule& rule) {
  QStringList texts;
  for (const LeverSetting& setting : rule.settings)
    texts << QStringLiteral("%1 = %2").arg(fromView(rowOf(setting.lever).key),
                                           QString::fromStdString(trimtab::numberText(setting.value)));
  return texts.join(QStringLiteral(", "));
}

PolicyRulesModel::PolicyRulesModel(PolicyDraft& policy, QObject* parent)
    : RowsModel(parent), policy_(policy) {
  refresh();
  connect(&policy_, &PolicyDraft::rulesChanged, this, &PolicyRulesModel::refresh);
  connect(&policy_.draft(), &Draft::imageGeneratorChanged, this, [this] {
    if (rowCount() > 0)
      emit dataChanged(index(0, 0), index(rowCount() - 1, kColumns - 1),
                       {Qt::ForegroundRole, Qt::ToolTipRole});
  });
  // A term that is gone breaks rules.
  connect(&policy_.draft(), &Draft::findingsChanged, this, [this] {
    const std::vector<bool> before = broken_;
    broken_.assign(policy_.rules().size(), false);
    if (policy_.draft().isBroken())
      for (std::size_t i = 0; i < broken_.size(); ++i) {
        const auto& rule = policy_.rules()[i].rule;
        broken_[i] = !rule || !policy_.check(*rule).empty();
      }
    if (broken_ != before && rowCount() > 0)
      emit dataChanged(index(0, 0), index(rowCount() - 1, kColumns - 1),
                       {Qt::ForegroundRole, Qt::ToolTipRole});
  });
}

void PolicyRulesModel::refresh() {
  firing_.resize(policy_.rules().size(), kNan);
  broken_.resize(policy_.rules().size(), false);
  refreshRows(static_cast<int>(policy_.rules().size()));
}

void PolicyRulesModel::showLive(const PolicyLive& live) {
  const bool known = live.decided && live.matches && live.decision.firing.size() == firing_.size();
  for (std::size_t i = 0; i < firing_.size(); ++i) {
    const double now = known ? shownShare(live.decision.firing[i]) : kNan;
    if (now == firing_[i] || (std::isnan(now) && std::isnan(firing_[i]))) continue;
    firing_[i] = now;
    emit dataChanged(index(static_cast<int>(i), kFires), index(static_cast<int>(i), kFires));
  }
}

QVariant PolicyRulesModel::text(const PolicyDraft::RuleLine& line, int column, double firing) const {
  if (!line.rule) return column == kCondition ? QString::fromStdString(line.text) : QString();
  switch (column) {
    case kCondition:
      return QString::fromStdString(line.rule->condition);
    case kSettings:
      return settingsText(*line.rule);
    case kWeight:
      return QString::fromStdString(trimtab::numberText(line.rule->weight));
    case kReason:
      return QString::fromStdString(line.rule->reason);
    case kFires:
      return std::isnan(firing) ? QStringLiteral("–") : QString::number(firing, 'f', 2);
    default:
      return {};
  }
}

QVariant PolicyRulesModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= static_cast<int>(policy_.rules().size())) return {};
  const auto row = static_cast<std::size_t>(index.row());
  const PolicyDraft::RuleLine& line = policy_.rules()[row];
  const int column = index.column();
  const bool on = line.rule && line.rule->enabled;
  switch (role) {
    case Qt::DisplayRole:
    case Qt::EditRole:
      return text(line, column, firing_[row]);
    case Qt::CheckStateRole:
      return column == kOn && line.rule ? QVariant(on ? Qt::Checked : Qt::Unchecked) : QVariant();
    case Qt::AccessibleTextRole:
      if (column == kOn) return on ? tr("rule %1 is on").arg(row + 1) : tr("rule %1 is off").arg(row + 1);
      return {};
    case Qt::ForegroundRole:
      if (!line.rule || broken_[row]) return errorColour(QPalette());
      if (column == kSettings && setsWhatIsLacking(*line.rule, policy_.draft().imageGenerator()))
        return quietColour(QPalette());
      return on ? QVariant() : QVariant(quietColour(QPalette()));
    case Qt::ToolTipRole: {
      if (!line.rule) return tr("This line cannot be read; type the whole rule: if … then …");
      if (broken_[row]) return sentences(policy_.check(*line.rule));
      QStringList units;
      for (const LeverSetting& setting : line.rule->settings) {
        const LeverRow& lever = rowOf(setting.lever);
        QString unit =
            QStringLiteral("%1: %2").arg(fromView(lever.label), leverText(setting.lever, setting.value));
        const IgProfile* const ig = policy_.draft().imageGenerator();
        for (const QString& more : {lacksText(ig, lever.key), ownRangeText(ig, lever.key)})
          if (!more.isEmpty()) unit += QStringLiteral(" (%1)").arg(more.toHtmlEscaped());
        units << unit;
      }
      return tr("<p>if %1</p><p>%2</p><p>%3</p>")
          .arg(QString::fromStdString(line.rule->condition).toHtmlEscaped(),
               units.join(QStringLiteral("<br>")), QString::fromStdString(line.rule->reason).toHtmlEscaped());
    }
    case Qt::TextAlignmentRole:
      return column == kWeight ? QVariant(Qt::AlignRight | Qt::AlignVCenter) : QVariant();
    case kBarRole:
      return column == kFires && on && !std::isnan(firing_[row]) ? QVariant(firing_[row]) : QVariant();
    default:
      return {};
  }
}

QVariant PolicyRulesModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation == Qt::Vertical) return role == Qt::DisplayRole ? QVariant(section + 1) : QVariant();
  if (role == Qt::DisplayRole) {
    const QString names[] = {tr("On"), tr("If"), tr("Then"), tr("Weight"), tr("Fires"), tr("Reason")};
    return names[section];
  }
  if (role == Qt::ToolTipRole) {
    const QString tips[] = {tr("Whether the rule counts (Space)"),
                            tr("Such as: above_ground is low and not speed is very fast"),
                            tr("Such as: screen_space_error = 4, far_distance = 0.8"),
                            tr("How much the rule counts when it fires, 0 to 1"),
                            tr("Membership of the condition times the weight, now"),
                            tr("Why the rule is there")};
    return tips[section];
  }
  return {};
}

Qt::ItemFlags PolicyRulesModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags flags = RowsModel::flags(index);
  if (!index.isValid()) return flags | Qt::ItemIsDropEnabled;
  const bool readable = policy_.rules()[static_cast<std::size_t>(index.row())].rule.has_value();
  flags |= Qt::ItemIsDragEnabled;
  if (index.column() == kOn) {
    if (readable) flags |= Qt::ItemIsUserCheckable;
  } else if (index.column() == kCondition || (readable && index.column() != kFires)) {
    flags |= Qt::ItemIsEditable;
  }
  return flags;
}

std::optional<PolicyRule> PolicyRulesModel::changed(const QModelIndex& index, const QString& typed,
                                                    QString& why) const {
  const PolicyDraft::RuleLine& line = policy_.rules()[static_cast<std::size_t>(index.row())];
  PolicyRule rule = line.rule.value_or(PolicyRule{});
  const std::string text = typed.trimmed().toStdString();
  const auto take = [&](const std::string& whole) -> std::optional<PolicyRule> {
    auto read = readPolicyRule(whole, "");
    if (!read) why = sentences(read.findings());
    return read ? std::optional(*std::move(read)) : std::nullopt;
  };
  if (!line.rule || (index.column() == kCondition && text.starts_with("if "))) {
    const auto read = take(text);
    if (!read) return std::nullopt;
    rule.condition = read->condition;
    rule.settings = read->settings;
    rule.weight = read->weight;
  } else if (index.column() == kCondition) {
    rule.condition = text;
  } else if (index.column() == kSettings) {
    const auto read = take("if altitude is any then " + text);
    if (!read) return std::nullopt;
    rule.settings = read->settings;
    if (read->weight != 1) rule.weight = read->weight;
  } else if (index.column() == kWeight) {
    const auto number = parseNumber(typed, {});
    if (!number) {
      why = tr("“%1” is not a number.").arg(typed);
      return std::nullopt;
    }
    rule.weight = *number;
  } else {
    rule.reason = text;
    return rule;
  }
  if (const Findings wrong = policy_.check(rule); !wrong.empty()) {
    why = sentences(wrong);
    return std::nullopt;
  }
  return rule;
}

QString PolicyRulesModel::refusal(const QModelIndex& index, const QString& text) const {
  QString why;
  changed(index, text, why);
  return why;
}

bool PolicyRulesModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (!index.isValid()) return false;
  const auto row = static_cast<std::size_t>(index.row());
  const PolicyDraft::RuleLine& line = policy_.rules()[row];
  if (role == Qt::CheckStateRole && index.column() == kOn && line.rule) {
    PolicyRule rule = *line.rule;
    rule.enabled = value.toInt() == Qt::Checked;
    policy_.putRule(row, rule, rule.enabled ? tr("Switch Rule On") : tr("Switch Rule Off"));
    return true;
  }
  if (role != Qt::EditRole) return false;
  QString why;
  const auto rule = changed(index, value.toString(), why);
  if (!rule) return false;
  if (!line.rule || *rule != *line.rule) policy_.putRule(row, *rule, tr("Edit Rule"));
  return true;
}

QStringList PolicyRulesModel::mimeTypes() const {
  return {kMime};
}

QMimeData* PolicyRulesModel::mimeData(const QModelIndexList& indexes) const {
  auto* data = new QMimeData;
  if (!indexes.isEmpty()) data->setData(kMime, QByteArray::number(indexes.first().row()));
  return data;
}

bool PolicyRulesModel::dropMimeData(const QMimeData* data, Qt::DropAction, int row, int,
                                    const QModelIndex& parent) {
  if (!data->hasFormat(kMime)) return false;
  const int from = data->data(kMime).toInt();
  int to = row >= 0 ? row : parent.isValid() ? parent.row() : rowCount();
  if (to > from) --to;  // the row leaves its place first
  if (from < 0 || from >= rowCount() || to == from) return false;
  policy_.moveRule(static_cast<std::size_t>(from), static_cast<std::size_t>(to));
  emit moved(to);
  // The view must not remove the row: it has moved already.
  return false;
}

}  // namespace trimtab::views
