// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trimtab/scene/gl_report.h"

class QMenuBar;
class QWidget;

namespace trimtab::workbench {

// Windows with a text. They do not stop the work, except About.

/// Lists what the mouse and the keys do; the commands' shortcuts come from the menus.
void showKeys(QWidget* parent, const QMenuBar& menus);
void showAbout(QWidget* parent, const scene::GlReport& gl);

}  // namespace trimtab::workbench
