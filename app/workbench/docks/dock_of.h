// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

class QDockWidget;
class QWidget;

namespace trimtab::workbench {

/// Returns the dock that holds this widget; null if none does.
QDockWidget* dockOf(const QWidget& content);
/// Shows the dock that holds this widget and brings it to the front of its tabs.
void raiseDock(const QWidget& content);
/// Whether a person can see the dock. Qt calls a dock behind another tab visible, and leaves the focus in it.
bool isInFront(const QDockWidget& dock);
/// Brings a dock to the front and the focus to its first control.
void goTo(QDockWidget& dock);
/// Goes to the dock; closes it if it is in front and has the focus already.
void goToOrClose(QDockWidget& dock);

}  // namespace trimtab::workbench
