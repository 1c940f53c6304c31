#include "merge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace trimtab::terrain {

namespace {

constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kFar = kGiveWay;

std::vector<const ElevationLayer*> layersOf(const ElevationChunk* chunk, std::size_t name) {
  std::vector<const ElevationLayer*> layers;
  if (chunk == nullptr) return layers;
  for (const ElevationLayer& layer : chunk->layers)
    if (layer.name == name) layers.push_back(&layer);
  return layers;
}

/// Returns how far it is from each post of a layer, up or down its column, to where the layer has nothing and
/// another file has: kChunkRows rows of the layer's columns and one on either side.
std::vector<std::uint8_t> upAndDown(const std::array<const ElevationChunk*, 3>& chunks,
                                    const ElevationLayer& layer, std::uint32_t first, std::uint32_t count) {
  std::vector<std::uint8_t> far(std::size_t{kChunkRows} * count, kFar);
  std::array<std::vector<const ElevationLayer*>, 3> same;
  for (std::size_t k = 0; k < 3; ++k) same[k] = layersOf(chunks[k], layer.name);
  const auto ends = [&](std::uint32_t row, std::uint32_t column) {
    const std::size_t k = row / kChunkRows;
    const std::uint32_t r = row % kChunkRows;
    return chunks[k] != nullptr && chunks[k]->covered[std::size_t{r} * chunks[k]->columns + column] > 0 &&
           std::none_of(same[k].begin(), same[k].end(),
                        [&](const ElevationLayer* one) { return one->has(r, column); });
  };
  std::vector<std::uint8_t> distance(count, kFar);
  const auto sweep = [&](std::uint32_t row) {
    for (std::uint32_t c = 0; c < count; ++c) {
      const auto next = static_cast<std::uint8_t>(std::min<int>(distance[c] + 1, kFar));
      distance[c] = ends(row, first + c) ? std::uint8_t{0} : next;
      if (row / kChunkRows != 1) continue;
      std::uint8_t& here = far[std::size_t{row % kChunkRows} * count + c];
      here = std::min(here, distance[c]);
    }
  };
  for (std::uint32_t row = 0; row < 2 * kChunkRows; ++row) sweep(row);
  std::fill(distance.begin(), distance.end(), kFar);
  for (std::uint32_t row = 3 * kChunkRows; row-- > kChunkRows;) sweep(row);
  return far;
}

/// Returns 0 at the border, and 1 from kGiveWay posts on.
float say(std::span<const std::uint8_t> row, std::uint32_t column) {
  int best = int{kFar} * kFar;
  for (int d = 0; d * d < best; ++d) {
    for (const int side : {-d, d}) {
      const int c = static_cast<int>(column) + side;
      if (c < 0 || c >= static_cast<int>(row.size())) continue;
      const int up = row[static_cast<std::size_t>(c)];
      if (up < kFar) best = std::min(best, d * d + up * up);
    }
  }
  const float t = std::sqrt(static_cast<float>(best)) / kFar;
  return t >= 1 ? 1.0f : t * t * (3 - 2 * t);
}

/// Holds the shares of several files that have a height: each gets its part of what those with more say
/// leave.
struct Shares {
  std::vector<float> left, taken, most;
  std::vector<std::size_t> leader;

  explicit Shares(std::size_t posts) : left(posts, 1), taken(posts, 0), most(posts, 0), leader(posts, 0) {}
};

void mergeContinued(const ElevationChunk& chunk, std::span<float> heights, std::span<std::uint32_t> from) {
  const bool any = std::any_of(chunk.layers.begin(), chunk.layers.end(),
                               [](const ElevationLayer& layer) { return !layer.continued.empty(); });
  if (!any) return;
  Shares shares(heights.size());
  std::vector<std::uint8_t> inside(heights.size(), 0);
  std::vector<float> sum(heights.size(), 0);
  for (const ElevationLayer& layer : chunk.layers)
    for (const Continued& c : layer.continued) {
      if (chunk.covered[c.place] > 0) continue;
      if (c.inside) inside[c.place] = 1;
      shares.taken[c.place] += c.weight;
      if (shares.taken[c.place] > 0)
        sum[c.place] += (c.height - sum[c.place]) * (c.weight / shares.taken[c.place]);
      if (c.weight > shares.most[c.place])
        shares.most[c.place] = c.weight, shares.leader[c.place] = layer.file;
    }
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (inside[i] != 0) {
      heights[i] = sum[i];
      from[i] = static_cast<std::uint32_t>(shares.leader[i]);
    }
}

}  // namespace

bool ElevationLayer::has(std::uint32_t row, std::uint32_t column) const {
  return column >= firstColumn && column - firstColumn < columns &&
         !std::isnan(heights[std::size_t{row} * columns + column - firstColumn]);
}

void ElevationChunk::count() {
  covered.assign(std::size_t{kChunkRows} * columns, 0);
  for (const ElevationLayer& layer : layers)
    for (std::uint32_t r = 0; r < kChunkRows; ++r)
      for (std::uint32_t c = 0; c < layer.columns; ++c) {
        std::uint8_t& here = covered[std::size_t{r} * columns + layer.firstColumn + c];
        if (here < 255 && !std::isnan(layer.heights[std::size_t{r} * layer.columns + c])) ++here;
      }
}

void mergeChunk(const ElevationChunk* below, const ElevationChunk& chunk, const ElevationChunk* above,
                std::span<float> heights, std::span<std::uint32_t> from) {
  std::fill(heights.begin(), heights.end(), kVoid);
  std::fill(from.begin(), from.end(), kNoFile);
  std::optional<Shares> shares;
  for (const ElevationLayer& layer : chunk.layers) {
    std::vector<std::uint8_t> far;
    const std::uint32_t first = layer.firstColumn > 0 ? layer.firstColumn - 1 : 0,
                        count = std::min(layer.firstColumn + layer.columns + 1, chunk.columns) - first;
    for (std::uint32_t r = 0; r < kChunkRows; ++r)
      for (std::uint32_t c = 0; c < layer.columns; ++c) {
        const float own = layer.heights[std::size_t{r} * layer.columns + c];
        if (std::isnan(own)) continue;
        const std::size_t i = std::size_t{r} * chunk.columns + layer.firstColumn + c;
        if (chunk.covered[i] == 1) {
          heights[i] = own;
          from[i] = static_cast<std::uint32_t>(layer.file);
          continue;
        }
        if (far.empty()) far = upAndDown({below, &chunk, above}, layer, first, count);
        if (!shares) shares.emplace(heights.size());
        const float part =
            say(std::span(far).subspan(std::size_t{r} * count, count), layer.firstColumn + c - first);
        const float share = shares->left[i] * part;
        shares->left[i] -= share;
        const float before = shares->taken[i];
        shares->taken[i] += share;
        // Equal heights stay what they are, to the bit; so does the only one that counts.
        if (before == 0)
          heights[i] = own;
        else
          heights[i] += (own - heights[i]) * (share / shares->taken[i]);
        if (share > shares->most[i]) shares->most[i] = share, shares->leader[i] = layer.file;
      }
  }
  if (shares)
    for (std::size_t i = 0; i < heights.size(); ++i)
      if (chunk.covered[i] > 1) from[i] = static_cast<std::uint32_t>(shares->leader[i]);
  mergeContinued(chunk, heights, from);
}

}  // namespace trimtab::terrain
