// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <deque>
#include <optional>

#include "trimtab/frame/frame.h"
#include "trimtab/hold/cost_model.h"

namespace trimtab::views {

/// What the images of the last minute cost, and which lever would help most. An image costs an entry of some
/// hundred bytes; the questions go over all entries, so ask them about once a second.
class BudgetMinute {
 public:
  static constexpr double kSpanS = 60;

  /// One stage and its mean time over the images that count.
  struct Stage {
    QString name;
    double ms = 0;
  };
  /// A lever, and about how much half of what it scales would save: of each stage at most what the last image
  /// took for it. NaN: the machine's costs are not known.
  struct Help {
    Lever lever;
    double ms = 0;
  };
  /// Levers that have nothing left to give, by bit as PolicyOutcome::moved.
  using Spent = std::uint32_t;

  /// Adds an image. `timeS` is on a clock that never goes back; what is older than a minute is dropped.
  void add(double timeS, const FrameCost& cost, const FrameLoad& load);
  std::size_t images() const { return images_.size(); }
  /// The share, 0..1, of the images that take longer than the budget; NaN without images.
  double overShare(double budgetMs) const;
  /// The stage that takes longest in the images over the budget, or in all images if none is over. Unset
  /// without a measured stage.
  std::optional<Stage> worstStage(double budgetMs) const;
  /// The lever that saves most of the last image, of those that are not spent. With known costs by
  /// prediction, else by the worst stage. Unset if no such lever changes what takes longest.
  std::optional<Help> help(double budgetMs, const CostCoefficients& cost, Spent spent = 0) const;

 private:
  struct Image {
    double timeS = 0;
    FrameCost cost;
  };
  std::deque<Image> images_;
  FrameLoad load_;  ///< of the last image
};

}  // namespace trimtab::views
