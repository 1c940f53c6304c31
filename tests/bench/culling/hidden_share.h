#pragma once

#include <cstddef>
#include <string>

#include "tests/bench/row.h"

namespace trimtab::bench {

/// Of the tiles in view how many own no pixel, and what a way to find those left out.
struct HiddenShare {
  std::size_t inView = 0, hidden = 0, culled = 0, wrong = 0;

  void add(bool ownsAPixel, bool leftOut) {
    ++inView;
    hidden += !ownsAPixel;
    culled += leftOut && !ownsAPixel;
    wrong += leftOut && ownsAPixel;
  }
};

/// How high above the ground, which share a way should find there, and which its peer is told to find.
struct ShareGoal {
  double aboveM, share, quoted;
  std::string above() const { return std::to_string(static_cast<int>(aboveM)); }
};

/// The share and what was left out wrongly. `id`: "culling.WAY"; `way`: as it is called in a sentence.
inline void addShareRows(Report& report, const std::string& id, const std::string& way, const ShareGoal& goal,
                         int views, const HiddenShare& share, const std::string& peer) {
  report.add(
      valueAtLeast(100 * goal.share,
                   {.id = id + "_share_" + goal.above() + "m",
                    .what = "Of the tiles in view that own no pixel, left out by the " + way + " (" +
                            std::to_string(share.hidden) + " hidden of " + std::to_string(share.inView) +
                            " in " + std::to_string(views) + " views)",
                    .value = 100.0 * static_cast<double>(share.culled) / static_cast<double>(share.hidden),
                    .unit = "%",
                    .peer = peer,
                    .peerValue = 100 * goal.quoted,
                    .peerFrom = "quoted"}));
  report.add(valueAtMost(0, {.id = id + "_wrong_" + goal.above() + "m",
                             .what = "Tiles that own a pixel and are left out",
                             .value = static_cast<double>(share.wrong),
                             .unit = "tiles"}));
}

}  // namespace trimtab::bench
