// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "trimtab/frame/frame_result.h"
#include "trimtab/frame/terrain_frame.h"
#include "trimtab/terrain/format/database.h"
#include "views/panels/static_lod_panel.h"
#include "views/panels/terrain_panel.h"

namespace trimtab::workbench {

/// What the Terrain dock says about a terrain.
views::TerrainSummary summaryOf(const terrain::Database& database);
/// What the page Static LOD says about its trees. Returns nothing if it has none.
std::optional<views::StaticLodSummary> treesOf(const terrain::Database& database);

/// Counts the nodes and triangles that a frame drew, by level. Everything is zero if static trees were drawn,
/// or if the result belongs to another terrain. The cost grows with the number of nodes drawn.
LevelsFrame levelsDrawn(const FrameResult& result, const terrain::Database& database);

}  // namespace trimtab::workbench
