#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "quadric.h"
#include "trimtab/terrain/static_lod/lattice.h"

namespace trimtab::terrain {

/// A piece of surface that is simplified. Quadrics are about `origin`, in metres.
struct Patch {
  struct Vertex {
    Lattice at;
    Quadric quadric;
    Vec3 normal;           ///< any length
    std::uint32_t id = 0;  ///< the caller's
    bool locked = false;   ///< stays; so does every edge between two locked ones
    bool moved = false;    ///< result: it is a new vertex, and `id` means nothing
  };
  Lattice origin;
  std::vector<Vertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<TextureCorners> texture;  ///< per triangle; empty if there is none
};

/// Collapses edges, least quadric error first, until at most `target` + 1 triangles are left. Returns false
/// if what is left cannot be collapsed. `alive` gets one flag per triangle that is left; the corners of
/// those are updated in place.
///
/// Every vertex that is not locked needs a closed fan of triangles that face up; the caller must lock the
/// others. Corners of triangles that are left get the texture coordinates of
/// their new places. Collapses that would turn a triangle over or upright, make it much thinner than those it
/// replaces, or join surfaces at a vertex (link condition) are left out, so what the patch covers, seen from
/// above, stays covered exactly once.
bool collapseEdges(Patch& patch, std::size_t target, std::vector<std::uint8_t>& alive);

}  // namespace trimtab::terrain
