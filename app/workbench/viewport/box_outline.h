// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QLineF>
#include <QList>

#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/terrain_index.h"

namespace trimtab::workbench {

/// Returns the edges of a box as an eye sees them, in parts of the image: 0 to 1 from its left and from its
/// top. Edges may leave the image; what lies nearer than the near plane is cut off. `box` and `eye` are in
/// the terrain's local frame.
QList<QLineF> outlineOf(const Box& box, const EyePose& eye, const ViewShape& view);

}  // namespace trimtab::workbench
