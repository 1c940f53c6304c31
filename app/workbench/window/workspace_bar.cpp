// SPDX-License-Identifier: GPL-3.0-or-later
#include "workspace_bar.h"

#include <QAction>
#include <QActionGroup>
#include <QFileDialog>
#include <QInputDialog>
#include <QMenu>

#include "app/workbench/docks/message_panel.h"
#include "workspaces.h"

namespace trimtab::workbench {
namespace {

constexpr int kMostKeys = 9;

}  // namespace

WorkspaceBar::WorkspaceBar(Workspaces& workspaces, QMenu& menu, MessagePanel& messages, QWidget* parent)
    : QToolBar(tr("Workspaces"), parent),
      workspaces_(workspaces),
      menu_(menu),
      messages_(messages),
      group_(new QActionGroup(this)) {
  setObjectName(QStringLiteral("workspace_bar"));
  setToolButtonStyle(Qt::ToolButtonTextOnly);
  setContextMenuPolicy(Qt::PreventContextMenu);
  connect(group_, &QActionGroup::triggered, this,
          [this](const QAction* chosen) { workspaces_.show(chosen->data().toInt()); });
  makeMenu();
  connect(&workspaces_, &Workspaces::listChanged, this, &WorkspaceBar::showList);
  connect(&workspaces_, &Workspaces::currentChanged, this, &WorkspaceBar::showCurrent);
  showList();
}

void WorkspaceBar::makeMenu() {
  firstCommand_ = menu_.addSeparator();
  menu_.addAction(tr("&Reset this workspace"), this, [this] { workspaces_.reset(); });
  menu_.addAction(tr("&Save as a workspace..."), this, &WorkspaceBar::askSave);
  remove_ = menu_.addAction(tr("Re&move this workspace"), this,
                            [this] { workspaces_.remove(workspaces_.current()); });
  menu_.addSeparator();
  menu_.addAction(tr("&Export this workspace..."), this, &WorkspaceBar::askExport);
  menu_.addAction(tr("&Import a workspace..."), this, &WorkspaceBar::askImport);
}

void WorkspaceBar::showList() {
  qDeleteAll(group_->actions());
  const QStringList names = workspaces_.names();
  for (int i = 0; i < names.size(); ++i) {
    auto* action = new QAction(names[i], group_);
    action->setCheckable(true);
    action->setData(i);
    if (i < kMostKeys) action->setShortcut(tr("Ctrl+%1").arg(i + 1));
    addAction(action);
    menu_.insertAction(firstCommand_, action);
  }
  showCurrent(workspaces_.current());
}

void WorkspaceBar::showCurrent(int index) {
  if (index < group_->actions().size()) group_->actions()[index]->setChecked(true);
  remove_->setEnabled(!workspaces_.ships(index));
}

void WorkspaceBar::askSave() {
  bool good = false;
  const QString name =
      QInputDialog::getText(this, tr("Save as a workspace"), tr("Name"), QLineEdit::Normal, {}, &good);
  if (!good) return;
  if (const Findings findings = workspaces_.saveAs(name); !findings.empty())
    messages_.add(tr("The workspace was not saved"), findings);
}

void WorkspaceBar::askExport() {
  QFileDialog dialog(this, tr("Export this workspace"), {}, tr("Workspaces (*.workspace.json)"));
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("workspace.json"));
  if (dialog.exec() != QDialog::Accepted) return;
  if (const Findings findings = workspaces_.writeTo(dialog.selectedFiles().first()); !findings.empty())
    messages_.add(hasError(findings) ? tr("The workspace was not written") : tr("The workspace was written"),
                  findings);
}

void WorkspaceBar::askImport() {
  const QString file = QFileDialog::getOpenFileName(this, tr("Import a workspace"), {},
                                                    tr("Workspaces (*.workspace.json *.json)"));
  if (file.isEmpty()) return;
  if (const Findings findings = workspaces_.readFrom(file); !findings.empty())
    messages_.add(tr("The workspace cannot be used: %1").arg(file), findings);
}

}  // namespace trimtab::workbench
