// SPDX-License-Identifier: GPL-3.0-or-later
#include "dock_of.h"

#include <QApplication>
#include <QDockWidget>
#include <QScrollArea>
#include <QTabWidget>
#include <memory>

namespace trimtab::workbench {
namespace {

QTabWidget* pagesOf(const QDockWidget& dock) {
  return qobject_cast<QTabWidget*>(dock.widget());
}

bool holds(const QWidget* page, const QWidget& content) {
  return page == &content || (page != nullptr && page->isAncestorOf(&content));
}

}  // namespace

QDockWidget* dockOf(const QWidget& content) {
  for (QWidget* holder = content.parentWidget(); holder != nullptr; holder = holder->parentWidget())
    if (auto* dock = qobject_cast<QDockWidget*>(holder)) return dock;
  return nullptr;
}

void raiseDock(const QWidget& content) {
  QDockWidget* const dock = dockOf(content);
  if (dock == nullptr) return;
  dock->show();
  dock->raise();
  if (QTabWidget* const pages = pagesOf(*dock))
    for (int i = 0; i < pages->count(); ++i)
      if (holds(pages->widget(i), content)) pages->setCurrentIndex(i);
}

bool isInFront(const QWidget& widget) {
  // Qt calls a dock behind another tab visible, but not a page behind another one.
  const auto* own = qobject_cast<const QDockWidget*>(&widget);
  const QDockWidget* const dock = own != nullptr ? own : dockOf(widget);
  const QWidget& seen = dock != nullptr ? *dock : widget;
  return widget.isVisible() && !seen.visibleRegion().isEmpty();
}

void whenSeen(const QWidget& content, QObject* context, const std::function<void(bool)>& report) {
  QDockWidget* const dock = dockOf(content);
  QTabWidget* const pages = pagesOf(*dock);
  const auto dockSeen = std::make_shared<bool>(false);
  const auto say = [=, &content] {
    report(*dockSeen && (pages == nullptr || holds(pages->currentWidget(), content)));
  };
  QObject::connect(dock, &QDockWidget::visibilityChanged, context, [=](bool seen) {
    *dockSeen = seen;
    say();
  });
  if (pages != nullptr) QObject::connect(pages, &QTabWidget::currentChanged, context, say);
}

void goTo(QDockWidget& dock) {
  dock.show();
  dock.raise();
  QWidget* content = dock.widget();
  if (const QTabWidget* pages = pagesOf(dock)) content = pages->currentWidget();
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
