#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

#include "trimtab/terrain/grid/progress.h"

namespace trimtab::terrain {

/// The stages of a bake, in the order in which they end.
enum class Stage : std::size_t { source, heights, scenery, patches, ground, tiles, objects, trees, writing };

/// What each stage takes of a bake's time, in hundredths of the whole. Trees take most, where there are any.
using StageShares = std::array<int, 9>;
inline constexpr StageShares kElevationShares{20, 10, 0, 39, 19, 8, 2, 0, 2};
inline constexpr StageShares kSceneryShares{10, 3, 2, 5, 5, 9, 2, 62, 2};

/// Returns the progress of one stage, or of its part `from`..`to`, as a part of the whole bake's. `whole` may
/// be empty, and must outlive what is returned.
inline Progress progressOf(const Progress& whole, const StageShares& shares, Stage stage, double from = 0,
                           double to = 1) {
  const auto at = shares.begin() + static_cast<std::ptrdiff_t>(stage);
  const double begin = std::accumulate(shares.begin(), at, 0);
  return [&whole, begin, share = *at, from, to](double fraction, const std::string& what) {
    const double done = from + (to - from) * std::clamp(fraction, 0.0, 1.0);
    return !whole || whole((begin + share * done) / 100, what);
  };
}

}  // namespace trimtab::terrain
