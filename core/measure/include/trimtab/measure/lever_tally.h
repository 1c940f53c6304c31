#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "trimtab/frame/frame_levers.h"

namespace trimtab {

/// Counts which step of the chain changed each lever last, over the images of a run, with the means of what was
/// asked for and of what was drawn. Levers are in the order of kFrameLeverRows.
class LeverTally {
 public:
  void add(const LeverChain& chain);
  std::uint64_t images() const { return images_; }
  /// Returns in how many images the step was the last to change the lever; the preset if none did.
  std::uint64_t changedBy(std::size_t lever, LeverStep step) const {
    return changed_[lever][static_cast<std::size_t>(step)];
  }
  /// Return the mean after policy and after budget; infinite if an image had no limit, NaN without images.
  double askedMean(std::size_t lever) const { return asked_[lever] / static_cast<double>(images_); }
  double drawnMean(std::size_t lever) const { return drawn_[lever] / static_cast<double>(images_); }

 private:
  std::uint64_t images_ = 0;
  std::array<std::array<std::uint64_t, kLeverSteps>, kFrameLeverRows.size()> changed_{};
  std::array<double, kFrameLeverRows.size()> asked_{}, drawn_{};
};

}  // namespace trimtab
