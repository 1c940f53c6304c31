// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/experiment/report.h"
#include "trimtab/rig/ig_fit.h"

namespace trimtab::workbench {

/// Returns a fit as a table with a row for each setting of a lever, a plot of their times, and the text of
/// report() as notes.
experiment::Report fitReport(const IgFit& fit, const IgProfile& profile);

}  // namespace trimtab::workbench
