// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <cmath>

namespace trimtab::views {

/// Returns the number of twelve digits that is nearest to a value. Sums and products of decimals are off by
/// an ulp, which editors would show: 57 * 0.01 is not 0.57.
inline double withoutDust(double value) {
  return QString::number(value, 'g', 12).toDouble();
}

/// Returns the multiple of a step that is nearest to a value, as the double that people would type.
inline double roundedTo(double value, double step) {
  return withoutDust(std::round(value / step) * step);
}

}  // namespace trimtab::views
