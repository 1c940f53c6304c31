#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/select.h"

namespace trimtab::scene {

/// Keeps what is known of nodes' surfaces, each made when it is first needed. Surfaces of nodes that are in
/// no cut any more stay until there are more than kKept of them; then all of them go.
template <class Surface>
class SurfacesInUse {
 public:
  static constexpr std::size_t kKept = 4096;

  void reset(std::size_t nodes) {
    surfaces_.clear();
    replaced_.clear();
    surfaces_.resize(nodes);
    count_ = 0;
  }
  /// Returns the surface of a node; null if it was not made yet.
  Surface* find(std::uint32_t node) const { return surfaces_[node].get(); }
  /// Makes a new surface for a node. The one before it is kept until `forgetOthers`.
  Surface& make(std::uint32_t node) {
    if (surfaces_[node])
      replaced_.push_back(std::move(surfaces_[node]));
    else
      ++count_;
    surfaces_[node] = std::make_unique<Surface>();
    return *surfaces_[node];
  }
  /// Frees what was replaced and, once there are too many, what is not in the cut.
  void forgetOthers(const LevelCut& cut) {
    replaced_.clear();
    if (count_ <= kKept + cut.tiles.size()) return;
    std::vector<std::uint8_t> used(surfaces_.size());
    for (const TileDraw& node : cut.tiles) used[node.node] = 1;
    for (std::size_t node = 0; node < surfaces_.size(); ++node)
      if (surfaces_[node] && used[node] == 0) {
        surfaces_[node].reset();
        --count_;
      }
  }

 private:
  std::vector<std::unique_ptr<Surface>> surfaces_, replaced_;
  std::size_t count_ = 0;
};

/// Limits how many surfaces a frame makes. The limit is a number and not a time, so that runs can be
/// repeated. A node without a surface hides nothing, and is hidden by its box alone.
class SurfaceShare {
 public:
  /// About a millisecond of work: 0.1 ms each on a desktop of 2023.
  static constexpr std::size_t kAFrame = 8;

  void begin(std::size_t most) {
    left_ = most;
    missesMany_ = false;
  }
  /// Makes the surfaces that `nodes` miss, nearest first, and returns how many still miss one.
  template <class Misses, class Make>
  std::size_t makeNearest(std::span<const TileDraw> nodes, const std::vector<Box>& bounds, Vec3 eye,
                          const Misses& misses, const Make& make) {
    wanted_.clear();
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
      if (misses(nodes[i])) wanted_.emplace_back(distanceSquared(bounds[nodes[i].node], eye), i);
    const std::size_t now = std::min(left_, wanted_.size()), later = wanted_.size() - now;
    std::partial_sort(wanted_.begin(), wanted_.begin() + static_cast<std::ptrdiff_t>(now), wanted_.end());
    for (std::size_t k = 0; k < now; ++k) make(nodes[wanted_[k].second]);
    left_ -= now;
    made_ += now;
    missesMany_ = missesMany_ || isMany(later, nodes.size());
    return later;
  }
  /// Reports whether so many surfaces are missing that little is known of what the ground hides.
  static bool isMany(std::size_t missing, std::size_t of) { return missing * 8 > of; }
  bool missesMany() const { return missesMany_; }  ///< after any makeNearest of this frame
  std::uint64_t made() const { return made_; }     ///< since the start

 private:
  std::size_t left_ = 0;
  bool missesMany_ = false;
  std::uint64_t made_ = 0;
  std::vector<std::pair<double, std::uint32_t>> wanted_;
};

}  // namespace trimtab::scene
