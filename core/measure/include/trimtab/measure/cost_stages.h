#pragma once

#include <array>

#include "trimtab/frame/frame.h"

/// Lists the stages of a frame once, for clocks, statistics, traces and plots. To add a stage, add a field to
/// FrameCost and a line to kCostStages.
namespace trimtab {

/// One field of FrameCost.
using CostField = double FrameCost::*;

/// Says how a stage's time adds up. The stages `of_frame` sum to `total`, and one that was not measured (NaN)
/// counts as 0 there. A `part` lies within `gpu`, or within `draw` if GL runs on the processor, so whoever
/// adds it counts it twice. A stage `beside` is the GPU's time, which passes while the processor goes on, so
/// it is in no sum. If the renderer waits for the GPU to end an image, `total` includes that wait and exceeds
/// the sum.
enum class StageKind { of_frame, part, beside, total };

struct CostStage {
  const char* name;        ///< the name in plots and reports, and the key in summaries
  const char* column;      ///< the column of a trace with this frame's time
  const char* lastColumn;  ///< the one with the previous frame's time, which is an input of the decision
  CostField ms;            ///< the field that holds the stage's time, milliseconds
  StageKind kind;
};

/// Holds every field of FrameCost once, in the order of a trace's columns.
inline constexpr std::array kCostStages{
    CostStage{"decide", "decide_ms", "last_decide_ms", &FrameCost::decide, StageKind::of_frame},
    CostStage{"select", "select_ms", "last_select_ms", &FrameCost::select, StageKind::of_frame},
    CostStage{"occlusion", "occlusion_ms", "last_occlusion_ms", &FrameCost::occlusion, StageKind::of_frame},
    CostStage{"cull", "cull_ms", "last_cull_ms", &FrameCost::cull, StageKind::of_frame},
    CostStage{"draw", "draw_ms", "last_draw_ms", &FrameCost::draw, StageKind::of_frame},
    CostStage{"gpu", "gpu_ms", "last_gpu_ms", &FrameCost::gpu, StageKind::beside},
    CostStage{"total", "total_ms", "last_total_ms", &FrameCost::total, StageKind::total},
    CostStage{"page", "page_ms", "last_page_ms", &FrameCost::page, StageKind::of_frame},
    CostStage{"blur", "blur_ms", "last_blur_ms", &FrameCost::blur, StageKind::part},
    CostStage{"weather", "weather_ms", "last_weather_ms", &FrameCost::weather, StageKind::part},
    CostStage{"symbology", "symbology_ms", "last_symbology_ms", &FrameCost::symbology, StageKind::part},
};

}  // namespace trimtab
