#include "labels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "svg.h"

namespace trimtab::plot {
namespace {

struct Direction {
  double x, y;
};
constexpr std::array<Direction, 12> kDirections{{{1, 0},
                                                 {1, -.6},
                                                 {1, .6},
                                                 {-1, 0},
                                                 {-1, -.6},
                                                 {-1, .6},
                                                 {0, -1},
                                                 {0, 1},
                                                 {.6, -1},
                                                 {.6, 1},
                                                 {-.6, -1},
                                                 {-.6, 1}}};
constexpr double kLeaderFrom = 16, kFarthest = 130;

}  // namespace

std::vector<PlacedLabel> placeLabels(const std::vector<Label>& labels, const std::vector<Box>& taken,
                                     const std::vector<Box>& lines, const Box& area, double textPx) {
  std::vector<Box> used = taken;
  std::vector<PlacedLabel> placed;
  for (const Label& label : labels) {
    PlacedLabel best{{}, {}, label.x, label.y, false};
    double least = 1e9;
    const double width = textWidthPx(label.text, textPx) + 2, height = textPx * 1.15;
    for (double away = 9; away <= kFarthest && away < least; away += 8)
      for (const Direction d : kDirections) {
        const double x = label.x + d.x * away, y = label.y + d.y * away;
        const Box box{d.x > 0 ? x : d.x < 0 ? x - width : x - width / 2, y - height / 2, width, height};
        if (box.x < area.x || box.x + width > area.x + area.width || box.y < area.y ||
            box.y + height > area.y + area.height)
          continue;
        const auto hits = [&box](const Box& other) { return box.overlaps(other); };
        if (std::any_of(used.begin(), used.end(), hits)) continue;
        const auto crossed = std::count_if(lines.begin(), lines.end(), hits);
        const double cost = away + 14.0 * static_cast<double>(crossed);
        if (cost >= least) continue;
        least = cost;
        best = {label.text, box, label.x, label.y, away >= kLeaderFrom};
      }
    if (!best.text.empty()) used.push_back(best.box);
    placed.push_back(std::move(best));
  }
  return placed;
}

}  // namespace trimtab::plot
