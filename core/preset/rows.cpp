#include "trimtab/preset/rows.h"

#include <algorithm>

#include "trimtab/preset/rules.h"

namespace trimtab {

namespace {

using table::row;

constexpr std::array kTable{
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
                 "the scheme "
                 "dynamic; twice the smaller needs both to be high; the rule base is Eq. 2.",
         .source = "A, B: Table 2, Eq. 2"}),
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
         .step = 16}),
    row<&TuningParameters::rules, &RuleParameters::lowDownWeight>(
        {.key = "fuzzy.rules.low_down_weight",
         .label = "Weight, low and nose down",
         .help = "Weight of the rule for low flight with the nose down; 0 leaves the rule out. Used by the "
                 "rule base.",
         .source = "A, B: Eq. 2",
         .hard = {0, 1000},
         .usual = {0, 10},
         .step = 0.1,
         .decimals = 2,
         .tier = Tier::advanced}),
    row<&TuningParameters::rules, &RuleParameters::lowUpWeight>(
        {.key = "fuzzy.rules.low_up_weight",
         .label = "Weight, low and nose up",
         .help = "Weight of the rule for low flight with the nose up; 0 leaves the rule out. Used by the "
                 "rule base.",
         .source = "A, B: Eq. 2",
         .hard = {0, 1000},
         .usual = {0, 10},
         .step = 0.1,
         .decimals = 2,
         .tier = Tier::advanced}),
    row<&TuningParameters::rules, &RuleParameters::highDownWeight>(
        {.key = "fuzzy.rules.high_down_weight",
         .label = "Weight, high and nose down",
         .help = "Weight of the rule for high flight with the nose down; 0 leaves the rule out. Used by the "
                 "rule base.",
         .source = "A, B: Eq. 2",
         .hard = {0, 1000},
         .usual = {0, 10},
         .step = 0.1,
         .decimals = 2,
         .tier = Tier::advanced}),
    row<&TuningParameters::rules, &RuleParameters::highUpWeight>(
        {.key = "fuzzy.rules.high_up_weight",
         .label = "Weight, high and nose up",
         .help = "Weight of the rule for high flight with the nose up; 0 leaves the rule out. Used by the "
                 "rule base.",
         .source = "A, B: Eq. 2",
         .hard = {0, 1000},
         .usual = {0, 10},
         .step = 0.1,
         .decimals = 2,
         .tier = Tier::advanced}),
    row<&TuningParameters::rules, &RuleParameters::lowDownOutput>(
        {.key = "fuzzy.rules.low_down_output",
         .label = "Output, low and nose down",
         .help = "Total that the rule for low flight with the nose down asks for, on the bands' scale.",
         .source = "A, B: Eq. 2",
         .hard = {0, BandList::kTop},
         .usual = {0, BandList::kTop},
         .step = 0.05,
         .decimals = 2,
         .tier = Tier::advanced}),
    row<&TuningParameters::rules, &RuleParameters::lowUpOutput>(
        {.key = "fuzzy.rules.low_up_output",
         .label = "Output, low and nose up",
         .help = "Total that the rule for low flight with the nose up asks for, on the bands' scale.",
         .source = "A, B: Eq. 2",
         .hard = {0, BandList::kTop},
         .usual = {0, BandList::kTop},
         .step = 0.05,
         .decimals = 2,
         .tier = Tier::advanced}),
    row<&TuningParameters::rules, &RuleParameters::highDownOutput>(
        {.key = "fuzzy.rules.high_down_output",
         .label = "Output, high and nose down",
         .help = "Total that the rule for high flight with the nose down asks for, on the bands' scale.",
         .source = "A, B: Eq. 2",
         .hard = {0, BandList::kTop},
         .usual = {0, BandList::kTop},
         .step = 0.05,
         .decimals = 2,
         .tier = Tier::advanced}),
    row<&TuningParameters::rules, &RuleParameters::highUpOutput>(
        {.key = "fuzzy.rules.high_up_output",
         .label = "Output, high and nose up",
         .help = "Total that the rule for high flight with the nose up asks for, on the bands' scale.",
         .source = "A, B: Eq. 2",
         .hard = {0, BandList::kTop},
         .usual = {0, BandList::kTop},
         .step = 0.05,
         .decimals = 2,
         .tier = Tier::advanced}),
    row<&TuningParameters::culling, &CullingParameters::method>(
        {.key = "culling.case",
         .label = "Culling",
         .help = "Which of the published cases runs. All draw the same picture; they differ in what they "
                 "spend on it.",
         .source = "A, B: comparison of culling"}),
    row<&TuningParameters::lod, &LodParameters::screenSpaceError>(
        {.key = "lod.screen_space_error_px",
         .label = "Screen-space error",
         .help = "How far a drawn surface may lie from the finest one, seen on the screen. Smaller is finer "
                 "and slower.",
         .hard = {0.05, 256},
         .usual = {0.25, 32},
         .step = 0.25,
         .decimals = 2,
         .logarithmic = true}),
    row<&TuningParameters::lod, &LodParameters::scale>(
        {.key = "lod.scale",
         .label = "LOD scale",
         .help = "Multiplies the screen-space error: 1 is full detail, larger is coarser.",
         .source = "C: LOD scale controller",
         .hard = {0.05, 100},
         .usual = {0.25, 16},
         .step = 0.25,
         .decimals = 2,
         .logarithmic = true}),
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
                                                           .whole = true}),
    row<&TuningParameters::host, &HostParameters::protocol>(
        {.key = "host.protocol",
         .label = "Protocol",
         .help = "What the host speaks. Recognising it takes the first good packet; naming it refuses all "
                 "others.",
         .effect = Effect::host}),
    row<&TuningParameters::host, &HostParameters::extrapolate>(
        {.key = "host.extrapolate",
         .label = "Extrapolate",
         .help = "Move the eye on between packets. Decisions always use the packets themselves.",
         .effect = Effect::host}),
    row<&TuningParameters::host, &HostParameters::silenceAfter>(
        {.key = "host.silence_after_ms",
         .label = "Silent after",
         .help = "No packet for so long, and the host counts as silent and the eye stands still.",
         .hard = {10, 60000},
         .usual = {50, 10000},
         .step = 50,
         .effect = Effect::host,
         .logarithmic = true}),
    row<&TuningParameters::measure, &MeasureParameters::budget>(
        {.key = "measure.budget_ms",
         .label = "Frame budget",
         .help = "Work time that a frame may take, drawn as a line in the plots.",
         .hard = {0.1, 1000},
         .usual = {1, 100},
         .step = 0.1,
         .decimals = 1}),
};

static_assert(table::everyFieldHasOneRow(kTable), "a field of parameters.h has no row, or two");
static_assert(table::keysAreOrderly(kTable), "a key is there twice, or is not beside the keys of its group");

constexpr auto kRows = [] {
  std::array<ParameterRow, kTable.size()> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = kTable[i].row;
  return rows;
}();

consteval Range hardRange(std::string_view key) {
  for (const ParameterRow& r : kRows)
    if (r.key == key) return r.hard;
  throw "no such key";
}

using table::kDefaults;
static_assert(checkCurve(kDefaults.altitude.curve, hardRange("fuzzy.altitude.curve_ft")).flaw ==
              CurveFlaw::none);
static_assert(checkCurve(kDefaults.pitch.curve, hardRange("fuzzy.pitch.curve_deg")).flaw == CurveFlaw::none);
static_assert(checkBands(kDefaults.scheme.bands, hardRange("fuzzy.bands_px")).flaw == BandFlaw::none);
static_assert(hysteresisLeavesBands(kDefaults) && hysteresisLeavesFrustum(kDefaults));
static_assert(maximumCoversCurve(kDefaults) && someRuleCounts(kDefaults));

/// Indices of rows by rising key.
constexpr auto kByKey = [] {
  std::array<unsigned char, kRows.size()> order{};
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<unsigned char>(i);
  std::sort(order.begin(), order.end(), [](auto a, auto b) { return kRows[a].key < kRows[b].key; });
  return order;
}();

}  // namespace

std::span<const ParameterRow> parameterRows() {
  return kRows;
}

const ParameterRow* findRow(std::string_view key) {
  const auto at = std::lower_bound(kByKey.begin(), kByKey.end(), key,
                                   [](unsigned char i, std::string_view k) { return kRows[i].key < k; });
  return at != kByKey.end() && kRows[*at].key == key ? &kRows[*at] : nullptr;
}

}  // namespace trimtab
