#pragma once

#include "rows.h"

/// Rows of what stands on the ground.
namespace trimtab::table {

inline constexpr std::array kObjectRows{
    row<&TuningParameters::objects, &ObjectParameters::errorPx>(
        {.key = "objects.error_px",
         .label = "Allowed error of objects",
         .help =
             "An object is drawn by the coarsest of its levels whose measured error is at most so much in "
             "the image. Smaller is finer and slower. What moves the allowed error of the ground in "
             "flight moves this one in proportion.",
         .hard = {0.1, 256},
         .usual = {0.5, 32},
         .step = 0.1,
         .decimals = 2,
         .logarithmic = true}),
    row<&TuningParameters::objects, &ObjectParameters::smallFeature>(
        {.key = "objects.small_feature_px",
         .label = "Smallest object",
         .help = "An object whose size in the image is less is not drawn. Larger is faster; 0 draws all.",
         .hard = {0, 256},
         .usual = {0, 16},
         .step = 0.1,
         .decimals = 2}),
    row<&TuningParameters::objects, &ObjectParameters::farDistance>(
        {.key = "objects.far_m",
         .label = "Farthest object",
         .help = "An object that stands farther from the eye is not drawn, however large it is.",
         .hard = {10, 1e6},
         .usual = {500, 100000},
         .step = 100,
         .logarithmic = true}),
    row<&TuningParameters::objects, &ObjectParameters::lightSize>(
        {.key = "objects.light_px",
         .label = "Size of lights",
         .help = "A light of a town or an airfield is a point of this size in the image, however far it is. "
                 "0 draws no lights, as by day.",
         .hard = {0, 16},
         .usual = {0, 6},
         .step = 0.1,
         .decimals = 2})};

}  // namespace trimtab::table
