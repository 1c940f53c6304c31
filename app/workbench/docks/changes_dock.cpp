// SPDX-License-Identifier: GPL-3.0-or-later
#include "changes_dock.h"

#include "views/controls/scrollable.h"
#include "views/panels/changes_panel.h"
#include "views/panels/snapshots_panel.h"

namespace trimtab::workbench {

ChangesDock::ChangesDock(views::Draft& draft, QWidget* parent)
    : QSplitter(Qt::Horizontal, parent),
      snapshots_(draft),
      changes_(new views::ChangesPanel(draft)),
      panel_(new views::SnapshotsPanel(draft, snapshots_)) {
  addWidget(changes_);
  auto* area = views::scrollable(panel_, tr("Snapshots"));
  area->setFocusPolicy(Qt::NoFocus);
  addWidget(area);
  setChildrenCollapsible(false);
  setStretchFactor(0, 3);
  setStretchFactor(1, 2);
  connect(&snapshots_, &views::Snapshots::changed, this, &ChangesDock::announce);
}

void ChangesDock::setSeen(bool seen) {
  seen_ = seen;
  announce();
}

void ChangesDock::announce() {
  emit errorsWanted(seen_ && snapshots_.active() >= 0);
}

}  // namespace trimtab::workbench
