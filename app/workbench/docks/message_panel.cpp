// SPDX-License-Identifier: GPL-3.0-or-later
#include "message_panel.h"

#include <QAction>
#include <QClipboard>
#include <QGuiApplication>
#include <QHeaderView>
#include <QStyle>
#include <QTime>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>

namespace trimtab::workbench {
namespace {

constexpr int kMostRows = 1000;
enum MessageColumn { kWhat, kWhere, kKey, kExpected, kFound, kMessageColumns };

QStyle::StandardPixmap iconOf(Severity severity) {
  switch (severity) {
    case Severity::error:
      return QStyle::SP_MessageBoxCritical;
    case Severity::warning:
      return QStyle::SP_MessageBoxWarning;
    case Severity::note:
      break;
  }
  return QStyle::SP_MessageBoxInformation;
}

QString severityText(Severity severity) {
  switch (severity) {
    case Severity::error:
      return MessagePanel::tr("error");
    case Severity::warning:
      return MessagePanel::tr("warning");
    case Severity::note:
      break;
  }
  return MessagePanel::tr("note");
}

QString rowText(const QTreeWidgetItem& item) {
  QStringList cells;
  for (int column = 0; column < kMessageColumns; ++column) cells << item.text(column);
  while (!cells.isEmpty() && cells.last().isEmpty()) cells.removeLast();
  return (item.parent() != nullptr ? QStringLiteral("\t") : QString()) + cells.join('\t');
}

}  // namespace

MessagePanel::MessagePanel(QWidget* parent) : QWidget(parent), tree_(new QTreeWidget(this)) {
  tree_->setColumnCount(kMessageColumns);
  tree_->setHeaderLabels({tr("Message"), tr("Where"), tr("Key"), tr("Expected"), tr("Found")});
  tree_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  tree_->setUniformRowHeights(true);
  tree_->setAccessibleName(tr("Messages"));
  // A headline spans all columns, so the first holds a severity only: what was found must be in sight.
  tree_->header()->resizeSection(kWhat, 120);
  // The others share the width, so that none is beyond the edge; a tool tip has the whole of each.
  for (const int column : {kWhere, kKey, kExpected, kFound})
    tree_->header()->setSectionResizeMode(column, QHeaderView::Stretch);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(tree_);

  auto* copy = new QAction(tr("Copy"), tree_);
  copy->setShortcut(QKeySequence::Copy);
  copy->setShortcutContext(Qt::WidgetShortcut);
  connect(copy, &QAction::triggered, this, &MessagePanel::copySelected);
  auto* copyAll = new QAction(tr("Copy all"), tree_);
  connect(copyAll, &QAction::triggered, this, [this] { QGuiApplication::clipboard()->setText(text()); });
  auto* clear = new QAction(tr("Clear"), tree_);
  connect(clear, &QAction::triggered, tree_, &QTreeWidget::clear);
  tree_->addActions({copy, copyAll, clear});
  tree_->setContextMenuPolicy(Qt::ActionsContextMenu);
}

void MessagePanel::note(const QString& headline) {
  add(headline, {});
}

void MessagePanel::add(const QString& headline, const Findings& findings) {
  Severity worst = Severity::note;
  for (const Finding& finding : findings) worst = std::max(worst, finding.severity);
  auto* top = new QTreeWidgetItem({QTime::currentTime().toString(QStringLiteral("HH:mm:ss  ")) + headline});
  top->setIcon(kWhat, style()->standardIcon(iconOf(worst)));
  for (const Finding& finding : findings) {
    auto* row = new QTreeWidgetItem(
        top, {severityText(finding.severity), QString::fromStdString(finding.where),
              QString::fromStdString(finding.key), QString::fromStdString(finding.expected),
              QString::fromStdString(finding.found)});
    row->setIcon(kWhat, style()->standardIcon(iconOf(finding.severity)));
    for (int column = 0; column < kMessageColumns; ++column)
      row->setToolTip(column, QString::fromStdString(toString(finding)));
  }
  tree_->insertTopLevelItem(0, top);
  top->setFirstColumnSpanned(true);
  top->setExpanded(true);
  while (tree_->topLevelItemCount() > kMostRows) delete tree_->takeTopLevelItem(kMostRows);
  tree_->scrollToTop();
  if (worst == Severity::error) emit errorAdded();
}

int MessagePanel::count() const {
  return tree_->topLevelItemCount();
}

QString MessagePanel::text() const {
  QStringList lines;
  for (int i = 0; i < tree_->topLevelItemCount(); ++i) {
    const QTreeWidgetItem* top = tree_->topLevelItem(i);
    lines << rowText(*top);
    for (int j = 0; j < top->childCount(); ++j) lines << rowText(*top->child(j));
  }
  return lines.join('\n');
}

void MessagePanel::copySelected() {
  QStringList lines;
  for (const QTreeWidgetItem* item : tree_->selectedItems()) lines << rowText(*item);
  QGuiApplication::clipboard()->setText(lines.join('\n'));
}

}  // namespace trimtab::workbench
