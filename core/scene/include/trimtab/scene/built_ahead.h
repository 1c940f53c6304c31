#pragma once

#include <cstddef>

namespace trimtab::scene {

/// Says what building ahead did (Renderer::buildAhead).
struct BuiltAhead {
  std::size_t built = 0;  ///< meshes
  std::size_t left = 0;   ///< names of nodes without a mesh, for which there was no time
};

}  // namespace trimtab::scene
