#include "trimtab/terrain/voids.h"

#include <algorithm>
#include <cmath>

namespace trimtab::terrain {

namespace {

/// A level of the pyramid that voids are filled through: coarse levels know far neighbours, fine ones smooth.
struct Layer {
  std::uint32_t columns, rows;
  std::vector<float> heights;

  float& at(std::uint32_t row, std::uint32_t column) { return heights[std::size_t{row} * columns + column]; }
  float at(std::uint32_t row, std::uint32_t column) const {
    return heights[std::size_t{row} * columns + column];
  }
};

/// Half the size: means of the heights that are there.
Layer halved(const Layer& fine) {
  Layer coarse{(fine.columns + 1) / 2, (fine.rows + 1) / 2, {}};
  coarse.heights.resize(std::size_t{coarse.columns} * coarse.rows);
  for (std::uint32_t r = 0; r < coarse.rows; ++r)
    for (std::uint32_t c = 0; c < coarse.columns; ++c) {
      float sum = 0, count = 0;
      for (std::uint32_t y = 2 * r; y < std::min(2 * r + 2, fine.rows); ++y)
        for (std::uint32_t x = 2 * c; x < std::min(2 * c + 2, fine.columns); ++x)
          if (const float h = fine.at(y, x); !std::isnan(h)) sum += h, count += 1;
      coarse.at(r, c) = count > 0 ? sum / count : std::nanf("");
    }
  return coarse;
}

float between(const Layer& coarse, std::uint32_t row, std::uint32_t column) {
  const float y = std::clamp((static_cast<float>(row) - 0.5f) / 2, 0.0f, static_cast<float>(coarse.rows - 1));
  const float x =
      std::clamp((static_cast<float>(column) - 0.5f) / 2, 0.0f, static_cast<float>(coarse.columns - 1));
  const auto r = static_cast<std::uint32_t>(y), c = static_cast<std::uint32_t>(x);
  const std::uint32_t r1 = std::min(r + 1, coarse.rows - 1), c1 = std::min(c + 1, coarse.columns - 1);
  const float v = y - static_cast<float>(r), u = x - static_cast<float>(c);
  return (coarse.at(r, c) * (1 - u) + coarse.at(r, c1) * u) * (1 - v) +
         (coarse.at(r1, c) * (1 - u) + coarse.at(r1, c1) * u) * v;
}

/// Moves voids towards the mean of their neighbours.
void relax(Layer& layer, const std::vector<std::uint32_t>& voids) {
  constexpr int kSweeps = 12;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const std::uint32_t i : voids) {
      const std::uint32_t r = i / layer.columns, c = i % layer.columns;
      float sum = 0, count = 0;
      const auto add = [&](std::uint32_t row, std::uint32_t column) {
        sum += layer.at(row, column), count += 1;
      };
      if (r > 0) add(r - 1, c);
      if (r + 1 < layer.rows) add(r + 1, c);
      if (c > 0) add(r, c - 1);
      if (c + 1 < layer.columns) add(r, c + 1);
      if (count > 0) layer.heights[i] = sum / count;
    }
}

}  // namespace

std::uint64_t fillVoids(HeightGrid& grid) {
  const auto empty = [](float h) { return std::isnan(h); };
  const auto count =
      static_cast<std::uint64_t>(std::count_if(grid.heights.begin(), grid.heights.end(), empty));
  if (count == 0) return 0;
  if (count == grid.heights.size()) {
    std::fill(grid.heights.begin(), grid.heights.end(), 0.0f);
    return count;
  }
  std::vector<Layer> layers;
  layers.push_back({grid.posts.columns, grid.posts.rows, std::move(grid.heights)});
  while (std::any_of(layers.back().heights.begin(), layers.back().heights.end(), empty))
    layers.push_back(halved(layers.back()));
  for (std::size_t l = layers.size() - 1; l-- > 0;) {
    Layer& layer = layers[l];
    std::vector<std::uint32_t> voids;
    for (std::uint32_t i = 0; i < layer.heights.size(); ++i)
      if (empty(layer.heights[i])) voids.push_back(i);
    for (const std::uint32_t i : voids)
      layer.heights[i] = between(layers[l + 1], i / layer.columns, i % layer.columns);
    relax(layer, voids);
  }
  grid.heights = std::move(layers.front().heights);
  return count;
}

}  // namespace trimtab::terrain
