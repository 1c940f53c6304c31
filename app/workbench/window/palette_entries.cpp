// SPDX-License-Identifier: GPL-3.0-or-later
#include "palette_entries.h"

#include <QAbstractSpinBox>
#include <QAction>
#include <QDockWidget>
#include <QFileInfo>
#include <QLineEdit>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QPointer>

#include "app/workbench/controllers/controllers.h"
#include "app/workbench/controllers/recent_files.h"
#include "app/workbench/docks/dock_of.h"
#include "panels.h"
#include "session_keeper.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/table.h"
#include "views/controls/parameter_line.h"
#include "views/controls/parameter_table.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

using Entries = std::vector<PaletteEntry>;

QString plain(QString text) {
  return text.remove('&').remove(QStringLiteral("..."));
}

/// What these menus hold has entries of its own. The menu of the docks would also close a dock that has the
/// focus.
bool isListedElsewhere(const QMenu& menu) {
  const QString name = menu.objectName();
  return name == QLatin1String("docks") || name == QLatin1String("shipped") ||
         name == QLatin1String("recent");
}

/// An entry may outlive its action: menus of recent files and of workspaces are filled anew.
void addCommands(Entries& to, const QList<QAction*>& actions, const QString& path) {
  for (QAction* action : actions) {
    if (action->isSeparator() || !action->isEnabled()) continue;
    if (const QMenu* menu = action->menu()) {
      if (!isListedElsewhere(*menu))
        addCommands(to, menu->actions(), path + plain(action->text()) + QStringLiteral(" › "));
      continue;
    }
    to.push_back({path + plain(action->text()), QObject::tr("command"),
                  action->shortcut().toString(QKeySequence::NativeText), [action = QPointer(action)] {
                    if (action) action->trigger();
                  }});
  }
}

void addDocks(Entries& to, QMainWindow& window) {
  int number = 0;
  for (QDockWidget* dock : window.findChildren<QDockWidget*>(QString(), Qt::FindDirectChildrenOnly)) {
    ++number;
    to.push_back({dock->windowTitle(), QObject::tr("dock"),
                  number <= 9 ? QStringLiteral("Alt+%1").arg(number) : QString(), [dock] { goTo(*dock); }});
  }
}

/// Gives the focus to an editor, so that what is typed next takes the place of its value.
void begin(QWidget& editor) {
  editor.setFocus();
  if (auto* number = qobject_cast<QAbstractSpinBox*>(&editor)) number->selectAll();
  if (auto* text = qobject_cast<QLineEdit*>(&editor)) text->selectAll();
}

void addParameters(Entries& to, views::ParameterTable& table) {
  for (const ParameterRow& row : parameterRows())
    to.push_back({QStringLiteral("%1 (%2)").arg(views::fromView(row.label), views::fromView(row.key)),
                  QObject::tr("parameter"),
                  {},
                  [&table, &row] { openParameter(table, row.key); }});
}

void addFile(Entries& to, const QString& path, const QString& shown, const QString& hint,
             const std::function<void(const QString&)>& open) {
  to.push_back({QFileInfo(path).fileName(), shown, hint, [open, path] { open(path); }});
}

void addRecent(Entries& to, const QString& kind, const QString& shown,
               const std::function<void(const QString&)>& open, const QStringList& listed = {}) {
  for (const QString& path : recentFiles(kind))
    if (QFileInfo::exists(path) && !listed.contains(path))
      addFile(to, path, shown, QFileInfo(path).path(), open);
}

}  // namespace

void openParameter(views::ParameterTable& table, std::string_view key) {
  raiseDock(table);
  table.search().setText(views::fromView(key));
  // As by the Tab key, which selects the number.
  if (views::ParameterLine* line = table.line(key)) begin(*line->editor());
}

std::vector<PaletteEntry> paletteEntries(QMainWindow& window, const Controllers& by, const Panels& panels,
                                         SessionKeeper& sessions) {
  Entries entries;
  addCommands(entries, window.menuBar()->actions(), {});
  addDocks(entries, window);
  addParameters(entries, *panels.parameters);
  for (const std::string_view name : shippedPresets())
    entries.push_back({views::fromView(name), QObject::tr("preset"), QObject::tr("ships"),
                       [&by, name] { by.document->openOverEdits(views::fromView(name)); }});
  addRecent(entries, QStringLiteral("preset"), QObject::tr("preset"),
            [&by](const QString& path) { by.document->openOverEdits(path); });
  entries.push_back({QObject::tr("The sample terrain"), QObject::tr("terrain"), QObject::tr("ships"),
                     [&by] { by.terrain->openSample(); }});
  addRecent(entries, QStringLiteral("terrain"), QObject::tr("terrain"),
            [&by](const QString& path) { by.terrain->open(path); });
  const auto openFlight = [&by](const QString& path) { by.flight->open(path); };
  const QStringList shipped = shippedFlights();
  for (const QString& path : shipped)
    addFile(entries, path, QObject::tr("flight"), QObject::tr("ships"), openFlight);
  addRecent(entries, QStringLiteral("flight"), QObject::tr("flight"), openFlight, shipped);
  addRecent(entries, QStringLiteral("session"), QObject::tr("session"),
            [&sessions](const QString& path) { sessions.open(path); });
  return entries;
}

}  // namespace trimtab::workbench
