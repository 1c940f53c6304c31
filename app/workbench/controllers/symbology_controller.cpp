// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbology_controller.h"

#include <QPushButton>

#include "app/workbench/viewport/viewport.h"
#include "views/panels/symbology_panel.h"

namespace trimtab::workbench {

using views::SymbologyPanel;

SymbologyController::SymbologyController(const Workplace& workplace, SymbologyPanel& panel)
    : editor_(workplace.draft) {
  Viewport& viewport = workplace.viewport;
  viewport.setSymbologyEditor(&editor_);
  connect(&panel, &SymbologyPanel::placingChanged, this, [this, &viewport](bool on) {
    editor_.setActive(on);
    if (on) viewport.setFocus();
  });
  connect(&panel, &SymbologyPanel::selected, &editor_, [this](int symbol) {
    if (editor_.active()) editor_.select(symbol);
  });
  connect(&editor_, &SymbologyEditor::selectionChanged, &panel, &SymbologyPanel::setSelected);
  connect(&editor_, &SymbologyEditor::ended, &panel, [&panel] { panel.placeButton().setChecked(false); });
}

}  // namespace trimtab::workbench
