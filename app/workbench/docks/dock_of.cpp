// SPDX-License-Identifier: GPL-3.0-or-later
#include "dock_of.h"

#include <QDockWidget>

namespace trimtab::workbench {

QDockWidget* dockOf(const QWidget& content) {
  for (QWidget* holder = content.parentWidget(); holder != nullptr; holder = holder->parentWidget())
    if (auto* dock = qobject_cast<QDockWidget*>(holder)) return dock;
  return nullptr;
}

void raiseDock(const QWidget& content) {
  if (QDockWidget* const dock = dockOf(content)) {
    dock->show();
    dock->raise();
  }
}

}  // namespace trimtab::workbench
