// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

namespace trimtab::workbench {

/// Before QApplication: the surface format that OSG's GL2 build needs, and contexts that survive a floating
/// dock.
void prepareGl();
/// After it: empty, or what is wrong with the display's OpenGL.
QString checkGl();
/// Names under which settings and recovered edits are kept.
void nameApplication();

}  // namespace trimtab::workbench
