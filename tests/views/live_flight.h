// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <memory>

#include "trimtab/decision/decide.h"
#include "trimtab/measure/cost_stages.h"
#include "views/model/live.h"

namespace trimtab::test {

inline FrameInput inputAt(double altitudeFt, double pitchDeg) {
  FrameInput input;
  input.state.position.height = Feet{altitudeFt}.as<Metres>();
  input.state.attitude.pitch = Degrees{pitchDeg};
  return input;
}

/// A made-up climb and descent with its decisions and believable costs; one frame a call.
class LiveFlight {
 public:
  explicit LiveFlight(double startS = 0, double hz = 60) : startS_(startS), hz_(hz) {}

  views::LiveFrame next(const ValidatedParameters& parameters) {
    const double t = startS_ + static_cast<double>(frame_) / hz_;
    views::LiveFrame f;
    f.time = t;
    f.input.state.packet = frame_++;
    f.decision =
        decide(inputAt(6200 - 3400 * std::cos(t * 0.06), 14 * std::sin(t * 0.35) - 3), parameters, memory_);
    f.levers = leversOf(f.decision, *parameters);
    const double size = f.decision.occlusionResolution ? f.decision.occlusionResolution->widthPx *
                                                             f.decision.occlusionResolution->heightPx / 480e3
                                                       : 0;
    const double ripple = std::sin(t * 37.1) * std::sin(t * 11.3);
    f.cost = {.decide = 0.01,
              .select = 0.3,
              .occlusion = size > 0 ? 0.4 + size : std::nan(""),
              .cull = 1.1 + 0.15 * ripple,
              .draw = 4.5 + 0.5 * ripple,
              .gpu = 6.5 - 2.2 * size + 0.9 * ripple,
              .page = frame_ % 40 < 3 ? 0.8 : std::nan("")};
    if (frame_ % 1200 < 300) f.cost.blur = 0.9 + 0.1 * ripple;
    for (const CostStage& stage : kCostStages)
      if (stage.kind == StageKind::of_frame && std::isfinite(f.cost.*stage.ms))
        f.cost.total += f.cost.*stage.ms;
    f.fps = 1000 / f.cost.total;
    const auto result = std::make_shared<FrameResult>();
    VisibleSet& visible = result->visible;
    visible.triangles = static_cast<std::uint64_t>(900e3 - 350e3 * size + 30e3 * ripple);
    visible.vertices = visible.triangles / 2;
    result->tilesInCut = 1024;
    visible.outsideFrustum = 620;
    visible.occluded = static_cast<std::size_t>(180 * size);
    visible.tiles.resize(result->tilesInCut - visible.outsideFrustum - visible.occluded);
    result->depthMap = f.decision.occlusionResolution;
    f.result = result;
    return f;
  }

 private:
  double startS_, hz_;
  std::uint64_t frame_ = 0;
  DecisionMemory memory_;
};

}  // namespace trimtab::test
