// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

class QPushButton;
class QWidget;

namespace trimtab::workbench {

class ChildRun;

/// Makes the button that pauses a run and lets it go on. It is there while the run is.
QPushButton* makePauseButton(ChildRun& run, QWidget* parent = nullptr);

}  // namespace trimtab::workbench
