// SPDX-License-Identifier: GPL-3.0-or-later
#include "lever_chain_table.h"

#include <QHeaderView>

#include "views/model/theme.h"

namespace trimtab::views {

LeverChainTable::LeverChainTable(QWidget* parent)
    : QTableWidget(int(kFrameLeverRows.size()), int(kLeverSteps) + 1, parent) {
  setAccessibleName(tr("Levers, from the preset to the image"));
  QStringList levers, steps;
  for (const FrameLeverRow& row : kFrameLeverRows) levers << fromView(row.label);
  for (std::size_t i = 0; i < kLeverSteps; ++i) {
    QString name = fromView(toText(static_cast<LeverStep>(i)));
    name[0] = name[0].toUpper();
    steps << name;
  }
  setVerticalHeaderLabels(levers);
  setHorizontalHeaderLabels(steps << tr("Drawn"));
  horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  setEditTriggers(QAbstractItemView::NoEditTriggers);
  setSelectionMode(QAbstractItemView::NoSelection);
  for (int row = 0; row < rowCount(); ++row)
    for (int column = 0; column < columnCount(); ++column) {
      auto* item = new QTableWidgetItem;
      item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
      setItem(row, column, item);
    }
  const int rowHeight = fontMetrics().height() + 6;
  verticalHeader()->setDefaultSectionSize(rowHeight);
  setFixedHeight(rowHeight * (rowCount() + 1) + 6);
  setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
}

void LeverChainTable::showChain(const LeverChain& chain, const std::array<QString, kLeverSteps>& reasons) {
  for (std::size_t i = 0; i < kFrameLeverRows.size(); ++i) {
    const FrameLeverRow& row = kFrameLeverRows[i];
    const QString whole = QString::fromStdString(explain(chain, row));
    for (std::size_t s = 0; s <= kLeverSteps; ++s) {
      const bool last = s == kLeverSteps;
      const FrameLevers& now = last ? chain.drawn : chain.after(static_cast<LeverStep>(s));
      const bool changes =
          last || s == 0 || valueOf(now, row) != valueOf(chain.after(static_cast<LeverStep>(s - 1)), row);
      QTableWidgetItem& cell = *item(int(i), int(s));
      cell.setText(changes ? QString::fromStdString(valueText(now, row)) : QString());
      cell.setToolTip(whole);
      QFont text = font();
      text.setBold(last && lastChange(chain, row) != LeverStep::preset);
      cell.setFont(text);
    }
  }
  for (std::size_t s = 0; s < kLeverSteps; ++s) horizontalHeaderItem(int(s))->setToolTip(reasons[s]);
}

}  // namespace trimtab::views
