// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "palette.h"

class QMainWindow;

namespace trimtab::workbench {

struct Controllers;
struct Panels;
class SessionKeeper;

/// Everything that the palette of a window finds now: its menus' commands that are enabled, its docks, every
/// parameter, the presets that ship, and the files that were opened lately.
std::vector<PaletteEntry> paletteEntries(QMainWindow& window, const Controllers& controllers,
                                         const Panels& panels, SessionKeeper& sessions);

}  // namespace trimtab::workbench
