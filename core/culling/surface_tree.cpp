#include "trimtab/culling/surface_tree.h"

namespace trimtab {

SurfaceTree SurfaceTree::of(const TerrainIndex& index) {
  SurfaceTree tree{.bounds = index.bounds, .parent = index.parent, .neighbours = index.neighbours};
  tree.children = index.children.empty() ? nullptr : index.children.front().data();
  tree.childrenEach = 4;
  tree.errorM = index.errorM.data();
  return tree;
}

SurfaceTree SurfaceTree::of(const PatchIndex& index) {
  SurfaceTree tree{.bounds = index.bounds, .parent = index.parent, .neighbours = {}};
  tree.children = index.children.empty() ? nullptr : index.children.front().data();
  tree.childrenEach = 2;
  tree.errorM = index.errorM.empty() ? nullptr : index.errorM.front().data();
  tree.variants = PatchIndex::kVariants;
  return tree;
}

}  // namespace trimtab
