#include <algorithm>
#include <cmath>

#include "borders.h"
#include "tree.h"
#include "trimtab/terrain/static_lod/error.h"

namespace trimtab::terrain {

namespace {

std::vector<std::array<std::uint32_t, 3>> inOrder(const LatticeTile& tile, const LodTree& tree) {
  std::vector<std::array<std::uint32_t, 3>> source;
  source.reserve(tree.order.size());
  for (const std::uint32_t t : tree.order) source.push_back(tile.triangles[t]);
  return source;
}

}  // namespace

NodeMeasure::NodeMeasure(const LatticeTile& tile, const LodTree& tree)
    : tile_(tile), tree_(tree), source_(inOrder(tile, tree)), toSource_(tile.vertices, source_) {}

NodeMeasure::Error NodeMeasure::of(const LodTree::Node& node) {
  seen_.resize(tree_.vertices.size(), 0);
  ++stamp_;
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
      if (seen_[v] == stamp_) continue;
      seen_[v] = stamp_;
      // A vertex of the source that is still there lies on both surfaces.
      add(v < tile_.vertices.size() ? 0.0 : toSource_.metres(tree_.vertices[v], node.first, node.last));
    }
  const VerticalDistance toNode(tree_.vertices, node.triangles);
  const std::uint32_t count = static_cast<std::uint32_t>(node.triangles.size());
  for (std::uint32_t s = node.first; s < node.last; ++s)
    for (const std::uint32_t v : source_[s]) {
      if (seen_[v] == stamp_) continue;
      seen_[v] = stamp_;
      add(toNode.metres(tile_.vertices[v], 0, count));
    }
  return {samples ? std::sqrt(sum / static_cast<double>(samples)) : 0, largest};
}

bool measureTree(const LatticeTile& tile, LodTree& tree, std::span<const std::string> materials,
                 const std::function<bool()>& goesOn) {
  NodeMeasure measure(tile, tree);
  const BorderMeasure borders(tile, tree, borderMaterials(tile, materials));
  for (std::uint32_t i = static_cast<std::uint32_t>(tree.nodes.size()); i-- > 0;) {
    if (goesOn && !goesOn()) return false;
    LodTree::Node& node = tree.nodes[i];
    for (const auto& t : node.triangles)
      node.slopeMax =
          std::max(node.slopeMax, slopeOf(tree.vertices[t[0]], tree.vertices[t[1]], tree.vertices[t[2]]));
    if (node.children[0] == LodTree::kNone) continue;
    const NodeMeasure::Error error = measure.of(node);
    node.rmsErrorM = std::max(error.rmsM, node.lineWidthM);
    node.maxErrorM = std::max(error.maxM, node.lineWidthM);
    for (const std::uint32_t child : node.children) {
      node.rmsErrorM = std::max(node.rmsErrorM, tree.nodes[child].rmsErrorM);
      node.maxErrorM = std::max(node.maxErrorM, tree.nodes[child].maxErrorM);
      node.slopeMax = std::max(node.slopeMax, tree.nodes[child].slopeMax);
      node.borderErrorM = std::max(node.borderErrorM, tree.nodes[child].borderErrorM);
    }
    node.borderErrorM = borders.of(node, node.borderErrorM);
  }
  return true;
}

}  // namespace trimtab::terrain
