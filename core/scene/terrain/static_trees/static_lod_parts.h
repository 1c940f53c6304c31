#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/frame/terrain_index.h"

namespace trimtab::terrain {
struct StaticLodTerrain;
}

namespace trimtab::scene {

/// Gives boxes of the parts of a node's own triangles, in the terrain's frame. One box of the whole node
/// would stick out above the ridge that hides it. Boxes are made when a node is first asked for.
class StaticLodParts {
 public:
  static constexpr std::size_t kPerSide = 4;  ///< parts seen from above

  void setTerrain(const terrain::StaticLodTerrain* terrain);
  /// Returns the boxes, rounded outwards, without parts that have no triangles.
  std::span<const Box> of(std::uint32_t node);

 private:
  struct Range {
    std::uint32_t first = 0, count = 0;
  };
  void make(std::uint32_t node);

  const terrain::StaticLodTerrain* terrain_ = nullptr;
  std::vector<Range> ranges_;
  std::vector<Box> boxes_;
};

}  // namespace trimtab::scene
