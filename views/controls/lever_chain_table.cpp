// SPDX-License-Identifier: GPL-3.0-or-later
#include "lever_chain_table.h"

#include <QHeaderView>

#include "views/model/ig_words.h"
#include "views/model/theme.h"

namespace trimtab::views {

LeverChainTable::LeverChainTable(QWidget* parent)
    : QTableWidget(int(kFrameLeverRows.size()), kColumns, parent) {
  setAccessibleName(tr("Levers, from the preset to the image"));
  QStringList levers;
  for (const FrameLeverRow& row : kFrameLeverRows) levers << fromView(row.label);
  setVerticalHeaderLabels(levers);
  setHorizontalHeaderLabels({tr("Drawn"), tr("From the preset on")});
  horizontalHeader()->setSectionResizeMode(kDrawn, QHeaderView::ResizeToContents);
  horizontalHeader()->setSectionResizeMode(kChain, QHeaderView::Stretch);
  setEditTriggers(QAbstractItemView::NoEditTriggers);
  setSelectionMode(QAbstractItemView::NoSelection);
  for (int row = 0; row < rowCount(); ++row) {
    setItem(row, kDrawn, new QTableWidgetItem);
    setItem(row, kChain, new QTableWidgetItem);
    item(row, kDrawn)->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
  }
  const int rowHeight = fontMetrics().height() + 6;
  verticalHeader()->setDefaultSectionSize(rowHeight);
  setFixedHeight(rowHeight * (rowCount() + 1) + 6);
  setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
}

void LeverChainTable::showChain(const LeverChain& chain, const std::array<QString, kLeverSteps>& reasons,
                                const IgProfile* ig) {
  for (std::size_t i = 0; i < kFrameLeverRows.size(); ++i) {
    const FrameLeverRow& row = kFrameLeverRows[i];
    const LeverStep last = lastChange(chain, row);
    const QString whole = QString::fromStdString(explain(chain, row));
    QFont text = font();
    text.setBold(last != LeverStep::preset);
    item(int(i), kDrawn)->setText(QString::fromStdString(valueText(chain.drawn, row)));
    item(int(i), kChain)->setText(last == LeverStep::preset ? fromView(toText(last)) : whole);
    for (const int column : {kDrawn, kChain}) {
      item(int(i), column)->setFont(text);
      item(int(i), column)->setToolTip(tr("%1. %2").arg(whole, reasons[static_cast<std::size_t>(last)]));
    }
  }
  showWhatIgHas(*this, chain, ig);
}

void showWhatIgHas(QTableWidget& table, const LeverChain& chain, const IgProfile* ig) {
  for (std::size_t i = 0; i < kFrameLeverRows.size(); ++i) {
    const FrameLeverRow& row = kFrameLeverRows[i];
    const QString lacks = lacksText(ig, row.key);
    const QString says = lacks.isEmpty() ? ownValueText(ig, row, chain) : lacks;
    const QVariant ink = lacks.isEmpty() ? QVariant() : QVariant(quietColour(table.palette()));
    QTableWidgetItem& name = *table.verticalHeaderItem(int(i));
    name.setData(Qt::ForegroundRole, ink);
    name.setToolTip(says);
    for (int column = 0; column < table.columnCount(); ++column) {
      QTableWidgetItem& item = *table.item(int(i), column);
      item.setData(Qt::ForegroundRole, ink);
      if (!says.isEmpty()) item.setToolTip(item.toolTip() + QStringLiteral("\n") + says);
    }
  }
}

}  // namespace trimtab::views
