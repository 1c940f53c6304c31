// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace trimtab::views {

/// Samples of a function of two variables, row by row: value[y * columns + x], x and y in samples.
struct SampledSurface {
  std::size_t columns = 0, rows = 0;
  std::span<const double> value;
};

struct ContourPoint {
  double x = 0, y = 0;
};

/// Returns where the surface passes `level`, in samples: straight pieces through cells, by linear
/// interpolation along their edges (marching squares). In a saddle the mean of the four corners says which
/// corners are joined.
std::vector<std::pair<ContourPoint, ContourPoint>> contour(const SampledSurface& surface, double level);

}  // namespace trimtab::views
