#include "trimtab/terrain/grid/post_grid.h"

#include <algorithm>

#include "trimtab/units/number.h"
#include "trimtab/units/geodesy.h"

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kCells = TerrainIndex::kTileCells;

std::uint32_t tilesFor(std::uint32_t posts, std::uint32_t level) {
  const std::uint64_t span = std::uint64_t{kCells} << level;
  return static_cast<std::uint32_t>((posts - 1 + span - 1) / span);
}

}  // namespace

double PostGrid::columnOf(double longitudeDeg) const {
  const double middle = longitude((columns - 1.0) / 2);
  return (middle + wrapped180(Degrees{longitudeDeg - middle}).value() - west) / stepLongitude;
}

Findings beyondLimits(const PostGrid& posts, const std::string& where) {
  using Limits = PostLimits;
  const auto number = [](double value) { return numberText(value, 9); };
  Findings findings;
  const auto hold = [&](const char* key, const char* what, double value, double low, double high) {
    if (!(value >= low && value <= high))
      findings.push_back(
          {Severity::error, where, key, what + number(low) + " to " + number(high), number(value)});
  };
  hold("longitude", "a westernmost post at ", posts.west, -Limits::kWest, Limits::kWest);
  hold("latitude", "a southernmost post at ", posts.south, -90, 90);
  hold("latitude", "a northernmost post at ", posts.latitude(posts.rows - 1.0), -90, 90 + Limits::kPastPole);
  hold("step", "degrees of longitude from post to post ", posts.stepLongitude, Limits::kLeastStep,
       Limits::kMostStepLongitude);
  hold("step", "degrees of latitude from post to post ", posts.stepLatitude, Limits::kLeastStep,
       Limits::kMostStepLatitude);
  hold("columns", "posts from west to east ", posts.columns, 2, Limits::kMostSide);
  hold("rows", "posts from south to north ", posts.rows, 2, Limits::kMostSide);
  return findings;
}

PostGrid upToPoles(PostGrid posts) {
  const double north = posts.latitude(posts.rows - 1.0);
  if (posts.south >= -90 && north <= 90 + PostLimits::kPastPole) return posts;
  posts.south = std::max(posts.south, -90.0);
  posts.stepLatitude = (std::min(north, 90.0) - posts.south) / (posts.rows - 1.0);
  return posts;
}

TerrainIndex makeLevels(const PostGrid& posts) {
  TerrainIndex index;
  std::uint32_t count = 0;
  for (std::uint32_t level = 0;; ++level) {
    const std::uint32_t columns = tilesFor(posts.columns, level), rows = tilesFor(posts.rows, level);
    index.levels.push_back({count, columns, rows});
    count += columns * rows;
    if (columns == 1 && rows == 1) break;
  }
  index.bounds.resize(count);
  index.errorM.resize(count);
  index.slopeMax.resize(count);
  index.level.resize(count);
  index.parent.assign(count, TerrainIndex::kNone);
  index.children.assign(count,
                        {TerrainIndex::kNone, TerrainIndex::kNone, TerrainIndex::kNone, TerrainIndex::kNone});
  index.neighbours = index.children;

  for (std::size_t l = 0; l < index.levels.size(); ++l) {
    const TerrainIndex::Level& level = index.levels[l];
    for (std::uint32_t row = 0; row < level.rows; ++row)
      for (std::uint32_t column = 0; column < level.columns; ++column) {
        const std::uint32_t node = level.firstNode + row * level.columns + column;
        index.level[node] = static_cast<std::uint8_t>(l);
        auto& beside = index.neighbours[node];
        if (column > 0) beside[0] = node - 1;
        if (column + 1 < level.columns) beside[1] = node + 1;
        if (row > 0) beside[2] = node - level.columns;
        if (row + 1 < level.rows) beside[3] = node + level.columns;
        if (l + 1 < index.levels.size()) {
          const TerrainIndex::Level& up = index.levels[l + 1];
          const std::uint32_t parent = up.firstNode + (row / 2) * up.columns + column / 2;
          index.parent[node] = parent;
          index.children[parent][(row % 2) * 2 + column % 2] = node;
        }
      }
  }
  return index;
}

TilePosts::TilePosts(const TerrainIndex& index, const PostGrid& posts, std::uint32_t node)
    : level(index.level[node]), lastColumn(posts.columns - 1), lastRow(posts.rows - 1) {
  const TerrainIndex::Level& at = index.levels[level];
  tileColumn = (node - at.firstNode) % at.columns;
  tileRow = (node - at.firstNode) / at.columns;
}

}  // namespace trimtab::terrain
