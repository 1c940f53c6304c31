// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "palette.h"

class QMainWindow;
namespace trimtab::views {
class ParameterTable;
}

namespace trimtab::workbench {

struct Controllers;
struct Panels;
class SessionKeeper;

/// Shows the parameter in the table of all, with the focus on its value.
void openParameter(views::ParameterTable& table, std::string_view key);

/// Everything that the palette of a window finds now: its menus' commands that are enabled, its docks, every
/// parameter, the presets that ship, and the files that were opened lately.
std::vector<PaletteEntry> paletteEntries(QMainWindow& window, const Controllers& controllers,
                                         const Panels& panels, SessionKeeper& sessions);

}  // namespace trimtab::workbench
