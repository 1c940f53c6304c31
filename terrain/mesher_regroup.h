#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "trimtab/terrain/mesher_triangulation.h"

namespace trimtab::terrain {

/// Works on parts of a mesh at once. Parts are rectangles by the middles of triangles, shifted by half
/// a rectangle, so that what was a border of tiles lies inside them. `work` gets each part as a mesh of
/// its own, in places of the whole, and which of the whole's triangles are in it, in its order; it may flip
/// edges and move vertices, but not at the part's border.
void eachPart(Triangulation& mesh, std::int32_t width, std::int32_t height, unsigned threads,
              const std::function<void(Triangulation&, std::span<const std::int32_t>)>& work);

}  // namespace trimtab::terrain
