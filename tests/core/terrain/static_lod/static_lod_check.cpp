#include "static_lod_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include "trimtab/terrain/format/static_lod_terrain.h"

namespace trimtab::test {

namespace {

struct PlaceHash {
  std::size_t operator()(const PlacedTrees::Place& p) const {
    std::uint64_t h = 0;
    for (const std::int64_t v : p)
      h = (h ^ static_cast<std::uint64_t>(v)) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
    return static_cast<std::size_t>(h);
  }
};

Border reduced(std::vector<BorderEdge>& edges) {
  std::sort(edges.begin(), edges.end(), [](const BorderEdge& a, const BorderEdge& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  Border border;
  for (std::size_t i = 0, end; i < edges.size(); i = end) {
    std::int32_t count = 0;
    for (end = i; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high;
         ++end)
      count += edges[end].count;
    if (count != 0) border.push_back({edges[i].low, edges[i].high, count});
  }
  return border;
}

void addEdges(const std::vector<PlacedTrees::Corners>& triangles, std::vector<BorderEdge>& edges) {
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
}

PlacedTrees::Corners turned(PlacedTrees::Corners t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

std::uint64_t newFolds(const PlacedTrees& trees, const std::vector<PlacedTrees::Corners>& node,
                       const std::vector<PlacedTrees::Corners>& below) {
  std::vector<PlacedTrees::Corners> had, has;
  for (const auto& t : below)
    if (trees.area(t) <= 0) had.push_back(turned(t));
  for (const auto& t : node)
    if (trees.area(t) <= 0) has.push_back(turned(t));
  std::sort(had.begin(), had.end());
  std::sort(has.begin(), has.end());
  return has.size() + had.size() - 2 * [&] {
    std::vector<PlacedTrees::Corners> both;
    std::set_intersection(has.begin(), has.end(), had.begin(), had.end(), std::back_inserter(both));
    return both.size();
  }();
}

}  // namespace

PlacedTrees::PlacedTrees(const terrain::StaticLodTerrain& terrain) : terrain_(terrain) {
  std::unordered_map<Place, std::uint32_t, PlaceHash> numbers;
  for (const terrain::StaticLodTile& tile : terrain.tiles) {
    std::vector<std::uint32_t>& placeOf = placeOf_.emplace_back();
    for (const terrain::StaticLodVertex& v : tile.vertices) {
      Place place;
      const float metres[3] = {v.x, v.y, v.z};
      for (std::size_t k = 0; k < 3; ++k) {
        const double steps = double{metres[k]} * 256;
        onLattice_ = onLattice_ && steps == std::round(steps) && std::abs(steps) < 16777216;
        place[k] = std::int64_t{tile.origin[k]} * 4096 + std::llround(steps);
      }
      const auto [at, isNew] = numbers.try_emplace(place, static_cast<std::uint32_t>(places_.size()));
      if (isNew) places_.push_back(place);
      placeOf.push_back(at->second);
    }
  }
}

std::vector<PlacedTrees::Corners> PlacedTrees::triangles(std::uint32_t node) const {
  const std::uint32_t tile = terrain_.index.nodes[node].tile;
  const terrain::StaticLodRange range = terrain_.ranges[node];
  std::vector<Corners> out(range.triangles);
  for (std::size_t t = 0; t < out.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      out[t][k] = placeOf_[tile][terrain_.tiles[tile].indices[(range.firstTriangle + t) * 3 + k]];
  return out;
}

Border PlacedTrees::border(std::uint32_t node) const {
  return border(std::vector<std::uint32_t>{node});
}
Border PlacedTrees::border(const std::vector<std::uint32_t>& nodes) const {
  std::vector<BorderEdge> edges;
  for (const std::uint32_t node : nodes) addEdges(triangles(node), edges);
  return reduced(edges);
}

std::int64_t PlacedTrees::area(const Corners& t) const {
  const Place &a = places_[t[0]], &b = places_[t[1]], &c = places_[t[2]];
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

std::vector<std::uint32_t> PlacedTrees::leavesOf(std::uint32_t node) const {
  std::vector<std::uint32_t> stack{node}, leaves;
  while (!stack.empty()) {
    const std::uint32_t at = stack.back();
    stack.pop_back();
    const auto& children = terrain_.index.nodes[at].children;
    if (children[0] == StaticLodIndex::kNone) {
      leaves.push_back(at);
    } else {
      stack.insert(stack.end(), children.begin(), children.end());
    }
  }
  return leaves;
}

TreeFaults faultsOf(const PlacedTrees& trees) {
  const terrain::StaticLodTerrain& terrain = trees.terrain();
  const StaticLodIndex& index = terrain.index;
  const std::uint32_t n = terrain.trianglesPerNode;
  TreeFaults faults;
  std::vector<std::pair<std::uint32_t, std::array<PlacedTrees::Corners, 2>>>
      faces;  // tile, corners and material
  std::map<std::uint32_t, std::array<std::int8_t, 3>> borderNormals;
  for (std::uint32_t i = 0; i < index.size(); ++i) {
    const StaticLodIndex::Node& node = index.nodes[i];
    const terrain::StaticLodTile& tile = terrain.tiles[node.tile];
    const bool leaf = node.children[0] == StaticLodIndex::kNone;
    const auto triangles = trees.triangles(i);
    const Border border = trees.border(i);
    faults.lockedMinima += node.lockedMinimum;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      faces.push_back(
          {node.tile, {turned(triangles[t]), {tile.material[terrain.ranges[i].firstTriangle + t], 0, 0}}});

    const double errors[] = {index.rmsErrorM[i], index.maxErrorM[i], index.slopeMax[i]};
    bool wrong = errors[0] > errors[1];
    for (const double e : errors) wrong = wrong || !(e >= 0 && std::isfinite(e));
    if (leaf) {
      const bool whole = node.depth == 0;
      faults.wrongLeaves += node.triangles > n || (!whole && node.triangles < n / 2);
      wrong = wrong || errors[0] != 0 || errors[1] != 0;
    } else {
      faults.wrongNodes +=
          node.lockedMinimum ? node.triangles <= n + 1 : node.triangles + 1 < n || node.triangles > n + 1;
      std::vector<PlacedTrees::Corners> below;
      for (const std::uint32_t child : node.children) {
        const auto more = trees.triangles(child);
        below.insert(below.end(), more.begin(), more.end());
        wrong = wrong || index.rmsErrorM[child] > errors[0] || index.maxErrorM[child] > errors[1] ||
                index.slopeMax[child] > errors[2];
      }
      faults.cracks += border != trees.border({node.children[0], node.children[1]});
      faults.newFolds += newFolds(trees, triangles, below);
      std::int64_t area = 0;
      for (const auto& t : triangles) area += trees.area(t);
      for (const auto& t : below) area -= trees.area(t);
      faults.lostArea += area != 0;
    }
    faults.wrongErrors += wrong;

    // Every node above holds these vertices too, so its box is no smaller: checked against the root's as
    // well.
    for (const std::uint32_t holder : {i, index.roots[node.tile]}) {
      const Box& b = index.bounds[holder];
      for (const auto& t : triangles)
        for (const std::uint32_t v : t) {
          const auto& p = trees.place(v);
          const double x = static_cast<double>(p[0]) / 256, y = static_cast<double>(p[1]) / 256,
                       z = static_cast<double>(p[2]) / 256;
          faults.wrongBounds +=
              x < b.minX || x > b.maxX || y < b.minY || y > b.maxY || z < b.minZ || z > b.maxZ;
        }
    }

    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const std::size_t at = terrain.ranges[i].firstTriangle + t;
      for (unsigned k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
        const BorderEdge edge{std::min(a, b), std::max(a, b), 0};
        const auto found = std::lower_bound(
            border.begin(), border.end(), edge,
            [](const auto& x, const auto& y) { return x.low != y.low ? x.low < y.low : x.high < y.high; });
        const bool onBorder = found != border.end() && found->low == edge.low && found->high == edge.high;
        if (!onBorder) continue;
        faults.wrongLocks += (tile.locked[at] >> k & 1) == 0;
        if (node.depth > 0) continue;
        const std::int8_t* normal = tile.vertices[tile.indices[at * 3 + k]].normal;
        const auto [seen, isNew] =
            borderNormals.try_emplace(a, std::array<std::int8_t, 3>{normal[0], normal[1], normal[2]});
        faults.unequalNormals += !std::equal(normal, normal + 3, seen->second.begin());
      }
    }
  }
  std::sort(faces.begin(), faces.end());
  faults.distinctFaces = static_cast<std::uint64_t>(std::unique(faces.begin(), faces.end()) - faces.begin());
  return faults;
}

int openCuts(const PlacedTrees& trees, int cuts, std::uint32_t seed) {
  const StaticLodIndex& index = trees.terrain().index;
  std::vector<std::uint32_t> leaves;
  for (const std::uint32_t root : index.roots) {
    const auto more = trees.leavesOf(root);
    leaves.insert(leaves.end(), more.begin(), more.end());
  }
  const Border source = trees.border(leaves);
  std::mt19937 random(seed);
  int open = 0;
  for (int cut = 0; cut < cuts; ++cut) {
    std::vector<std::uint32_t> drawn, stack = index.roots;
    while (!stack.empty()) {
      const std::uint32_t at = stack.back();
      stack.pop_back();
      const auto& children = index.nodes[at].children;
      if (children[0] == StaticLodIndex::kNone || random() % 3 == 0) {
        drawn.push_back(at);
      } else {
        stack.insert(stack.end(), children.begin(), children.end());
      }
    }
    open += trees.border(drawn) != source;
  }
  return open;
}

}  // namespace trimtab::test
