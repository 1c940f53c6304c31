#pragma once

#include <span>
#include <vector>

#include "trimtab/terrain/patch_build.h"
#include "trimtab/terrain/patch_shape.h"

/// What building a page works with.
namespace trimtab::terrain {

/// Vertices and triangles of one patch before its positions are known; variants from the finest.
struct PatchDraft {
  PatchPlace place;
  std::vector<PatchEdge> edges;
  std::vector<PatchPoint> vertices;                                         ///< whole posts of the data
  std::array<std::vector<std::uint32_t>, PatchIndex::kVariants> triangles;  ///< three a triangle
};

/// Posts from one to the next at which pages of a pair are meshed.
std::uint32_t meshStride(const PatchIndex& index, int pair);
/// The posts that a page's patches cover.
PostWindow pageWindow(const PatchIndex& index, const PatchIndex::Page& page);

/// Measures errors, facts and normals of a page's patches on all posts, strip by strip.
void measurePage(const PatchIndex& index, const PatchIndex::Page& page, const HeightSource& heights,
                 const PostGeometry& geometry, std::span<const PatchDraft> drafts, BuiltPage& built);

}  // namespace trimtab::terrain
