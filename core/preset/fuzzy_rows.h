#pragma once

#include "rows.h"

/// Rows of the choice of the culling scheme.
namespace trimtab::table {

inline constexpr std::array kFuzzyRows{
    row<&TuningParameters::altitude, &AltitudeParameters::reading>(
        {.key = "fuzzy.altitude.reading",
         .label = "Altitude reading",
         .help = "How altitude becomes a membership. The line between points reproduces every published "
                 "entry and stays "
                 "continuous when a point is moved; the printed equations jump at every phase.",
         .source = "A, B: Table 1, Eq. 1"}),
    row<&TuningParameters::altitude, &AltitudeParameters::reference>(
        {.key = "fuzzy.altitude.reference",
         .label = "Altitude reference",
         .help = "Which altitude decides. Over high country height above sea level says little about what is "
                 "in view; "
                 "height above ground crosses bands more often over hills."}),
    row<&TuningParameters::altitude, &AltitudeParameters::curve>(
        {.key = "fuzzy.altitude.curve_ft",
         .label = "Altitude membership",
         .help = "Membership by altitude, as points joined by straight lines; the first and last hold beyond "
                 "the ends. "
                 "The equation readings take the points as phases. Two points at one altitude make a step.",
         .source = "A, B: Table 1",
         .hard = {-2000, 200000},
         .usual = {0, 50000},
         .step = 100,
         .decimals = 0}),
    row<&TuningParameters::altitude, &AltitudeParameters::maximum>(
        {.key = "fuzzy.altitude.maximum_ft",
         .label = "Maximum altitude",
         .help = "h_max of the printed equations: from here up the membership is 0. The line between points "
                 "ignores it.",
         .source = "A, B: Eq. 1",
         .hard = {0, 200000},
         .usual = {1000, 50000},
         .step = 100,
         .tier = Tier::advanced}),
    row<&TuningParameters::altitude, &AltitudeParameters::heightOffset>(
        {.key = "fuzzy.altitude.height_offset_ft",
         .label = "Height offset",
         .help =
             "h_offset of the printed equations: the altitude step to which the membership offset belongs.",
         .source = "A, B: Eq. 1",
         .hard = {0.001, 10000},
         .usual = {1, 1000},
         .step = 1,
         .decimals = 1,
         .tier = Tier::advanced}),
    row<&TuningParameters::altitude, &AltitudeParameters::membershipOffset>(
        {.key = "fuzzy.altitude.membership_offset",
         .label = "Membership offset",
         .help = "x_offset of the printed equations. It is printed nowhere; the value that fits their table "
                 "is solved "
                 "from it. Larger values steepen the curve inside a phase.",
         .source = "A, B: Eq. 1",
         .hard = {0, 1},
         .usual = {1e-8, 1e-4},
         .step = 1e-7,
         .decimals = 8,
         .tier = Tier::advanced,
         .logarithmic = true}),
    row<&TuningParameters::pitch, &PitchParameters::reading>(
        {.key = "fuzzy.pitch.reading",
         .label = "Pitch reading",
         .help = "How pitch becomes a membership. The rounded step reproduces the published table to its "
                 "last digit and "
                 "is not monotone around level flight; the line is.",
         .source = "A, B: Table 1"}),
    row<&TuningParameters::pitch, &PitchParameters::curve>(
        {.key = "fuzzy.pitch.curve_deg",
         .label = "Pitch membership",
         .help = "Membership by pitch, nose up positive, as points joined by straight lines: 1 where terrain "
                 "fills the "
                 "view, 0 where sky does. The rounded step ignores it.",
         .source = "A, B: Table 1",
         .hard = {-90, 90},
         .usual = {-90, 90},
         .step = 1,
         .decimals = 1}),
    row<&TuningParameters::pitch, &PitchParameters::step>(
        {.key = "fuzzy.pitch.step",
         .label = "Pitch step",
         .help = "Membership per degree of the rounded step. The line ignores it.",
         .source = "A, B: Table 1",
         .hard = {0, 1},
         .usual = {0.001, 0.1},
         .step = 0.001,
         .decimals = 3,
         .tier = Tier::advanced}),
    row<&TuningParameters::pitch, &PitchParameters::limit>(
        {.key = "fuzzy.pitch.limit_deg",
         .label = "Pitch limit",
         .help = "Nose-up and nose-down pitch at which the rounded step ends. The line ignores it.",
         .source = "A, B: Table 1",
         .hard = {0, 90},
         .usual = {5, 90},
         .step = 1,
         .decimals = 1,
         .tier = Tier::advanced}),
    row<&TuningParameters::scheme, &SchemeParameters::combination>(
        {.key = "fuzzy.combination",
         .label = "Combination",
         .help = "How the two memberships become the total, 0 to 2. With the sum, low altitude alone keeps "
                 "the scheme dynamic; twice the smaller needs both to be high. Rules of the policy may set "
                 "the total instead (lever Occlusion), as Eq. 2 does.",
         .source = "A, B: Table 2"}),
    row<&TuningParameters::scheme, &SchemeParameters::hysteresis>(
        {.key = "fuzzy.hysteresis",
         .label = "Hysteresis",
         .help = "How far the total must pass a band's edge before the band changes, in membership. Without "
                 "it a flight "
                 "along an edge flips the scheme with every foot.",
         .hard = {0, 1},
         .usual = {0, 0.25},
         .step = 0.01,
         .decimals = 3}),
    row<&TuningParameters::scheme, &SchemeParameters::bands>(
        {.key = "fuzzy.bands_px",
         .label = "Depth-map bands",
         .help = "Depth-map size by total membership; a band holds from its lower edge up to the next. Below "
                 "the first "
                 "edge no depth map is made: view-frustum culling alone.",
         .source = "A, B: Table 2",
         .hard = {16, 8192},
         .usual = {64, 2048},
         .step = 16})};

}  // namespace trimtab::table
