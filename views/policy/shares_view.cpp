// SPDX-License-Identifier: GPL-3.0-or-later
#include "shares_view.h"

#include <QHeaderView>
#include <algorithm>
#include <cmath>

#include "bar_cell.h"
#include "trimtab/units/not_finite.h"
#include "views/model/ig_words.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace

void SharesModel::rebuild(const PolicyLive& live) {
  beginResetModel();
  policy_ = live.policy;
  levers_.clear();
  for (const LeverRow& row : kLeverRows)
    for (const PolicyRule& rule : policy_.rules) {
      const auto sets = [&](const LeverSetting& s) { return s.lever == row.lever; };
      if (std::none_of(rule.settings.begin(), rule.settings.end(), sets)) continue;
      levers_.push_back(row.lever);
      break;
    }
  rows_.clear();
  for (const PolicyRule& rule : policy_.rules) {
    Row row{QString::fromStdString(rule.condition), rule.enabled && rule.weight > 0,
            std::vector<double>(levers_.size() + 1, kNan), std::vector<double>(levers_.size(), kNan)};
    for (const LeverSetting& setting : rule.settings)
      for (std::size_t l = 0; l < levers_.size(); ++l)
        if (levers_[l] == setting.lever) row.settings[l] = setting.value;
    rows_.push_back(std::move(row));
  }
  endResetModel();
}

void SharesModel::showLive(const PolicyLive& live) {
  if (live.policy != policy_) rebuild(live);
  QStringList lacks;
  for (const Lever lever : levers_) lacks << lacksText(live.ig, rowOf(lever).key);
  if (lacks != lacks_) {
    lacks_ = lacks;
    emit headerDataChanged(Qt::Horizontal, kFirstLever, columnCount() - 1);
  }
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (std::size_t c = 0; c <= levers_.size(); ++c) {
      double now = kNan;
      if (live.decided && rows_[r].counts) {
        if (c == 0)
          now = shownShare(live.decision.firing[r]);
        else if (!std::isnan(rows_[r].settings[c - 1]))
          now = shownShare(live.share(r, levers_[c - 1]));
      }
      double& shown = rows_[r].values[c];
      if (same(shown, now)) continue;
      shown = now;
      const QModelIndex cell = index(static_cast<int>(r), kFires + static_cast<int>(c));
      emit dataChanged(cell, cell);
    }
}

int SharesModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

QVariant SharesModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const Row& row = rows_[static_cast<std::size_t>(index.row())];
  if (index.column() == kRule) {
    if (role == Qt::DisplayRole || role == Qt::ToolTipRole) return row.rule;
    if (role == Qt::ForegroundRole && !(row.values[0] > 0)) return quietColour(QPalette());
    return {};
  }
  const auto at = static_cast<std::size_t>(index.column() - kFires);
  const double value = row.values[at];
  switch (role) {
    case Qt::DisplayRole:
      if (std::isnan(value)) return QString();
      return at == 0 ? QString::number(value, 'f', 2) : QStringLiteral("%1 %").arg(value * 100, 0, 'f', 0);
    case Qt::ToolTipRole:
      if (at == 0) return tr("Membership of the condition times the weight");
      if (std::isnan(row.settings[at - 1])) return tr("The rule does not set this lever");
      return tr("The rule sets %1 to %2")
          .arg(fromView(rowOf(levers_[at - 1]).label), leverText(levers_[at - 1], row.settings[at - 1]));
    case kBarRole:
      return std::isnan(value) ? QVariant() : QVariant(value);
    case kBarColourRole:
      return seriesColour(at == 0 ? 3 : 0, QPalette());
    default:
      return {};
  }
}

QVariant SharesModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation == Qt::Vertical) return role == Qt::DisplayRole ? QVariant(section + 1) : QVariant();
  const int lever = section - kFirstLever;
  if (role == Qt::DisplayRole) {
    if (section == kRule) return tr("If");
    if (section == kFires) return tr("Fires");
    return fromView(rowOf(levers_[static_cast<std::size_t>(lever)]).key)
        .replace(QLatin1Char('_'), QLatin1Char('\n'));
  }
  const QString lacks = lever >= 0 ? lacks_.value(lever) : QString();
  if (role == Qt::ForegroundRole && !lacks.isEmpty()) return quietColour(QPalette());
  if (role == Qt::ToolTipRole && lever >= 0)
    return tr("Share of each rule in %1")
               .arg(fromView(rowOf(levers_[static_cast<std::size_t>(lever)]).label)) +
           (lacks.isEmpty() ? QString() : QStringLiteral(". ") + lacks);
  return {};
}

SharesView::SharesView(QWidget* parent) : QTableView(parent), model_(new SharesModel(this)) {
  setModel(model_);
  setAccessibleName(tr("Firing and shares of the rules"));
  setSelectionBehavior(SelectRows);
  setSelectionMode(SingleSelection);
  setEditTriggers(NoEditTriggers);
  setTabKeyNavigation(false);
  setShowGrid(false);
  setWordWrap(false);
  setItemDelegate(new BarCell(this));
  setHorizontalScrollMode(ScrollPerPixel);
  verticalHeader()->setSectionResizeMode(QHeaderView::Fixed);
  verticalHeader()->setMinimumSectionSize(fontMetrics().height() + 2);
  verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 5);
  setMinimumHeight(fontMetrics().height() * 9);
  const auto arrange = [this] {
    const int bar = fontMetrics().horizontalAdvance(QStringLiteral("distance")) + 12;
    horizontalHeader()->setMinimumSectionSize(bar);
    // Conditions may be longer than the dock is wide: they stand behind what the view is for, and whole.
    horizontalHeader()->setSectionResizeMode(SharesModel::kRule, QHeaderView::ResizeToContents);
    horizontalHeader()->moveSection(horizontalHeader()->visualIndex(SharesModel::kRule),
                                    model_->columnCount() - 1);
    for (int column = SharesModel::kFires; column < model_->columnCount(); ++column) {
      horizontalHeader()->setSectionResizeMode(column, QHeaderView::Fixed);
      horizontalHeader()->resizeSection(column, bar);
    }
  };
  connect(model_, &QAbstractItemModel::modelReset, this, arrange);
  arrange();
}

void SharesView::showLive(const PolicyLive& live) {
  model_->showLive(live);
}

}  // namespace trimtab::views
