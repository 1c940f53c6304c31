#pragma once

#include <cstdint>
#include <vector>

#include "quadric.h"
#include "trimtab/terrain/static_lod/lattice.h"

namespace trimtab::terrain {

/// Holds what simplification must know of a tile's source: where it may not touch it, and the quadric of each
/// vertex.
struct SourceSurface {
  std::vector<std::uint8_t> fixed;  ///< per vertex: on a border of the tile or a hole, shared with another
                                    ///< tile, at a fold, an upright triangle, or where surfaces meet
  std::vector<Quadric> quadrics;    ///< per vertex, about `origin`
  std::uint64_t folded = 0;         ///< triangles that stand upright or face down
};

/// Makes it from area-weighted planes of the triangles, a third to each corner, and, at edges between
/// materials and at seams of the texture, an upright plane through the edge: a metre sideways there counts as
/// `boundaryWeight` m^2 on a square of the edge's length. With texture coordinates, addTextureQuadrics() adds
/// its terms.
SourceSurface analyse(const LatticeTile& tile, const Lattice& origin, double boundaryWeight = 0.02);

}  // namespace trimtab::terrain
