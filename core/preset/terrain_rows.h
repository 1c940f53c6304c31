#pragma once

#include "rows.h"

/// Rows of what holds for any form of terrain.
namespace trimtab::table {

inline constexpr std::array kTerrainRows{
    row<&TuningParameters::terrain, &TerrainParameters::form>(
        {.key = "terrain.form",
         .label = "Terrain is drawn from",
         .help = "Regular tiles; patches of triangles with a guaranteed error, read from disk as they are "
                 "needed; or the static trees of document E. Only scenery has trees, and only a terrain of "
                 "moderate size has tiles: patches are drawn where the terrain has no such form.",
         .source = "E"}),
    row<&TuningParameters::terrain, &TerrainParameters::cache>(
        {.key = "terrain.cache_mb",
         .label = "Terrain kept in memory",
         .help =
             "Meshes that were read are kept up to so much; what the image needs is kept first. With too "
             "little, land is drawn coarser, or read again when it is seen again. The ground's colours take "
             "some tens of megabytes beside it.",
         .hard = {16, 65536},
         .usual = {64, 4096},
         .step = 16,
         .tier = Tier::advanced,
         .logarithmic = true})};

}  // namespace trimtab::table
