// SPDX-License-Identifier: GPL-3.0-or-later
#include "scheme_page.h"

#include "views/controls/scrollable.h"
#include "views/editors/membership_editor.h"
#include "views/model/value_text.h"
#include "views/plots/surface_plot.h"

namespace trimtab::views {

SchemePage::SchemePage(Draft& draft, QWidget* parent)
    : QTabWidget(parent), memberships_(new MembershipEditor(draft)), surface_(new SurfacePlot(draft)) {
  setDocumentMode(true);
  setAccessibleName(tr("Culling scheme by altitude and pitch"));
  addTab(scrollable(memberships_, tr("Memberships")), tr("Memberships"));
  addTab(surface_, tr("Surface"));
  setTabToolTip(0, tr("Altitude and pitch curves%1").arg(documentsHtml("A, B: Table 1")));
  setTabToolTip(1, tr("The total membership over altitude and pitch"));
}

void SchemePage::showFrame(const LiveFrame& frame) {
  memberships_->showFrame(frame);
  surface_->showFrame(frame);
}

void SchemePage::showMemberships() {
  setCurrentIndex(0);
}
void SchemePage::showSurface() {
  setCurrentIndex(1);
}

}  // namespace trimtab::views
