#include "trimtab/culling/surface_tree.h"

namespace trimtab {

SurfaceTree SurfaceTree::of(const TerrainIndex& index) {
  SurfaceTree tree{.bounds = index.bounds, .parent = index.parent, .neighbours = index.neighbours};
  tree.children = index.children.empty() ? nullptr : index.children.front().data();
  tree.childrenEach = 4;
  tree.errorM = index.errorM.data();
  // Diagonals of every level run along the finest ones: surfaces are furthest apart at posts.
  tree.surfaceErrorM = tree.errorM;
  return tree;
}

SurfaceTree SurfaceTree::of(const PatchIndex& index,
                            std::span<const std::array<float, PatchIndex::kVariants>> surfaceErrorM) {
  SurfaceTree tree{.bounds = index.bounds, .parent = index.parent, .neighbours = {}};
  tree.children = index.children.empty() ? nullptr : index.children.front().data();
  tree.childrenEach = 2;
  tree.errorM = index.errorM.empty() ? nullptr : index.errorM.front().data();
  if (surfaceErrorM.size() == index.size() && !surfaceErrorM.empty())
    tree.surfaceErrorM = surfaceErrorM.front().data();
  tree.variants = PatchIndex::kVariants;
  return tree;
}

}  // namespace trimtab
