// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "trimtab/units/not_finite.h"
#include "views/model/error_run.h"

namespace trimtab::test {

/// Eleven frames of two presets in two cases; FLIP and PSNR. "fine" is slow and good, "coarse" quick and bad;
/// "fine" without culling is slower still and no better.
inline views::ErrorRun sampleRun() {
  views::ErrorRun run;
  run.errors = {{"flip", "FLIP", "", true}, {"psnr_db", "PSNR", "dB", false}};
  const auto add = [&](const char* preset, const char* method, double ms, double flip, double psnr) {
    views::ErrorRun::Series s{"valley", preset, method, {}, {}, {{}, {}}, {{4, "largest FLIP"}}};
    for (int i = 0; i <= 10; ++i) {
      s.timeS << 100 + 2 * i;
      s.ms << ms + 0.1 * (i - 5);
      s.errors[0] << flip + 0.001 * (i - 5);
      s.errors[1] << psnr;
    }
    run.series << s;
  };
  add("fine", "none", 20, 0.02, kInfinity);
  add("fine", "proposed", 10, 0.02, 60);
  add("coarse", "proposed", 4, 0.08, 30);
  run.widthPx = 640;
  run.heightPx = 360;
  return run;
}

}  // namespace trimtab::test
