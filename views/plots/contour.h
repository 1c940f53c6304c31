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

/// Where the surface passes `level`, as straight pieces through cells, by linear interpolation along their
/// edges (marching squares; a saddle is told by its mean). In samples.
std::vector<std::pair<ContourPoint, ContourPoint>> contour(const SampledSurface& surface, double level);

}  // namespace trimtab::views
