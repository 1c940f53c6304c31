// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

namespace trimtab::workbench {

/// Sets the surface format that OSG's GL2 build needs, and that only the viewport has a native window. Call
/// it before QApplication is made.
void prepareGl();
/// Returns what is wrong with the display's OpenGL; empty if nothing is. Call it after QApplication is made.
QString checkGl();
/// Sets the names under which settings and recovered edits are kept.
void nameApplication();

}  // namespace trimtab::workbench
