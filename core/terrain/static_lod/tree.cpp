#include "tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>

#include "collapse.h"
#include "faces.h"
#include "surface.h"

namespace trimtab::terrain {

namespace {

using Index = std::uint32_t;

/// Faces that several nodes have count once.
std::uint64_t distinctFaces(const LodTree& tree) {
  FaceCount<Lattice> faces;
  for (const LodTree::Node& node : tree.nodes)
    for (std::size_t t = 0; t < node.triangles.size(); ++t) {
      const auto& corners = node.triangles[t];
      faces.add({tree.vertices[corners[0]], tree.vertices[corners[1]], tree.vertices[corners[2]]},
                node.material[t]);
    }
  return faces.distinct();
}

class Builder {
 public:
  Builder(const LatticeTile& tile, Index most, std::vector<float> lineWidthM) : tile_(tile), most_(most) {
    tree_.lineWidthM = std::move(lineWidthM);
    Lattice low = tile.vertices[0], high = low;
    for (const Lattice& p : tile.vertices) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    constexpr std::int32_t kOriginStep = 16 * 256;
    const auto middle = [](std::int32_t a, std::int32_t b) {
      return static_cast<std::int32_t>((std::int64_t{a} + b) / 2 / kOriginStep) * kOriginStep;
    };
    tree_.origin = {middle(low.x, high.x), middle(low.y, high.y), middle(low.z, high.z)};
  }

  LodTree build(const std::function<bool()>& goesOn) {
    SourceSurface surface = analyse(tile_, tree_.origin);
    tree_.folded = surface.folded;
    tree_.vertices = tile_.vertices;
    tree_.normals = tile_.normals;
    tree_.order.resize(tile_.triangles.size());
    std::iota(tree_.order.begin(), tree_.order.end(), 0u);
    split(0, static_cast<Index>(tree_.order.size()), 0);
    findBorders(surface.fixed);
    sourceQuadrics_ = std::move(surface.quadrics);
    localOf_.assign(tree_.vertices.size(), LodTree::kNone);
    kept_.resize(tree_.nodes.size());
    for (Index i = static_cast<Index>(tree_.nodes.size()); i-- > 0;) {
      if (goesOn && !goesOn()) return {};
      if (tree_.nodes[i].children[0] == LodTree::kNone) {
        fillLeaf(tree_.nodes[i]);
      } else {
        Patch patch = childrenOf(tree_.nodes[i]);
        if (tree_.lineWidthM.empty())
          simplify(tree_.nodes[i], patch, most_);
        else
          simplifyAroundLines(tree_.nodes[i], patch);
      }
    }
    tree_.distinctFaces = distinctFaces(tree_);
    return std::move(tree_);
  }

 private:
  /// A vertex's quadric as a subtree leaves it.
  struct Kept {
    Index vertex;
    Quadric quadric;
  };

  std::array<std::int64_t, 2> centroid(Index triangle) const {
    std::array<std::int64_t, 2> sum{};
    for (const Index v : tile_.triangles[triangle])
      sum[0] += tile_.vertices[v].x, sum[1] += tile_.vertices[v].y;
    return sum;
  }

  Index split(Index first, Index last, std::uint8_t depth) {
    const Index number = static_cast<Index>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    tree_.nodes[number].first = first;
    tree_.nodes[number].last = last;
    tree_.nodes[number].depth = depth;
    if (last - first <= most_) return number;

    std::array<std::int64_t, 2> low, high;
    low.fill(std::numeric_limits<std::int64_t>::max());
    high.fill(std::numeric_limits<std::int64_t>::min());
    for (Index i = first; i < last; ++i) {
      const auto c = centroid(tree_.order[i]);
      for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], c[k]), high[k] = std::max(high[k], c[k]);
    }
    const std::size_t axis = high[0] - low[0] >= high[1] - low[1] ? 0 : 1;
    const Index half = first + (last - first) / 2;
    const auto at = [&](Index i) { return tree_.order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(half), at(last), [&](Index a, Index b) {
      const auto ca = centroid(a), cb = centroid(b);
      if (ca[axis] != cb[axis]) return ca[axis] < cb[axis];
      return ca[1 - axis] != cb[1 - axis] ? ca[1 - axis] < cb[1 - axis] : a < b;
    });
    const Index left = split(first, half, static_cast<std::uint8_t>(depth + 1));
    const Index right = split(half, last, static_cast<std::uint8_t>(depth + 1));
    tree_.nodes[number].children = {left, right};
    return number;
  }

  /// A vertex is a border of every node below the deepest one that holds all its triangles.
  void findBorders(const std::vector<std::uint8_t>& fixed) {
    std::vector<Index> first(tree_.vertices.size(), LodTree::kNone), last(tree_.vertices.size(), 0);
    for (Index i = 0; i < tree_.order.size(); ++i)
      for (const Index v : tile_.triangles[tree_.order[i]]) {
        first[v] = std::min(first[v], i);
        last[v] = std::max(last[v], i);
      }
    tree_.freeFrom.assign(tree_.vertices.size(), LodTree::kFixed);
    for (Index v = 0; v < tree_.vertices.size(); ++v) {
      if (fixed[v]) continue;
      Index node = 0;
      while (tree_.nodes[node].children[0] != LodTree::kNone) {
        const Index boundary = tree_.nodes[tree_.nodes[node].children[1]].first;
        if (first[v] < boundary && last[v] >= boundary) break;
        node = tree_.nodes[node].children[last[v] < boundary ? 0 : 1];
      }
      tree_.freeFrom[v] = static_cast<std::int8_t>(tree_.nodes[node].depth);
    }
  }

  void fillLeaf(LodTree::Node& leaf) {
    const Index number = static_cast<Index>(&leaf - tree_.nodes.data());
    for (Index i = leaf.first; i < leaf.last; ++i) {
      leaf.triangles.push_back(tile_.triangles[tree_.order[i]]);
      leaf.material.push_back(tile_.material[tree_.order[i]]);
      if (!tile_.texture.empty()) leaf.texture.push_back(tile_.texture[tree_.order[i]]);
    }
    for (const auto& t : leaf.triangles)
      for (const Index v : t)
        if (localOf_[v] == LodTree::kNone) {
          localOf_[v] = 0;
          kept_[number].push_back({v, sourceQuadrics_[v]});
        }
    for (const Kept& k : kept_[number]) localOf_[k.vertex] = LodTree::kNone;
  }

  Patch childrenOf(LodTree::Node& node) {
    Patch patch;
    patch.origin = tree_.origin;
    for (const Index child : node.children) {
      for (const Kept& k : kept_[child]) {
        Index& local = localOf_[k.vertex];
        if (local == LodTree::kNone) {
          local = static_cast<Index>(patch.vertices.size());
          patch.vertices.push_back({tree_.vertices[k.vertex], k.quadric, tree_.normals[k.vertex], k.vertex,
                                    tree_.locked(k.vertex, node.depth), false});
        } else {  // on the border of the two: both have counted the source once
          patch.vertices[local].quadric += k.quadric - sourceQuadrics_[k.vertex];
        }
      }
      for (const auto& t : tree_.nodes[child].triangles)
        patch.triangles.push_back({localOf_[t[0]], localOf_[t[1]], localOf_[t[2]]});
      const auto& texture = tree_.nodes[child].texture;
      patch.texture.insert(patch.texture.end(), texture.begin(), texture.end());
      node.material.insert(node.material.end(), tree_.nodes[child].material.begin(),
                           tree_.nodes[child].material.end());
      kept_[child] = {};
    }
    for (const Patch::Vertex& v : patch.vertices) localOf_[v.id] = LodTree::kNone;
    return patch;
  }

  /// The pixel at the distance where the node may first be drawn is as wide as its RMS error, which depends
  /// on the lines that it keeps: looks for the least pixel whose lines, kept, leave no greater error than it.
  void simplifyAroundLines(LodTree::Node& node, const Patch& children) {
    constexpr int kHalvings = 5;
    const std::size_t vertices = tree_.vertices.size();
    const std::vector<std::uint16_t> material = node.material;
    double low = 0;
    for (const Index child : node.children) low = std::max(low, tree_.nodes[child].lineWidthM);
    double high = simplifyKeeping(node, children, low), at = low;
    if (high > low) {
      const auto again = [&](double pixelM) {
        node.triangles.clear();
        node.texture.clear();
        node.material = material;
        kept_[static_cast<std::size_t>(&node - tree_.nodes.data())].clear();
        tree_.vertices.resize(vertices);
        tree_.normals.resize(vertices);
        tree_.freeFrom.resize(vertices);
        sourceQuadrics_.resize(vertices);
        localOf_.resize(vertices);
        at = pixelM;
        return simplifyKeeping(node, children, pixelM);
      };
      for (int i = 0; i < kHalvings && high > 1.1 * low; ++i) {
        const double middle = std::sqrt(std::max(low, high / 64) * high);
        (again(middle) <= middle ? high : low) = middle;
      }
      if (at != high) again(high);
    }
    node.lineWidthM = at;
  }

  /// Returns the node's RMS error, metres.
  double simplifyKeeping(LodTree::Node& node, const Patch& children, double pixelM) {
    if (!measure_) measure_.emplace(tile_, tree_);
    Patch patch = children;
    // Triangles between lines cannot go: the rest may have its n, or it would pay for them.
    std::size_t lines = 0;
    for (const auto& t : patch.triangles)
      lines += std::all_of(t.begin(), t.end(),
                           [&](Index v) { return tree_.onLine(patch.vertices[v].id, pixelM); });
    for (Patch::Vertex& v : patch.vertices) v.locked = v.locked || tree_.onLine(v.id, pixelM);
    simplify(node, patch, most_ + lines);
    return measure_->of(node).rmsM;
  }

  void simplify(LodTree::Node& node, Patch& patch, std::size_t most) {
    const Index number = static_cast<Index>(&node - tree_.nodes.data());
    std::vector<std::uint8_t> alive;
    node.lockedMinimum = !collapseEdges(patch, most, alive);

    std::vector<std::uint8_t> used(patch.vertices.size());
    for (std::size_t t = 0; t < alive.size(); ++t)
      if (alive[t])
        for (const Index v : patch.triangles[t]) used[v] = 1;
    for (Index i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      Patch::Vertex& v = patch.vertices[i];
      if (v.moved) {
        v.id = static_cast<Index>(tree_.vertices.size());
        tree_.vertices.push_back(v.at);
        tree_.normals.push_back(v.normal);
        tree_.freeFrom.push_back(static_cast<std::int8_t>(node.depth));
        sourceQuadrics_.emplace_back();
        localOf_.push_back(LodTree::kNone);
      }
      kept_[number].push_back({v.id, v.quadric});
    }
    std::size_t left = 0;
    for (std::size_t t = 0; t < alive.size(); ++t) {
      if (!alive[t]) continue;
      const auto& corners = patch.triangles[t];
      node.triangles.push_back(
          {patch.vertices[corners[0]].id, patch.vertices[corners[1]].id, patch.vertices[corners[2]].id});
      if (!patch.texture.empty()) node.texture.push_back(patch.texture[t]);
      node.material[left++] = node.material[t];
    }
    node.material.resize(left);
    node.lockedMinimum = node.lockedMinimum || left > std::size_t{most_} + 1;
  }

  const LatticeTile& tile_;
  Index most_;
  LodTree tree_;
  std::optional<NodeMeasure> measure_;
  std::vector<Quadric> sourceQuadrics_;  ///< of the source's vertices; zero for new ones
  std::vector<Index> localOf_;           ///< scratch, one a vertex
  std::vector<std::vector<Kept>> kept_;  ///< one a node, until its parent is built
};

}  // namespace

LodTree buildTree(const LatticeTile& tile, std::uint32_t trianglesPerNode, std::vector<float> lineWidthM,
                  std::span<const std::string> materials, const std::function<bool()>& goesOn) {
  LodTree tree = Builder(tile, trianglesPerNode, std::move(lineWidthM)).build(goesOn);
  if (!measureTree(tile, tree, materials, goesOn)) return {};
  return tree;
}

}  // namespace trimtab::terrain
