// SPDX-License-Identifier: GPL-3.0-or-later
#include "changes_panel.h"

#include <QAction>
#include <QApplication>
#include <QBoxLayout>
#include <QClipboard>
#include <QHeaderView>
#include <QLabel>
#include <QTableView>
#include <algorithm>

#include "views/model/changes_model.h"

namespace trimtab::views {

ChangesPanel::ChangesPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      model_(new ChangesModel(draft, this)),
      table_(new QTableView),
      summary_(new QLabel) {
  setUpTable();
  QVBoxLayout* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 4, 6, 4);
  layout->addWidget(summary_);
  layout->addWidget(table_, 1);
  connect(table_, &QTableView::clicked, this, &ChangesPanel::goTo);
  connect(table_, &QTableView::activated, this, &ChangesPanel::goTo);
  connect(&draft_.undoStack(), &QUndoStack::indexChanged, this, [this](int index) {
    if (table_->isVisible()) table_->scrollTo(model_->index(index, 0));
    summarise();
  });
  connect(&draft_, &Draft::referencesChanged, this, &ChangesPanel::summarise);
  summarise();
}

void ChangesPanel::setUpTable() {
  table_->setModel(model_);
  table_->setAccessibleName(tr("Changes"));
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setTabKeyNavigation(false);
  table_->setWordWrap(false);
  table_->setShowGrid(false);
  table_->setAlternatingRowColors(true);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 4);
  QHeaderView& header = *table_->horizontalHeader();
  header.setHighlightSections(false);
  header.setStretchLastSection(false);
  for (const int column : {ChangesModel::kWhat, ChangesModel::kBefore, ChangesModel::kAfter})
    header.setSectionResizeMode(column, QHeaderView::Stretch);
  header.resizeSection(ChangesModel::kWhen, fontMetrics().horizontalAdvance(QStringLiteral("00:00:00")) + 18);
  header.setSectionResizeMode(ChangesModel::kWhen, QHeaderView::Fixed);

  auto* copyRows = new QAction(tr("Copy"), table_);
  copyRows->setShortcut(QKeySequence::Copy);
  copyRows->setShortcutContext(Qt::WidgetShortcut);
  connect(copyRows, &QAction::triggered, this, &ChangesPanel::copy);
  auto* revertRow = new QAction(tr("Revert this change"), table_);
  revertRow->setShortcut(QKeySequence::Delete);
  revertRow->setShortcutContext(Qt::WidgetShortcut);
  connect(revertRow, &QAction::triggered, this, &ChangesPanel::revert);
  table_->addActions({copyRows, revertRow});
  table_->setContextMenuPolicy(Qt::ActionsContextMenu);
}

QString ChangesPanel::summary() const {
  return summary_->text();
}

void ChangesPanel::goTo(const QModelIndex& index) {
  draft_.undoStack().setIndex(index.row());
}

void ChangesPanel::revert() {
  const int row = table_->currentIndex().row();
  if (row <= 0) return;
  const Step step = draft_.step(row - 1);
  std::vector<Draft::KeyValue> values;
  for (const Change& change : step.changes) values.push_back({change.row->key, change.before});
  draft_.setValues(values, tr("Revert %1").arg(step.text));
}

void ChangesPanel::copy() {
  QList<int> rows;
  for (const QModelIndex& index : table_->selectionModel()->selectedRows()) rows << index.row();
  std::ranges::sort(rows);
  QApplication::clipboard()->setText(model_->toText(rows));
}

void ChangesPanel::summarise() {
  const auto differing = std::ranges::count_if(
      parameterRows(), [this](const ParameterRow& row) { return draft_.isChanged(row.key); });
  summary_->setText(differing == 0   ? tr("Nothing differs from the file.")
                    : differing == 1 ? tr("1 parameter differs from the file.")
                                     : tr("%1 parameters differ from the file.").arg(differing));
}

}  // namespace trimtab::views
