#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "edges.h"
#include "segment_grid.h"
#include "tree.h"

namespace trimtab::terrain {

/// Returns one flag per material: whether its borders count. On an airport (a name that is no number)
/// all do, else none.
std::vector<std::uint8_t> borderMaterials(const LatticeTile& tile, std::span<const std::string> materials);

/// Measures how far a node moves the borders of materials sideways. On flat ground simplification can move
/// them any distance without any vertical error.
class BorderMeasure {
 public:
  /// `tree` must outlive it. `counts` has one flag per material (borderMaterials).
  BorderMeasure(const LatticeTile& tile, const LodTree& tree, std::span<const std::uint8_t> counts);

  /// Returns the node's horizontal border error in metres, but no less than `atLeastM`, which saves time.
  ///
  /// The error is the largest distance from a drawn border of a material to the source's border of the same
  /// material, and back. Where a material has vanished, its error is the radius of the largest circle that
  /// fits between its borders: a strip of 2 m that is gone costs 1 m. Distances to borders exceed the true
  /// maximum by at most an eighth, or 0.1 m if that is more; circles are sampled every 0.5 m, or every
  /// quarter of the error so far.
  double of(const LodTree::Node& node, double atLeastM) const;

 private:
  /// A border of one material in the source.
  struct Side {
    Segment line;
    Point inward;                   ///< unit vector towards the material
    std::uint32_t inside, outside;  ///< triangles in the tree's order; kNone beyond the tile
  };
  struct Drawn;
  Point place(std::uint32_t vertex) const;
  int outsideOf(const EdgeUse& edge, const LodTree::Node& node) const;
  double circle(Point on, Point towards, std::size_t material, double mostM, double enoughM) const;

  const LodTree& tree_;
  std::vector<std::uint8_t> counts_;
  std::vector<std::uint16_t> material_;  ///< one per source triangle in the tree's order
  std::vector<EdgeUse> edges_;
  std::vector<std::vector<Side>> sides_;  ///< per material
  std::vector<SegmentGrid> source_;       ///< per material
};

}  // namespace trimtab::terrain
