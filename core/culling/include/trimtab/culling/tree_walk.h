#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "trimtab/frame/patch_index.h"
#include "trimtab/frame/static_lod_index.h"
#include "trimtab/frame/terrain_index.h"

/// What selecting a cut and counting its triangles share: the roots and children of each form of the terrain.
namespace trimtab {

inline const auto& childrenOf(const TerrainIndex& index, std::uint32_t node) {
  return index.children[node];
}
inline const auto& childrenOf(const PatchIndex& index, std::uint32_t node) {
  return index.children[node];
}
inline const auto& childrenOf(const StaticLodIndex& index, std::uint32_t node) {
  return index.nodes[node].children;
}

template <class Index, class Visit>
void forEachChild(const Index& index, std::uint32_t node, const Visit& visit) {
  for (const std::uint32_t child : childrenOf(index, node))
    if (child != Index::kNone) visit(child);
}
template <class Index>
bool hasChildren(const Index& index, std::uint32_t node) {
  const auto& children = childrenOf(index, node);
  return std::any_of(children.begin(), children.end(),
                     [](std::uint32_t child) { return child != Index::kNone; });
}

/// Visits the roots, the last one first.
template <class Visit>
void forEachRoot(const TerrainIndex& index, const Visit& visit) {
  // Nodes are ordered by level, so the roots are last.
  for (auto node = static_cast<std::uint32_t>(index.size());
       node-- > 0 && index.parent[node] == TerrainIndex::kNone;)
    visit(node);
}
/// Visits the roots, which are all in the first pages.
template <class Visit>
void forEachRoot(const PatchIndex& index, const Visit& visit) {
  for (const PatchIndex::Page& page : index.pages) {
    if (page.pair != 0) break;
    for (std::uint32_t patch = page.firstPatch; patch < page.firstPatch + page.patches; ++patch)
      if (index.parent[patch] == PatchIndex::kNone) visit(patch);
  }
}
template <class Visit>
void forEachRoot(const StaticLodIndex& index, const Visit& visit) {
  for (const std::uint32_t root : index.roots) visit(root);
}

/// Walks down from the nodes on the stack, depth first: what `descends(node)` is replaced by its children, in
/// their order, and anything else is taken.
template <class Index, class Descends, class Take>
void takeCut(const Index& index, std::vector<std::uint32_t>& stack, const Descends& descends,
             const Take& take) {
  while (!stack.empty()) {
    const std::uint32_t node = stack.back();
    stack.pop_back();
    if (!descends(node)) {
      take(node);
      continue;
    }
    const auto& children = childrenOf(index, node);
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      if (*child != Index::kNone) stack.push_back(*child);
  }
}

}  // namespace trimtab
