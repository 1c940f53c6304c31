#include "trimtab/terrain/static_lod/fans.h"

#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <unordered_map>

#include "trimtab/terrain/static_lod/level.h"

namespace trimtab::terrain {

namespace {

/// The triangles that are in no run yet, by their directed edges.
class FreeTriangles {
 public:
  explicit FreeTriangles(std::span<const std::uint32_t> indices)
      : indices_(indices), taken_(indices.size() / 3), tried_(indices.size() / 3) {
    for (std::uint32_t t = 0; t < taken_.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k)
        edges_.push_back({corner(t, k), corner(t, k + 1), t, corner(t, k + 2)});
    std::sort(edges_.begin(), edges_.end());
  }
  std::size_t size() const { return taken_.size(); }
  bool taken(std::uint32_t triangle) const { return taken_[triangle] != 0; }
  std::uint32_t corner(std::uint32_t triangle, std::uint32_t k) const {
    return indices_[std::size_t{triangle} * 3 + k % 3];
  }

  /// Forgets what was tried since the last call, and tries `first`.
  void startWith(std::uint32_t first) {
    ++trial_;
    tried_[first] = trial_;
    path_ = {first};
  }
  /// Tries the first free triangle with the edge from `a` to `b`; returns its third corner.
  std::optional<std::uint32_t> across(std::uint32_t a, std::uint32_t b) {
    for (auto e = std::lower_bound(edges_.begin(), edges_.end(), Edge{a, b, 0, 0});
         e != edges_.end() && (*e)[0] == a && (*e)[1] == b; ++e)
      if (const std::uint32_t t = (*e)[2]; !taken_[t] && tried_[t] != trial_) {
        tried_[t] = trial_;
        path_.push_back(t);
        return (*e)[3];
      }
    return {};
  }
  /// The triangles tried since startWith().
  const std::vector<std::uint32_t>& path() const { return path_; }
  void take(const std::vector<std::uint32_t>& path) {
    for (const std::uint32_t t : path) taken_[t] = 1;
  }

 private:
  using Edge = std::array<std::uint32_t, 4>;  ///< from, to, triangle, its third corner
  std::span<const std::uint32_t> indices_;
  std::vector<Edge> edges_;
  std::vector<std::uint8_t> taken_;
  std::vector<std::uint64_t> tried_;
  std::uint64_t trial_ = 0;
  std::vector<std::uint32_t> path_;
};

VertexRun stripFrom(FreeTriangles& free, std::uint32_t triangle, std::uint32_t corner) {
  free.startWith(triangle);
  VertexRun run{free.corner(triangle, corner), free.corner(triangle, corner + 1),
                free.corner(triangle, corner + 2)};
  for (;;) {
    // Every second triangle of a strip is turned over.
    std::uint32_t a = run[run.size() - 2], b = run.back();
    if (run.size() % 2 == 1) std::swap(a, b);
    const auto next = free.across(a, b);
    if (!next) return run;
    run.push_back(*next);
  }
}

VertexRun fanAround(FreeTriangles& free, std::uint32_t triangle, std::uint32_t corner) {
  free.startWith(triangle);
  const std::uint32_t hub = free.corner(triangle, corner);
  std::deque<std::uint32_t> rim{free.corner(triangle, corner + 1), free.corner(triangle, corner + 2)};
  while (const auto next = free.across(hub, rim.back())) rim.push_back(*next);
  while (const auto next = free.across(rim.front(), hub)) rim.push_front(*next);
  VertexRun run{hub};
  run.insert(run.end(), rim.begin(), rim.end());
  return run;
}

template <class From>
std::vector<VertexRun> longestRuns(std::span<const std::uint32_t> indices, const From& from) {
  FreeTriangles free(indices);
  std::vector<VertexRun> runs;
  for (std::uint32_t t = 0; t < free.size(); ++t) {
    if (free.taken(t)) continue;
    VertexRun best;
    std::vector<std::uint32_t> path;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      VertexRun run = from(free, t, corner);
      if (run.size() <= best.size()) continue;
      best = std::move(run);
      path = free.path();
    }
    free.take(path);
    runs.push_back(std::move(best));
  }
  return runs;
}

}  // namespace

std::vector<VertexRun> greedyStrips(std::span<const std::uint32_t> indices) {
  return longestRuns(indices, stripFrom);
}

std::vector<VertexRun> greedyFans(std::span<const std::uint32_t> indices) {
  return longestRuns(indices, fanAround);
}

std::uint64_t cacheMisses(std::span<const std::uint32_t> indices, std::size_t cache) {
  // A vertex is in the cache until `cache` others have missed after it.
  std::unordered_map<std::uint32_t, std::uint64_t> missedAt;
  std::uint64_t misses = 0;
  for (const std::uint32_t v : indices) {
    const auto [at, isNew] = missedAt.try_emplace(v, 0);
    if (!isNew && misses - at->second <= cache) continue;
    at->second = misses++;
  }
  return misses;
}

FanStatistics fanStatistics(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level) {
  FanStatistics sums;
  for (const std::uint32_t node : nodesOfLevel(terrain, tile, level)) {
    const StaticLodRange range = terrain.ranges[node];
    const auto indices = std::span(terrain.tiles[tile].indices)
                             .subspan(std::size_t{range.firstTriangle} * 3, std::size_t{range.triangles} * 3);
    sums.triangles += range.triangles;
    sums.strips += greedyStrips(indices).size();
    sums.fans += greedyFans(indices).size();
    sums.misses16 += cacheMisses(indices, 16);
    sums.misses32 += cacheMisses(indices, 32);
  }
  return sums;
}

}  // namespace trimtab::terrain
