// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

#include "live.h"
#include "trimtab/preset/parameters.h"

namespace trimtab::views {

/// Says why the last image was drawn without a depth map: by the decision, by the culling case, or because
/// another occlusion method serves. Empty if a depth map was drawn.
QString whyNoDepthMap(const LiveFrame& frame, const TuningParameters& parameters);

}  // namespace trimtab::views
