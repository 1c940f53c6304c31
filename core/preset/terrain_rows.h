#pragma once

#include "rows.h"

/// Rows of what holds for any form of terrain.
namespace trimtab::table {

inline constexpr std::array kTerrainRows{row<&TuningParameters::terrain, &TerrainParameters::cache>(
    {.key = "terrain.cache_mb",
     .label = "Terrain kept in memory",
     .help = "Meshes that were read are kept up to so much; what the picture needs is kept first. Too little "
             "and land is drawn coarser, or read again when it is seen again. The ground's colours take some "
             "tens of megabytes beside it.",
     .hard = {16, 65536},
     .usual = {64, 4096},
     .step = 16,
     .tier = Tier::advanced,
     .logarithmic = true})};

}  // namespace trimtab::table
