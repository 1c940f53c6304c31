// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/frame_levers.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/frame/terrain_frame.h"
#include "trimtab/hold/frame_hold.h"

namespace trimtab::views {

/// One frame as the docks see it: what came in, what was decided, and what drawing the last image did.
///
/// Widgets receive it through `showFrame(const LiveFrame&)`, which is cheap enough for every frame: they
/// repaint at most some 30 times a second, and not at all while hidden. Logs and plots record every frame,
/// hidden or not. A copy shares the result and costs little.
struct LiveFrame {
  double time = 0;  ///< seconds on a clock that never goes back; one clock for the whole session
  FrameInput input;
  FrameDecision decision;  ///< may be newer than `result`: a frame is also shown between two images
  FrameCost cost;          ///< of the last image, with `decide` filled in; NaN: not run or not measured
  double fps = std::numeric_limits<double>::quiet_NaN();
  std::shared_ptr<const FrameResult> result;  ///< null until the terrain has been drawn once
  LevelsFrame levels;                         ///< of `result`: by depth if it drew patches
  /// The chain of the levers of `result`; unset before the first image. A detached or frozen observer's image
  /// has no blur, whatever is said here.
  std::optional<LeverChain> levers;
  HoldDecision hold;                          ///< of `result`
  HoldGains holdGains;                        ///< what each lever of `hold` gives
  std::optional<HoldOutcome> holdOutcome;     ///< of the prediction for `result`
  double flip =
      std::numeric_limits<double>::quiet_NaN();  ///< of the last image whose error was measured live
  bool newImage = false;                         ///< `result` is new
  bool counts =
      true;  ///< false: of a frozen or a paused view, which is shown but is in no plot and no statistic

  /// Returns `*result`, or a result in which nothing was drawn if there is none yet.
  const FrameResult& drawn() const {
    static const FrameResult kNothing;
    return result ? *result : kNothing;
  }
};

}  // namespace trimtab::views
