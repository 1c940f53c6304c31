#pragma once

#include <cstddef>

#include "trimtab/terrain/objects/source_model.h"

namespace trimtab::terrain {

/// Triangles that cannot be drawn, by reason, and places in textures that are no numbers.
struct MeshFaults {
  std::size_t noCorner = 0;  ///< an index is beyond the vertices
  std::size_t noNumber = 0;  ///< a corner is not a number
  std::size_t noArea = 0;    ///< all corners on one line
  std::size_t noPlace = 0;   ///< vertices of a texture, placed at its corner now
  double farthestM = 0;      ///< the farthest corner of the other triangles from the origin
  std::size_t triangles() const { return noCorner + noNumber + noArea; }
};

/// Returns the triangles that can be drawn, each vertex with a normal of unit length, vertices of the same
/// bytes welded and unused ones left out. `textures`: how many the model has; a vertex of another one has
/// none afterwards. Counts what is left out in `faults`.
SourceMesh checkedMesh(const SourceMesh& mesh, std::size_t textures, MeshFaults& faults);

/// Welds vertices of the same bytes and leaves out unused ones.
SourceMesh welded(const SourceMesh& mesh);

/// The area-weighted normal of a triangle of the mesh, not of unit length: twice its area long.
std::array<float, 3> faceNormal(const SourceMesh& mesh, std::size_t triangle);

}  // namespace trimtab::terrain
