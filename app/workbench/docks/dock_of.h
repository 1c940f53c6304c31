// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

class QDockWidget;
class QWidget;

namespace trimtab::workbench {

/// Returns the dock that holds this widget; null if none does.
QDockWidget* dockOf(const QWidget& content);
/// Shows the dock that holds this widget and brings it to the front of its tabs.
void raiseDock(const QWidget& content);

}  // namespace trimtab::workbench
