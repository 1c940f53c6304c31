#pragma once

#include <algorithm>
#include <set>
#include <vector>

#include "trimtab/culling/select_patches.h"

namespace trimtab::test {

inline double distance(const Box& b, Vec3 eye) {
  const Vec3 nearest{std::clamp(eye.x, double{b.minX}, double{b.maxX}),
                     std::clamp(eye.y, double{b.minY}, double{b.maxY}),
                     std::clamp(eye.z, double{b.minZ}, double{b.maxZ})};
  return length(eye - nearest);
}

inline bool hasChildren(const PatchIndex& index, std::size_t diamond) {
  for (const std::uint32_t patch : index.diamonds[diamond].patches)
    if (patch != PatchIndex::kNone &&
        index.children[patch] != std::array{PatchIndex::kNone, PatchIndex::kNone})
      return true;
  return false;
}

/// What selectPatches promises, found the slow way: sets that grow or shrink until nothing changes any more.
struct PatchFixpoint {
  std::vector<char> wanted, split;  ///< one a diamond
  std::vector<std::uint32_t> drawn;
  std::set<std::uint32_t> pages;  ///< of the cut with all pages there, and above
  std::size_t heldBack = 0;

  PatchFixpoint(const PatchIndex& index, const std::vector<std::uint8_t>& resident, Vec3 eye,
                double tolerance)
      : wanted(index.diamonds.size()), split(index.diamonds.size()) {
    const auto inCut = [&](const std::vector<char>& set, std::uint32_t patch) {
      return index.parent[patch] == PatchIndex::kNone || set[index.diamond[index.parent[patch]]];
    };
    // The smallest set that leaves nobody unsatisfied and is closed towards the roots.
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t d = 0; d < wanted.size(); ++d) {
        if (wanted[d] || !hasChildren(index, d)) continue;
        bool wants = false;
        for (const std::uint32_t patch : index.diamonds[d].patches) {
          if (patch == PatchIndex::kNone || !inCut(wanted, patch)) continue;
          wants |= double{index.errorM[patch][0]} > tolerance * distance(index.bounds[patch], eye);
          for (const std::uint32_t child : index.children[patch])
            if (child != PatchIndex::kNone) wants |= wanted[index.diamond[child]] != 0;
        }
        if (wants) wanted[d] = changed = true;
      }
      for (std::size_t d = 0; d < wanted.size(); ++d)
        if (wanted[d])
          for (const std::uint32_t parent : index.diamonds[d].parents)
            if (parent != PatchIndex::kNone && !wanted[parent]) wanted[parent] = changed = true;
    }
    // The largest part of it that has its pages and is closed.
    split = wanted;
    for (std::size_t d = 0; d < split.size(); ++d)
      for (const std::uint32_t patch : index.diamonds[d].patches)
        if (patch != PatchIndex::kNone && wanted[d])
          for (const std::uint32_t child : index.children[patch])
            if (child != PatchIndex::kNone) {
              pages.insert(index.page[child]);
              if (!resident.empty() && !resident[index.page[child]]) split[d] = 0;
            }
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t d = 0; d < split.size(); ++d)
        for (const std::uint32_t parent : index.diamonds[d].parents)
          if (split[d] && parent != PatchIndex::kNone && !split[parent]) split[d] = 0, changed = true;
    }
    std::set<std::uint32_t> held;
    for (std::uint32_t patch = 0; patch < index.size(); ++patch) {
      if (index.parent[patch] == PatchIndex::kNone) pages.insert(index.page[patch]);
      const std::uint32_t d = index.diamond[patch];
      if (!inCut(split, patch) || split[d]) continue;
      drawn.push_back(patch);
      if (wanted[d]) held.insert(d);
    }
    heldBack = held.size();
  }
};

}  // namespace trimtab::test
