#include "trimtab/culling/relief.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trimtab/frame/box_union.h"

namespace trimtab {

float furthestBeside(std::span<const float> x, std::span<const float> y) {
  const double dx = double{x.back()} - x.front(), dy = double{y.back()} - y.front();
  const double squared = dx * dx + dy * dy;
  double furthest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double px = double{x[i]} - x.front(), py = double{y[i]} - y.front();
    const double s = squared > 0 ? std::clamp((px * dx + py * dy) / squared, 0.0, 1.0) : 0;
    furthest = std::max(furthest, std::hypot(px - s * dx, py - s * dy));
  }
  return static_cast<float>(furthest * 1.001 + 1e-3);
}

void TileRelief::finish(int step) {
  lineStep = step;
  const auto at = [this](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(side) + static_cast<std::size_t>(column);
  };
  lines = 0;
  lineXyz.clear();
  goOn.clear();
  parts.clear();
  bounds = {};
  reach = -1;
  besideM = 0;
  lineTop.fill(-std::numeric_limits<float>::max());
  float furthest = -1;
  for (const auto* values : {&x, &y, &z})
    for (const float value : *values) {
      if (!std::isfinite(value)) return;
      furthest = std::max(furthest, std::abs(value));
    }
  if (side < 2 || side > kMostPosts) return;
  reach = furthest;
  const auto add = [&](int column, int row, int right, int up) {
    const std::size_t first = lineXyz.size();
    for (const auto* values : {&x, &y, &z})
      for (int k = 0; k < side; ++k) lineXyz.push_back((*values)[at(column + k * right, row + k * up)]);
    for (int k = 1; k <= kGoOn; ++k)
      for (const auto* values : {&x, &y, &z}) goOn.push_back((*values)[at(column + k * right, row + k * up)]);
    const std::span<const float> line = std::span(lineXyz).subspan(first);
    const auto corners = static_cast<std::size_t>(side);
    const auto xs = line.first(corners), ys = line.subspan(corners, corners);
    besideM = std::max(besideM, furthestBeside(xs, ys));
    const auto zs = line.subspan(2 * corners);
    float& top = lineTop[right != 0 ? 0 : 1];
    top = std::max(top, *std::max_element(zs.begin(), zs.end()));
    ++lines;
  };
  // The borders are left out because beside a coarser neighbour their odd posts are not drawn.
  for (int across = step; across < side - 1; across += step) add(0, across, 1, 0);
  for (int across = step; across < side - 1; across += step) add(across, 0, 0, 1);

  const auto boxOf = [&](int column, int row, int cells) {
    Box b = kNoBox;
    for (int r = row; r <= std::min(row + cells, side - 1); ++r)
      for (int c = column; c <= std::min(column + cells, side - 1); ++c) {
        const std::size_t i = at(c, r);
        b = united(b, x[i], y[i], z[i]);
      }
    return b;
  };
  bounds = boxOf(0, 0, side - 1);
  for (int row = 0; row < side - 1; row += kPartCells)
    for (int column = 0; column < side - 1; column += kPartCells) {
      Part part{};
      part.box = boxOf(column, row, kPartCells);
      std::size_t highest = at(column, row);
      std::array<Box, Part::kMostBlocks> boxes;
      for (int r = row; r <= std::min(row + kPartCells, side - 1); ++r)
        for (int c = column; c <= std::min(column + kPartCells, side - 1); ++c)
          if (z[at(c, r)] > z[highest]) highest = at(c, r);
      part.peak = {x[highest], y[highest], z[highest]};
      for (int r = row; r < std::min(row + kPartCells, side - 1); r += kBlockCells)
        for (int c = column; c < std::min(column + kPartCells, side - 1); c += kBlockCells)
          boxes[static_cast<std::size_t>(part.blocks++)] = boxOf(c, r, kBlockCells);
      const auto end = boxes.begin() + part.blocks;
      std::sort(boxes.begin(), end, [](const Box& a, const Box& b) { return a.maxZ > b.maxZ; });
      std::fill(end, boxes.end(), end[-1]);
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        part.minX[i] = boxes[i].minX;
        part.maxX[i] = boxes[i].maxX;
        part.minY[i] = boxes[i].minY;
        part.maxY[i] = boxes[i].maxY;
        part.top[i] = boxes[i].maxZ;
      }
      const auto place = std::upper_bound(parts.begin(), parts.end(), part,
                                          [](const Part& a, const Part& b) { return a.peak[2] > b.peak[2]; });
      parts.insert(place, part);
    }
  peak = parts.front().peak;
}

}  // namespace trimtab
