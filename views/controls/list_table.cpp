// SPDX-License-Identifier: GPL-3.0-or-later
#include "list_table.h"

#include <QAction>
#include <QBoxLayout>
#include <QHeaderView>
#include <QTableView>
#include <QToolButton>

namespace trimtab::views {

void setUpListTable(QTableView& table, QAbstractItemModel* model, const QString& name,
                    const QString& sample) {
  table.setModel(model);
  table.setAccessibleName(name);
  table.setSelectionBehavior(QAbstractItemView::SelectRows);
  table.setSelectionMode(QAbstractItemView::SingleSelection);
  table.setTabKeyNavigation(false);
  table.verticalHeader()->hide();
  table.verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table.horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  table.horizontalHeader()->setMinimumSectionSize(table.fontMetrics().horizontalAdvance(sample) + 10);
  table.setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  table.setMinimumWidth(model->columnCount() * table.horizontalHeader()->minimumSectionSize() + 24);
}

ListButtons::ListButtons(QWidget* parent) : QWidget(parent), row_(new QHBoxLayout(this)) {
  row_->setContentsMargins(0, 0, 0, 0);
  row_->addStretch(1);
}

QToolButton* ListButtons::add(const QString& text, const QString& tip) {
  auto* button = new QToolButton;
  button->setText(text);
  button->setToolTip(tip);
  button->setAccessibleName(tip);
  button->setFocusPolicy(Qt::StrongFocus);
  // The button stands before the stretch, or behind it once there is a space.
  row_->insertWidget(spaced_ ? row_->count() : row_->count() - 1, button);
  return button;
}

void ListButtons::addSpace() {
  spaced_ = true;
}

void addCommand(QTableView& table, QToolButton& button, const QKeySequence& key, std::function<void()> act) {
  auto* action = new QAction(button.text(), &table);
  action->setShortcut(key);
  action->setShortcutContext(Qt::WidgetShortcut);
  table.addAction(action);
  table.setContextMenuPolicy(Qt::ActionsContextMenu);
  QObject::connect(&button, &QToolButton::clicked, action, &QAction::trigger);
  QObject::connect(action, &QAction::triggered, &table, std::move(act));
}

}  // namespace trimtab::views
