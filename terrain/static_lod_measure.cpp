#include <algorithm>
#include <cmath>

#include "trimtab/terrain/static_lod_error.h"
#include "trimtab/terrain/static_lod_tree.h"

namespace trimtab::terrain {

void measureTree(const LatticeTile& tile, LodTree& tree) {
  std::vector<std::array<std::uint32_t, 3>> source;  // leaf by leaf, so that a node's are one stretch
  source.reserve(tree.order.size());
  for (const std::uint32_t t : tree.order) source.push_back(tile.triangles[t]);
  const VerticalDistance toSource(tile.vertices, source);

  std::vector<std::uint32_t> seen(tree.vertices.size(), LodTree::kNone);
  for (std::uint32_t i = static_cast<std::uint32_t>(tree.nodes.size()); i-- > 0;) {
    LodTree::Node& node = tree.nodes[i];
    for (const auto& t : node.triangles)
      node.slopeMax =
          std::max(node.slopeMax, slopeOf(tree.vertices[t[0]], tree.vertices[t[1]], tree.vertices[t[2]]));
    if (node.children[0] == LodTree::kNone) continue;

    double sum = 0, largest = 0;
    std::uint64_t samples = 0;
    const auto add = [&](std::optional<double> metres) {
      if (!metres) return;  // under an upright triangle alone
      sum += *metres * *metres;
      largest = std::max(largest, *metres);
      ++samples;
    };
    for (const auto& t : node.triangles)
      for (const std::uint32_t v : t) {
        if (seen[v] == i) continue;
        seen[v] = i;
        // A vertex of the source that is still there lies on both surfaces.
        add(v < tile.vertices.size() ? 0.0 : toSource.metres(tree.vertices[v], node.first, node.last));
      }
    const VerticalDistance toNode(tree.vertices, node.triangles);
    const std::uint32_t count = static_cast<std::uint32_t>(node.triangles.size());
    for (std::uint32_t s = node.first; s < node.last; ++s)
      for (const std::uint32_t v : source[s]) {
        if (seen[v] == i) continue;
        seen[v] = i;
        add(toNode.metres(tile.vertices[v], 0, count));
      }
    node.rmsErrorM = samples ? std::sqrt(sum / static_cast<double>(samples)) : 0;
    node.maxErrorM = largest;
    for (const std::uint32_t child : node.children) {
      node.rmsErrorM = std::max(node.rmsErrorM, tree.nodes[child].rmsErrorM);
      node.maxErrorM = std::max(node.maxErrorM, tree.nodes[child].maxErrorM);
      node.slopeMax = std::max(node.slopeMax, tree.nodes[child].slopeMax);
    }
  }
}

}  // namespace trimtab::terrain
