// SPDX-License-Identifier: GPL-3.0-or-later
#include "signals_list.h"

#include <QHeaderView>
#include <QScrollBar>
#include <algorithm>
#include <cmath>

#include "views/model/theme.h"
#include "views/model/value_text.h"

namespace trimtab::views {

SignalsModel::SignalsModel(PolicyDraft& policy, QObject* parent)
    : QAbstractTableModel(parent), policy_(policy) {
  const auto mark = [this] {
    for (const SignalRow& row : kSignalRows) {
      const bool used = policy_.uses(row.signal);
      if (std::exchange(used_[indexOf(row.signal)], used) == used) continue;
      const int at = rowOfSignal(row.signal);
      emit dataChanged(index(at, 0), index(at, kColumns - 1));
    }
  };
  mark();
  connect(&policy_, &PolicyDraft::rulesChanged, this, mark);
  connect(&policy_, &PolicyDraft::termsChanged, this,
          [this] { emit dataChanged(index(1, kName), index(rowCount() - 1, kName), {Qt::ToolTipRole}); });
}

std::optional<Signal> SignalsModel::signalOfRow(int row) {
  if (row <= kScheme || row > static_cast<int>(kSignals)) return std::nullopt;
  return static_cast<Signal>(row - 1);
}

int SignalsModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(kSignals) + 1;
}

void SignalsModel::showLive(const PolicyLive& live) {
  const bool other = std::exchange(seen_, live.seen) != live.seen;
  for (const SignalRow& row : kSignalRows) {
    const double value = live.flight[row.signal];
    QString text = live.seen && !std::isnan(value) ? signalText(row.signal, value) : QString();
    QString& shown = values_[indexOf(row.signal)];
    if (text == shown && !other) continue;
    shown = std::move(text);
    emit dataChanged(index(rowOfSignal(row.signal), kValue), index(rowOfSignal(row.signal), kValue));
  }
}

void SignalsModel::useKeys(bool keys) {
  if (std::exchange(keys_, keys) != keys) emit dataChanged(index(1, kName), index(rowCount() - 1, kName));
}

QString SignalsModel::toolTip(Signal signal) const {
  const SignalRow& row = rowOf(signal);
  QString text = QStringLiteral("<p><b>%1</b>%2</p><p>%3.</p>")
                     .arg(fromView(row.label), inParentheses(row.unit), fromView(row.derived));
  text += tr("<p>It counts from %1 to %2.</p>")
              .arg(signalText(signal, row.range.low), signalText(signal, row.range.high));
  if (row.filterS > 0) text += tr("<p>It is smoothed over %1 s.</p>").arg(numberText(row.filterS, 2));
  text += tr("<p>Terms: %1. %2</p>")
              .arg(policy_.termsOf(signal).size())
              .arg(used_[indexOf(signal)] ? tr("Rules ask for it.") : tr("No rule asks for it."));
  if (!seen_)
    text += tr("<p>Signals are known from the first image on.</p>");
  else if (values_[indexOf(signal)].isEmpty())
    text += tr("<p>Unknown: %1.%2</p>")
                .arg(fromView(row.unknown), signal == Signal::above_ground && !used_[indexOf(signal)]
                                                ? tr(" The terrain is asked only if a rule is.")
                                                : QString());
  return text;
}

QVariant SignalsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const auto signal = signalOfRow(index.row());
  if (!signal) {
    if (role == Qt::DisplayRole && index.column() == kName) return tr("Culling scheme");
    if (role == Qt::AccessibleTextRole) return tr("Culling scheme by altitude and pitch");
    if (role == Qt::ToolTipRole)
      return tr("<p><b>Culling scheme</b></p><p>Altitude and pitch curves, rules and surface that choose "
                "the culling scheme and the size of the depth map.%1</p>")
          .arg(documentsHtml("A, B"));
    return {};
  }
  const std::size_t at = indexOf(*signal);
  const bool known = !values_[at].isEmpty();
  switch (role) {
    case Qt::DisplayRole:
      if (index.column() == kName)
        return (used_[at] ? QStringLiteral("● ") : QStringLiteral("○ ")) +
               fromView(keys_ ? rowOf(*signal).key : rowOf(*signal).label);
      return known ? values_[at] : seen_ ? tr("unknown") : QStringLiteral("–");
    case Qt::AccessibleTextRole:
      if (index.column() == kName)
        return fromView(rowOf(*signal).label) + (used_[at] ? tr(", used by rules") : QString());
      return {};
    case Qt::TextAlignmentRole:
      return index.column() == kValue ? QVariant(Qt::AlignRight | Qt::AlignVCenter) : QVariant();
    case Qt::ForegroundRole:
      if (index.column() == kValue && !known) return quietColour(QPalette());
      return {};
    case Qt::ToolTipRole:
      return toolTip(*signal);
    default:
      return {};
  }
}

QVariant SignalsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation == Qt::Vertical || role != Qt::DisplayRole) return {};
  return section == kName ? tr("Signal") : tr("Now");
}

SignalsList::SignalsList(PolicyDraft& policy, QWidget* parent)
    : QTableView(parent), model_(new SignalsModel(policy, this)) {
  setModel(model_);
  setAccessibleName(tr("Signals"));
  setSelectionBehavior(SelectRows);
  setSelectionMode(SingleSelection);
  setEditTriggers(NoEditTriggers);
  setTabKeyNavigation(false);
  setShowGrid(false);
  setWordWrap(false);
  setTextElideMode(Qt::ElideRight);
  verticalHeader()->hide();
  verticalHeader()->setMinimumSectionSize(fontMetrics().height() + 1);
  verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 3);
  horizontalHeader()->hide();
  horizontalHeader()->setSectionResizeMode(SignalsModel::kName, QHeaderView::Stretch);
  horizontalHeader()->setSectionResizeMode(SignalsModel::kValue, QHeaderView::Fixed);
  setColumnWidth(SignalsModel::kValue, fontMetrics().horizontalAdvance(QStringLiteral("0,000.0 deg/s")) + 4);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setMinimumHeight(fontMetrics().height() * 5);
  choose(std::nullopt);
  setMinimumWidth(wholeWidth());
  connect(selectionModel(), &QItemSelectionModel::currentRowChanged, this, &SignalsList::chosenChanged);
}

int SignalsList::wholeWidth() const {
  const bool values = !isColumnHidden(SignalsModel::kValue);
  int names = 0;
  for (const SignalRow& row : kSignalRows)
    names = std::max(names, fontMetrics().horizontalAdvance(QStringLiteral("● ") +
                                                            fromView(values ? row.label : row.key)));
  const int bar = verticalScrollBar()->sizeHint().width();
  return names + 16 + bar + (values ? columnWidth(SignalsModel::kValue) : 0);
}

void SignalsList::showValues(bool shown) {
  setColumnHidden(SignalsModel::kValue, !shown);
  model_->useKeys(!shown);
  setMinimumWidth(wholeWidth());
}

std::optional<Signal> SignalsList::chosen() const {
  return SignalsModel::signalOfRow(currentIndex().row());
}

void SignalsList::choose(std::optional<Signal> signal) {
  setCurrentIndex(model_->index(signal ? SignalsModel::rowOfSignal(*signal) : SignalsModel::kScheme, 0));
}

void SignalsList::keyboardSearch(const QString& typed) {
  const int count = model_->rowCount(), from = std::max(0, currentIndex().row());
  for (int i = 1; i <= count; ++i) {
    const auto signal = SignalsModel::signalOfRow((from + i) % count);
    if (!signal || !fromView(rowOf(*signal).label).startsWith(typed, Qt::CaseInsensitive)) continue;
    choose(*signal);
    return;
  }
}

}  // namespace trimtab::views
