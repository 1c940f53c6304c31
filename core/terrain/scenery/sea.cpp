#include "trimtab/terrain/scenery/sea.h"

#include <algorithm>
#include <cmath>

#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

namespace {

constexpr float kSeaLevelM = 0.5f;

}  // namespace

std::uint32_t OpenSea::rootOf(std::uint32_t area) const {
  while (areas_[area].parent != area) area = areas_[area].parent;
  return area;
}

/// The older stays the root, so that ways to it are short.
void OpenSea::join(std::uint32_t a, std::uint32_t b) {
  a = rootOf(a), b = rootOf(b);
  if (a == b) return;
  const auto [root, other] = std::minmax(a, b);
  areas_[other].parent = root;
  areas_[root].border += areas_[other].border;
  areas_[root].level += areas_[other].level;
  areas_[root].posts += areas_[other].posts;
}

/// A post of the area lies beside one that a tile reaches.
void OpenSea::meet(std::uint32_t area, float height) {
  Area& root = areas_[rootOf(area)];
  root.border += !std::isnan(height);
  root.level += std::abs(height) <= kSeaLevelM;
}

void OpenSea::add(std::span<const float> heights, std::span<const std::uint8_t> reached) {
  const auto columns = static_cast<std::uint32_t>(heights.size());
  const bool isFirst = firstOfRow_.size() == 1;
  const std::size_t before = isFirst ? 0 : firstOfRow_[firstOfRow_.size() - 2], own = stretches_.size();
  for (std::uint32_t c = 0; c < columns;) {
    if (reached[c] != 0) {
      ++c;
      continue;
    }
    Stretch stretch{c, c, 0};
    while (stretch.end < columns && reached[stretch.end] == 0) ++stretch.end;
    c = stretch.end;
    bool known = false;
    for (std::size_t i = before; i < own; ++i) {
      const Stretch& other = stretches_[i];
      if (other.end <= stretch.first || other.first >= stretch.end) continue;
      if (known)
        join(stretch.area, other.area);
      else
        stretch.area = other.area;
      known = true;
    }
    if (!known) {
      stretch.area = static_cast<std::uint32_t>(areas_.size());
      areas_.push_back({stretch.area});
    }
    areas_[rootOf(stretch.area)].posts += stretch.end - stretch.first;
    if (stretch.first > 0) meet(stretch.area, heights[stretch.first - 1]);
    if (stretch.end < columns) meet(stretch.area, heights[stretch.end]);
    for (std::uint32_t k = stretch.first; !isFirst && k < stretch.end; ++k)
      if (belowReach_[k] != 0) meet(stretch.area, below_[k]);
    stretches_.push_back(stretch);
  }
  for (std::size_t i = before; i < own; ++i)
    for (std::uint32_t k = stretches_[i].first; k < stretches_[i].end; ++k)
      if (reached[k] != 0) meet(stretches_[i].area, heights[k]);
  firstOfRow_.push_back(stretches_.size());
  below_.assign(heights.begin(), heights.end());
  belowReach_.assign(reached.begin(), reached.end());
}

void OpenSea::finish() {
  posts_ = 0;
  for (std::uint32_t i = 0; i < areas_.size(); ++i) {
    Area& area = areas_[i];
    area.sea = area.parent == i && area.border > 0 && 2 * area.level >= area.border;
    if (area.sea) posts_ += area.posts;
  }
}

void paintSea(std::span<std::uint8_t> row, const OpenSea::Stretch& stretch) {
  const auto colour = materialColour("Ocean");
  for (std::size_t post = stretch.first; post < stretch.end; ++post) {
    std::copy_n(colour.data(), 3, &row[post * 4]);
    row[post * 4 + 3] = 255;
  }
}

}  // namespace trimtab::terrain
