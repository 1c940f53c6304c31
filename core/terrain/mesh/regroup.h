#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "trimtab/terrain/mesh/triangulation.h"

namespace trimtab::terrain {

/// Part of a mesh.
struct MeshPart {
  Triangulation& mesh;                    ///< of its own, in places of the whole
  std::span<const std::int32_t> members;  ///< which of the whole's triangles are in it, in its order
  std::size_t index;
  std::span<const std::uint32_t>
      first;  ///< of every part how many triangles those before it have, and of all
};

/// Parts that a mesh has, empty ones among them.
std::size_t partCount(const Triangulation& mesh, std::int32_t width, std::int32_t height);

/// Works on parts of a mesh at once. Parts are rectangles by the middles of triangles, shifted by half
/// a rectangle, so that what was a border of tiles lies inside them. `work` may flip edges of a part, move
/// vertices and take them out, but not at the part's border.
///
/// Of each triangle that is left, which one it was; empty where none is gone.
std::vector<std::int32_t> eachPart(Triangulation& mesh, std::int32_t width, std::int32_t height,
                                   unsigned threads, const std::function<void(const MeshPart&)>& work);

}  // namespace trimtab::terrain
