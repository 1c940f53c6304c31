// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "split_view.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/measure/frame_error.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab::workbench {

/// Both sides' pictures, made on the measuring thread.
struct SplitView::Work {
  struct One {
    std::vector<FrameRequest> requests;  ///< the last one is measured
    QString label;
    bool reference = false;
    FrameError error;
    scene::ErrorPictures pictures;
    void measure(scene::ErrorMeter& meter) {
      error = meter.measure(requests.back(), std::span(requests).first(requests.size() - 1), &pictures);
    }
    const FrameResult& drawn() const { return reference ? pictures.drawnReference : pictures.drawn; }
    const std::vector<std::uint8_t>& shown() const { return reference ? pictures.reference : pictures.ours; }
  };
  std::array<One, 2> sides;
  std::uint64_t generation = 0;
  int widthPx = 0, heightPx = 0;
  std::vector<float> map;
  double flip = 0, largest = 0, ssim = 0, psnr = 0, tookMs = 0;
};

}  // namespace trimtab::workbench
