// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace trimtab::workbench {

struct Controllers;
class Feed;
struct Panels;

/// Joins the dock Plots with the rest of the window: it marks a silent host and a running recording; the
/// plots of the docks Culling, Budget and Head motion share its pointer, and a click on one of them explains
/// the frame in Plots; while a plot in sight shows FLIP, that is measured; and a flight that is paused goes
/// to the frame that a person chooses.
void connectPlots(const Panels& panels, const Controllers& controllers, Feed& feed);

}  // namespace trimtab::workbench
