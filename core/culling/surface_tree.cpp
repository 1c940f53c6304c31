#include "trimtab/culling/surface_tree.h"

namespace trimtab {

SurfaceTree SurfaceTree::of(const TerrainIndex& index) {
  SurfaceTree tree{.bounds = index.bounds, .parent = index.parent, .neighbours = index.neighbours};
  tree.children = index.children.empty() ? nullptr : index.children.front().data();
  tree.childrenEach = 4;
  tree.errorM = index.errorM.data();
  // Diagonals of every level run along those of the finest, so two surfaces are furthest apart at posts.
  tree.surfaceErrorM = tree.errorM;
  return tree;
}

SurfaceTree SurfaceTree::of(const PatchIndex& index, const VariantTable<float>& surfaceErrorM) {
  SurfaceTree tree{.bounds = index.bounds, .parent = index.parent, .neighbours = {}};
  tree.children = index.children.empty() ? nullptr : index.children.front().data();
  tree.childrenEach = 2;
  tree.errorM = index.errorM.values().data();
  if (index.size() > 0 && surfaceErrorM.size() == index.size() &&
      surfaceErrorM.variants() == index.variants())
    tree.surfaceErrorM = surfaceErrorM.values().data();
  tree.variants = index.variants();
  return tree;
}

}  // namespace trimtab
