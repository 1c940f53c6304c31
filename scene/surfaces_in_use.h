#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "trimtab/culling/select.h"

namespace trimtab::scene {

/// What is known of a node's surface, made when it is first needed; of nodes that are in no cut any more, so
/// many are kept.
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
  /// Null where it was not made yet.
  Surface* find(std::uint32_t node) const { return surfaces_[node].get(); }
  /// A new one; what was there before is kept until `forgetOthers`.
  Surface& make(std::uint32_t node) {
    if (surfaces_[node])
      replaced_.push_back(std::move(surfaces_[node]));
    else
      ++count_;
    surfaces_[node] = std::make_unique<Surface>();
    return *surfaces_[node];
  }
  /// Frees what was replaced, and what is neither in the cut nor among those that may be kept.
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

}  // namespace trimtab::scene
