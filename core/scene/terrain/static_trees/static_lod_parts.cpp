#include "static_lod_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "trimtab/frame/box_union.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::scene {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::infinity();

/// Returns the box in the terrain's frame instead of the tile's, rounded outwards.
Box placed(const Box& box, const std::int32_t* origin) {
  const auto down = [](double v) { return std::nextafter(static_cast<float>(v), -kUnbounded); };
  const auto up = [](double v) { return std::nextafter(static_cast<float>(v), kUnbounded); };
  const double x = 16.0 * origin[0], y = 16.0 * origin[1], z = 16.0 * origin[2];
  return {down(x + box.minX), down(y + box.minY), down(z + box.minZ),
          up(x + box.maxX),   up(y + box.maxY),   up(z + box.maxZ)};
}

}  // namespace

void StaticLodParts::setTerrain(const terrain::StaticLodTerrain* terrain) {
  terrain_ = terrain;
  boxes_.clear();
  ranges_.assign(terrain_ ? terrain_->index.size() : 0, {});
}

std::span<const Box> StaticLodParts::of(std::uint32_t node) {
  if (ranges_[node].count == 0) make(node);
  return std::span(boxes_).subspan(ranges_[node].first, ranges_[node].count);
}

void StaticLodParts::make(std::uint32_t node) {
  const terrain::StaticLodTile& tile = terrain_->tiles[terrain_->index.nodes[node].tile];
  const terrain::StaticLodRange range = terrain_->ranges[node];
  const auto boxOf = [&tile](std::size_t triangle) {
    Box box = kNoBox;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const terrain::StaticLodVertex& v = tile.vertices[tile.indices[3 * triangle + corner]];
      box = united(box, v.x, v.y, v.z);
    }
    return box;
  };
  const std::size_t end = std::size_t{range.firstTriangle} + range.triangles;
  Box whole = kNoBox;
  for (std::size_t t = range.firstTriangle; t < end; ++t) whole = united(whole, boxOf(t));
  std::array<Box, kPerSide * kPerSide> parts;
  parts.fill(kNoBox);
  const auto place = [](float low, float high, float from, float to) {
    const float at = to > from ? (0.5f * (low + high) - from) / (to - from) : 0;
    return static_cast<std::size_t>(std::clamp(at * kPerSide, 0.0f, kPerSide - 1.0f));
  };
  for (std::size_t t = range.firstTriangle; t < end; ++t) {
    const Box box = boxOf(t);
    Box& part = parts[place(box.minY, box.maxY, whole.minY, whole.maxY) * kPerSide +
                      place(box.minX, box.maxX, whole.minX, whole.maxX)];
    part = united(part, box);
  }
  ranges_[node].first = static_cast<std::uint32_t>(boxes_.size());
  for (const Box& part : parts)
    if (part.minX <= part.maxX) boxes_.push_back(placed(part, tile.origin));
  // A node without triangles hides behind its bounds.
  if (boxes_.size() == ranges_[node].first) boxes_.push_back(terrain_->index.bounds[node]);
  ranges_[node].count = static_cast<std::uint32_t>(boxes_.size()) - ranges_[node].first;
}

}  // namespace trimtab::scene
