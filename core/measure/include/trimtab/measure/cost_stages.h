#pragma once

#include <array>

#include "trimtab/frame/frame.h"

/// The list of a frame's stages that clocks, statistics, traces and plots share. A new stage is a field of
/// FrameCost and a line here.
namespace trimtab {

/// One field of FrameCost.
using CostField = double FrameCost::*;

/// Where a stage's time counts: stages of the frame sum to `total`; parts are counted in another stage as
/// well; what runs beside, such as the GPU while the processor goes on, is counted nowhere else.
enum class StageKind { of_frame, part, beside, total };

struct CostStage {
  const char* name;        ///< as people read it
  const char* column;      ///< the column in traces of this frame's time
  const char* lastColumn;  ///< the column of the previous frame's time, which is part of the decision's input
  CostField ms;
  StageKind kind;
};

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
