// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "app/workbench/viewport/overlay.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::workbench {

struct Legend {
  QString title;  ///< empty if the image is not coloured by anything
  QList<LegendEntry> entries;
};

/// Explains the colours of an image. `patches`: the last image drew patches.
Legend legendOf(const FrameRequest& request, bool patches, const terrain::Database& terrain);

/// What the line at the foot of the image says.
struct HudFacts {
  AircraftState eye;
  const FrameResult* result = nullptr;         ///< of this image; null if there is none
  double frameMs = 0;                          ///< what the image cost, milliseconds
  const terrain::Database* terrain = nullptr;  ///< null if none is open
  double fps = 0;                              ///< NaN: images are drawn on demand
  std::optional<MetresPerSecond> cameraSpeed;  ///< of the free camera, while it is what moves
};
QString hudText(const HudFacts& facts);

}  // namespace trimtab::workbench
