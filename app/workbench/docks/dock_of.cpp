// SPDX-License-Identifier: GPL-3.0-or-later
#include "dock_of.h"

#include <QApplication>
#include <QDockWidget>
#include <QScrollArea>

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

bool isInFront(const QDockWidget& dock) {
  return dock.isVisible() && !dock.visibleRegion().isEmpty();
}

void goTo(QDockWidget& dock) {
  dock.show();
  dock.raise();
  QWidget* content = dock.widget();
  if (const auto* area = qobject_cast<QScrollArea*>(content)) content = area->widget();
  const auto takesFocus = [content](const QWidget& widget) {
    return content->isAncestorOf(&widget) && widget.isVisible() && widget.isEnabled() &&
           (widget.focusPolicy() & Qt::TabFocus) != 0;
  };
  QWidget* next = content;
  if (content->focusProxy() == nullptr && (content->focusPolicy() & Qt::TabFocus) == 0) {
    do next = next->nextInFocusChain();
    while (next != content && !takesFocus(*next));
  }
  next->setFocus(Qt::ShortcutFocusReason);
}

void goToOrClose(QDockWidget& dock) {
  const QWidget* const focus = QApplication::focusWidget();
  if (focus != nullptr && dock.isAncestorOf(focus) && isInFront(dock))
    dock.close();
  else
    goTo(dock);
}

}  // namespace trimtab::workbench
