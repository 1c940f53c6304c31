#pragma once

#include "rows.h"

/// Rows of the trees of static levels of detail.
namespace trimtab::table {

inline constexpr std::array kStaticLodRows{
    row<&TuningParameters::staticLod, &StaticLodParameters::error>(
        {.key = "static_lod.error",
         .label = "Error of a node",
         .help = "Which error against the source sets a node's minimum viewer distance. The largest vertical "
                 "error keeps every ridge and draws more. Both count how far material borders of airports "
                 "move sideways. As published is document E's literal form: vertical error "
                 "alone, so flat airports lose their runways.",
         .source = "E: root mean square error"}),
    row<&TuningParameters::staticLod, &StaticLodParameters::rule>(
        {.key = "static_lod.rule",
         .label = "Minimum distance from",
         .help =
             "The distance at which the error has the allowed size in the picture, which follows field of "
             "view and render size; or a fixed multiple of the error, the same for every display.",
         .source = "E: minimum viewer distance"}),
    row<&TuningParameters::staticLod, &StaticLodParameters::errorPx>(
        {.key = "static_lod.error_px",
         .label = "Allowed error of static trees",
         .help = "A node is drawn where its error is at most so much in the picture; nearer, its children "
                 "are. Smaller is finer and slower.",
         .source = "E: minimum viewer distance",
         .hard = {0.01, 256},
         .usual = {0.1, 32},
         .step = 0.1,
         .decimals = 2,
         .logarithmic = true}),
    row<&TuningParameters::staticLod, &StaticLodParameters::distancePerError>(
        {.key = "static_lod.distance_per_error",
         .label = "Distance per error",
         .help =
             "Minimum viewer distance as a multiple of the error: metres of distance for each metre. Larger "
             "is finer and slower. Used where the distance is a multiple of the error.",
         .source = "E: minimum viewer distance",
         .hard = {1, 1e6},
         .usual = {10, 100000},
         .step = 10,
         .logarithmic = true}),
    row<&TuningParameters::staticLod, &StaticLodParameters::mapFromTriangles>(
        {.key = "static_lod.map_from_triangles",
         .label = "Depth map from",
         .help =
             "Far nodes of the trees are tested against a depth map only where so many of their triangles "
             "or more may be hidden; with fewer, the map may cost more than it saves. 0 tests them "
             "wherever the scheme is dynamic, as published. No pixel depends on it.",
         .source = "A, B: depth map",
         .hard = {0, 1e9},
         .usual = {0, 200000},
         .step = 1000,
         .whole = true})};

}  // namespace trimtab::table
