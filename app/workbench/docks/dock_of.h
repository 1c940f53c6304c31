// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

class QDockWidget;
class QObject;
class QWidget;

namespace trimtab::workbench {

/// Returns the dock that holds this widget; null if none does.
QDockWidget* dockOf(const QWidget& content);
/// Shows the dock that holds this widget, brings it to the front of its tabs, and shows the page of it.
void raiseDock(const QWidget& content);
/// Whether a person can see the widget. Qt calls a dock behind another tab visible, and leaves the focus in
/// it.
bool isInFront(const QWidget& widget);
/// Reports, while the context lives, when a content of a dock comes into sight or leaves it.
void whenSeen(const QWidget& content, QObject* context, const std::function<void(bool)>& report);
/// Brings a dock to the front and the focus to its first control.
void goTo(QDockWidget& dock);
/// Goes to the dock; closes it if it is in front and has the focus already.
void goToOrClose(QDockWidget& dock);

}  // namespace trimtab::workbench
