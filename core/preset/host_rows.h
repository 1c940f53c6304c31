#pragma once

#include "rows.h"

/// Rows of the host link and the measurements.
namespace trimtab::table {

inline constexpr std::array kHostRows{
    row<&TuningParameters::host, &HostParameters::protocol>(
        {.key = "host.protocol",
         .label = "Protocol",
         .help = "What the host speaks. Recognising it takes the first good packet; naming it refuses all "
                 "others.",
         .effect = Effect::host}),
    row<&TuningParameters::host, &HostParameters::entity>(
        {.key = "host.entity",
         .label = "Own entity",
         .help = "Number of the own aircraft among the host's entities. In CIGI it is 0, unless the host "
                 "numbers otherwise.",
         .hard = {0, 65535},
         .usual = {0, 100},
         .step = 1,
         .effect = Effect::host,
         .whole = true}),
    row<&TuningParameters::host, &HostParameters::view>(
        {.key = "host.view",
         .label = "Own view",
         .help = "Number of the view that is drawn if the host controls several (CIGI). -1 takes the first "
                 "one it controls.",
         .hard = {-1, 65535},
         .usual = {-1, 20},
         .step = 1,
         .effect = Effect::host,
         .whole = true}),
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
         .decimals = 1})};

}  // namespace trimtab::table
