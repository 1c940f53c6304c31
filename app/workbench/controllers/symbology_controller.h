// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>

#include "app/workbench/viewport/symbology_editor.h"
#include "workplace.h"

namespace trimtab::views {
class SymbologyPanel;
}

namespace trimtab::workbench {

/// Lets a person place symbols in the image with the mouse while the switch of the page Symbology is on.
class SymbologyController : public QObject {
  Q_OBJECT

 public:
  SymbologyController(const Workplace& workplace, views::SymbologyPanel& panel);
  SymbologyEditor& editor() { return editor_; }

 private:
  SymbologyEditor editor_;
};

}  // namespace trimtab::workbench
