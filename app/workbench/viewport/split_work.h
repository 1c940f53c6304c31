// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "split_view.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/measure/frame_error.h"
#include "trimtab/measure/paired_ratio.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab::workbench {

/// Both sides' images, made on the measuring thread, and their times.
struct SplitView::Work {
  /// So many pairs of both images are timed, and fewer where that would take too long.
  static constexpr std::size_t kPairs = 9;

  struct One {
    std::vector<FrameRequest> requests;  ///< the last one is measured
    QString label;
    bool reference = false;
    FrameError error;
    scene::ErrorPictures pictures;
    std::vector<double> ms;  ///< of the pairs
    double drawMs(scene::ErrorMeter& meter) const {
      FrameRequest request = reference ? scene::referenceOf(requests.back()) : requests.back();
      // As an image generator has it: the image is finished when its time is taken.
      request.waitForImage = true;
      return meter.draw(request).cost.total;
    }
    void measure(scene::ErrorMeter& meter) {
      error = meter.measure(requests.back(), std::span(requests).first(requests.size() - 1), &pictures);
    }
    const FrameResult& drawn() const { return reference ? pictures.drawnReference : pictures.drawn; }
    const std::vector<std::uint8_t>& shown() const { return reference ? pictures.reference : pictures.ours; }
  };
  std::array<One, 2> sides;
  /// Draws both in turns, neither always first. The first turn makes what the later ones find.
  void time(scene::ErrorMeter& meter, double longestMs) {
    QElapsedTimer timer;
    timer.start();
    for (const One& one : sides) one.drawMs(meter);
    for (std::size_t pair = 0; pair < kPairs && double(timer.elapsed()) < longestMs; ++pair)
      for (const std::size_t turn : {0u, 1u}) {
        One& one = sides[(pair + turn) % 2];
        one.ms.push_back(one.drawMs(meter));
      }
    timed = true;
  }
  PairedRatio rightOverLeft() const { return pairedRatio(sides[left].ms, sides[right].ms); }
  bool timed = false;  ///< otherwise the view moved, and nobody waits for times
  double othersShare = 0;
  std::uint64_t generation = 0;
  int widthPx = 0, heightPx = 0;
  std::vector<float> map;
  double flip = 0, largest = 0, ssim = 0, psnr = 0, tookMs = 0;
};

}  // namespace trimtab::workbench
