// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

class QMenu;

namespace trimtab::workbench {

enum class Appearance { system, light, dark };

/// Gives the whole program the colours of the desktop, or light or dark ones of its own.
void apply(Appearance appearance);
/// Applies what was chosen last. Call it before widgets are made, because some keep colours from then.
void applyChosen();
/// Fills a menu with the choices, which it keeps.
void addAppearances(QMenu& menu);

}  // namespace trimtab::workbench
