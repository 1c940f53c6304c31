#pragma once

#include "rows.h"

/// Rows of culling, level of detail and view.
namespace trimtab::table {

inline constexpr std::array kViewRows{
    row<&TuningParameters::culling, &CullingParameters::cullingCase>(
        {.key = "culling.case",
         .label = "Culling",
         .help = "Which of the published cases runs. All draw the same picture; they differ in what they "
                 "spend on it.",
         .source = "A, B: comparison of culling"}),
    row<&TuningParameters::culling, &CullingParameters::occlusion>(
        {.key = "culling.occlusion",
         .label = "Occlusion culling",
         .help =
             "What proves that ground is hidden, where the scheme is dynamic. Horizon: computed around the "
             "eye's position, so that it stays valid while the head turns. Automatic: the horizon, or "
             "nothing "
             "where it would not pay, as measured on this machine. Published depth map: drawn and tested on "
             "the GPU. All draw the same image. The band's size is the resolution of each. Where the chosen "
             "method cannot be used the dock Culling says what is used instead. Static trees always use a "
             "depth map."}),
    row<&TuningParameters::culling, &CullingParameters::backFaces>(
        {.key = "culling.back_faces",
         .label = "Leave out back faces",
         .help =
             "What shows only its back is left out: triangles by GL, in every culling case, and tiles "
             "and patches all of whose triangles face away. Only while the eye is over the terrain and"
             " above the ground, where nearer ground hides every back. Off: both sides are drawn; "
             "slivers along ridges may then win single pixels (over Everest, in one picture of 640 x 360 in "
             "six). Static trees are always drawn from both sides.",
         .source = "A: view-frustum and back-face culling together"}),
    row<&TuningParameters::lod, &LodParameters::screenSpaceError>(
        {.key = "lod.screen_space_error_px",
         .label = "Allowed error",
         .help =
             "Screen-space error: how far a drawn surface may lie from the finest one, seen on the screen. "
             "Smaller is finer and slower.",
         .hard = {0.05, 256},
         .usual = {0.25, 32},
         .step = 0.25,
         .decimals = 2,
         .logarithmic = true}),
    row<&TuningParameters::lod, &LodParameters::scale>(
        {.key = "lod.scale",
         .label = "LOD scale",
         .help = "Multiplies the allowed error: 1 is full detail, larger is coarser.",
         .source = "C: LOD scale controller",
         .hard = {0.05, 100},
         .usual = {0.25, 16},
         .step = 0.25,
         .decimals = 2,
         .logarithmic = true}),
    row<&TuningParameters::lod, &LodParameters::spread>(
        {.key = "lod.level_spread",
         .label = "Distance between levels",
         .help = "Spreads the distances at which levels follow one another: a level that the allowed error "
                 "would draw from d on is drawn from D (d / D)^spread on, where D is the distance that keeps "
                 "its level. 1 leaves the distances; less draws them together, so that what is far is drawn "
                 "coarser and what is near finer; more draws them apart.",
         .source = "C: LOD level selector",
         .hard = {0.25, 4},
         .usual = {0.5, 2},
         .step = 0.05,
         .decimals = 2,
         .logarithmic = true}),
    row<&TuningParameters::lod, &LodParameters::spreadFrom>(
        {.key = "lod.level_spread_from_m",
         .label = "Distance that keeps its level",
         .help = "The distance at which the spread of levels changes nothing.",
         .source = "C: LOD level selector",
         .hard = {1, 1e6},
         .usual = {100, 100e3},
         .step = 100,
         .decimals = 0,
         .logarithmic = true}),
    row<&TuningParameters::lod, &LodParameters::texture>(
        {.key = "lod.texture",
         .label = "Texture follows the scale",
         .help = "The texture of the ground shrinks with the LOD scale, the preset's and that of head "
                 "motion: scale "
                 "2 halves its width and height. Patches alone have a texture; tiles and static trees are "
                 "coloured by vertex.",
         .source = "C: section 1, the LOD technique reduces texture size"}),
    row<&TuningParameters::view, &ViewParameters::source>(
        {.key = "view.source",
         .label = "View comes from",
         .help = "Whether field of view and near plane are this preset's or those of the host's view "
                 "definition, where "
                 "it sends one."}),
    row<&TuningParameters::view, &ViewParameters::horizontalFov>(
        {.key = "view.horizontal_fov_deg",
         .label = "Horizontal field of view",
         .help = "Width of the view. Levels of detail and depth maps follow from it.",
         .hard = {1, 170},
         .usual = {10, 120},
         .step = 1,
         .decimals = 1,
         .effect = Effect::resize}),
    row<&TuningParameters::view, &ViewParameters::verticalFov>(
        {.key = "view.vertical_fov_deg",
         .label = "Vertical field of view",
         .help = "Height of the view. A ratio to the width other than the picture's stretches what is drawn.",
         .hard = {1, 170},
         .usual = {10, 120},
         .step = 1,
         .decimals = 1,
         .effect = Effect::resize}),
    row<&TuningParameters::view, &ViewParameters::nearDistance>(
        {.key = "view.near_m",
         .label = "Near plane",
         .help = "Nothing nearer to the eye is drawn.",
         .hard = {0.001, 1000},
         .usual = {0.1, 100},
         .step = 0.1,
         .decimals = 2,
         .logarithmic = true}),
    row<&TuningParameters::view, &ViewParameters::renderSize>(
        {.key = "view.render_size",
         .label = "Render size",
         .help = "Whether the picture has the window's size or a fixed one. Results of different windows "
                 "compare only at "
                 "a fixed size.",
         .effect = Effect::resize}),
    row<&TuningParameters::view, &ViewParameters::width>({.key = "view.width_px",
                                                          .label = "Width",
                                                          .help = "Width of a fixed render size.",
                                                          .hard = {16, 16384},
                                                          .usual = {320, 7680},
                                                          .step = 16,
                                                          .effect = Effect::resize,
                                                          .whole = true}),
    row<&TuningParameters::view, &ViewParameters::height>({.key = "view.height_px",
                                                           .label = "Height",
                                                           .help = "Height of a fixed render size.",
                                                           .hard = {16, 16384},
                                                           .usual = {240, 4320},
                                                           .step = 16,
                                                           .effect = Effect::resize,
                                                           .whole = true})};

}  // namespace trimtab::table
