// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <qcustomplot.h>

#include <iterator>

namespace trimtab::views {

/// Returns Cividis: even in lightness, and the same to those who cannot tell red from green.
inline QCPColorGradient cividis() {
  QCPColorGradient gradient;
  gradient.clearColorStops();
  static constexpr int kStops[][3] = {{0, 32, 77},     {49, 68, 107},   {102, 105, 112},
                                      {149, 143, 120}, {203, 186, 105}, {255, 234, 70}};
  for (std::size_t i = 0; i < std::size(kStops); ++i)
    gradient.setColorStopAt(static_cast<double>(i) / (std::size(kStops) - 1),
                            QColor(kStops[i][0], kStops[i][1], kStops[i][2]));
  return gradient;
}

}  // namespace trimtab::views
