#pragma once

#include <algorithm>
#include <optional>
#include <utility>

namespace trimtab::scene {

struct Rectangle {
  double left = 0, bottom = 0, right = 0, top = 0;
};

/// Clips the line from (x, y) to (x + dx, y + dy) by Liang and Barsky's method, in doubles because an end of
/// a line that passes the eye is far outside. Returns the part inside as fractions of the line; nothing if
/// none is.
inline std::optional<std::pair<double, double>> partInside(const Rectangle& inside, double x, double y,
                                                           double dx, double dy) {
  double first = 0, last = 1;
  const auto clip = [&](double rate, double room) {
    if (rate == 0) return room >= 0;
    const double t = room / rate;
    if (rate < 0)
      first = std::max(first, t);
    else
      last = std::min(last, t);
    return first <= last;
  };
  if (!clip(-dx, x - inside.left) || !clip(dx, inside.right - x) || !clip(-dy, y - inside.bottom) ||
      !clip(dy, inside.top - y))
    return std::nullopt;
  return std::pair(first, last);
}

}  // namespace trimtab::scene
