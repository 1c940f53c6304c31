#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "lines.h"
#include "tree.h"
#include "trimtab/frame/box_union.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/grid/parallel.h"
#include "trimtab/terrain/static_lod/lattice.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab::terrain {

namespace {

/// Holds everything of one tile; node numbers count from its root.
struct BuiltTile {
  StaticLodTile tile;
  std::vector<StaticLodIndex::Node> nodes;
  std::vector<Box> bounds;
  std::vector<float> rmsErrorM, maxErrorM, borderErrorM, slopeMax;
  std::vector<StaticLodRange> ranges;
  std::uint64_t distinctFaces = 0, folded = 0;
};

float upwards(double value) {
  const float f = static_cast<float>(value);
  return f < value ? std::nextafter(f, INFINITY) : f;
}
float downwards(double value) {
  return -upwards(-value);
}

Box boxOf(const LodTree& tree, const LodTree::Node& node) {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high = -low;
  for (const auto& t : node.triangles)
    for (const std::uint32_t v : t) {
      const Vec3 p = tree.vertices[v].metres();
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  return {downwards(low.x), downwards(low.y), downwards(low.z),
          upwards(high.x),  upwards(high.y),  upwards(high.z)};
}

/// Vertices as drawn: one for each material, and each place in the texture, that a vertex has triangles of,
/// in the order of their first use.
class VertexTable {
 public:
  VertexTable(const LodTree& tree, std::span<const std::array<std::uint8_t, 3>> colours, StaticLodTile& tile)
      : tree_(tree), colours_(colours), tile_(tile), first_(tree.vertices.size(), LodTree::kNone) {}

  std::uint32_t number(std::uint32_t vertex, std::uint16_t material, const TexturePlace* texture) {
    for (std::uint32_t i = first_[vertex]; i != LodTree::kNone; i = next_[i])
      if (material_[i] == material && (!texture || tile_.texture[i] == *texture)) return i;
    if (texture) tile_.texture.push_back(*texture);
    const std::uint32_t number = static_cast<std::uint32_t>(tile_.vertices.size());
    next_.push_back(first_[vertex]);
    material_.push_back(material);
    first_[vertex] = number;

    const Lattice& p = tree_.vertices[vertex];
    const auto metres = [](std::int32_t at, std::int32_t origin) {
      return static_cast<float>((at - origin) * Lattice::kStepM);
    };
    StaticLodVertex out{};
    out.x = metres(p.x, tree_.origin.x);
    out.y = metres(p.y, tree_.origin.y);
    out.z = metres(p.z, tree_.origin.z);
    const Vec3 n = tree_.normals[vertex];
    const double size = length(n);
    const Vec3 unit = size > 0 ? n * (127 / size) : Vec3{0, 0, 127};
    out.normal[0] = static_cast<std::int8_t>(std::lround(unit.x));
    out.normal[1] = static_cast<std::int8_t>(std::lround(unit.y));
    out.normal[2] = static_cast<std::int8_t>(std::lround(unit.z));
    for (std::size_t k = 0; k < 3; ++k) out.colour[k] = colours_[material][k];
    out.colour[3] = 255;
    tile_.vertices.push_back(out);
    return number;
  }

 private:
  const LodTree& tree_;
  std::span<const std::array<std::uint8_t, 3>> colours_;
  StaticLodTile& tile_;
  std::vector<std::uint32_t> first_, next_;
  std::vector<std::uint16_t> material_;
};

BuiltTile finished(const std::string& name, const LodTree& tree,
                   std::span<const std::array<std::uint8_t, 3>> colours) {
  BuiltTile out;
  out.tile.name = name;
  out.tile.origin[0] = tree.origin.x / (16 * 256);
  out.tile.origin[1] = tree.origin.y / (16 * 256);
  out.tile.origin[2] = tree.origin.z / (16 * 256);
  out.distinctFaces = tree.distinctFaces;
  out.folded = tree.folded;
  VertexTable table(tree, colours, out.tile);
  for (const LodTree::Node& node : tree.nodes) {
    StaticLodIndex::Node indexed;
    indexed.children = node.children;
    indexed.triangles = static_cast<std::uint32_t>(node.triangles.size());
    indexed.depth = node.depth;
    indexed.lockedMinimum = node.lockedMinimum;
    out.ranges.push_back({static_cast<std::uint32_t>(out.tile.material.size()), indexed.triangles});
    out.nodes.push_back(indexed);
    out.bounds.push_back(boxOf(tree, node));
    out.rmsErrorM.push_back(upwards(node.rmsErrorM));
    out.maxErrorM.push_back(upwards(node.maxErrorM));
    out.borderErrorM.push_back(upwards(node.borderErrorM));
    out.slopeMax.push_back(upwards(node.slopeMax));
    const bool leaf = node.children[0] == LodTree::kNone;
    for (std::size_t t = 0; t < node.triangles.size(); ++t) {
      const std::uint16_t material = node.material[t];
      std::array<bool, 3> locked{};
      for (std::size_t k = 0; k < 3; ++k) {
        out.tile.indices.push_back(table.number(node.triangles[t][k], material,
                                                node.texture.empty() ? nullptr : &node.texture[t][k]));
        locked[k] = tree.locked(node.triangles[t][k], node.depth) ||
                    (!leaf && tree.onLine(node.triangles[t][k], node.lineWidthM));
      }
      std::uint8_t bits = 0;
      for (unsigned k = 0; k < 3; ++k)
        if (locked[k] && locked[(k + 1) % 3]) bits = static_cast<std::uint8_t>(bits | 1u << k);
      out.tile.locked.push_back(bits);
      out.tile.material.push_back(material);
    }
  }
  for (std::size_t i = out.nodes.size(); i-- > 0;)
    for (const std::uint32_t child : out.nodes[i].children)
      if (child != StaticLodIndex::kNone) out.bounds[i] = united(out.bounds[i], out.bounds[child]);
  return out;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void add(StaticLodTerrain& terrain, BuiltTile&& built) {
  StaticLodIndex& index = terrain.index;
  const std::uint32_t base = static_cast<std::uint32_t>(index.size());
  const std::uint32_t tile = static_cast<std::uint32_t>(terrain.tiles.size());
  index.roots.push_back(base);
  for (StaticLodIndex::Node node : built.nodes) {
    node.tile = tile;
    for (std::uint32_t& child : node.children)
      if (child != StaticLodIndex::kNone) child += base;
    index.nodes.push_back(node);
  }
  append(index.bounds, built.bounds);
  append(index.rmsErrorM, built.rmsErrorM);
  append(index.maxErrorM, built.maxErrorM);
  append(index.borderErrorM, built.borderErrorM);
  append(index.slopeMax, built.slopeMax);
  append(terrain.ranges, built.ranges);
  terrain.counts.distinctFaces += built.distinctFaces;
  terrain.counts.folded += built.folded;
  terrain.tiles.push_back(std::move(built.tile));
}

}  // namespace

Result<std::shared_ptr<const StaticLodTerrain>> buildStaticLod(std::span<const SceneryMesh> meshes,
                                                               const LocalFrame& frame,
                                                               const StaticLodOptions& options) {
  const std::string where = "static levels of detail";
  if (options.trianglesPerNode < 1 || options.trianglesPerNode > kMostTrianglesPerNode)
    return Finding{Severity::error, where, "triangles a node",
                   "1 to " + std::to_string(kMostTrianglesPerNode), std::to_string(options.trianglesPerNode)};
  const Finding stopped{Severity::note, where, "", "to be completed", "cancelled"};
  if (options.progress && !options.progress(0, "joining tiles")) return stopped;
  auto lattice = toLattice(meshes, frame);
  if (!lattice) return lattice.findings();

  auto terrain = std::make_shared<StaticLodTerrain>();
  terrain->trianglesPerNode = options.trianglesPerNode;
  terrain->index.frame = frame;
  terrain->materials = std::move(lattice.value().materials);
  terrain->counts.joinedVertices = lattice->joined;
  terrain->counts.degenerate = lattice->degenerate;
  terrain->counts.repeated = lattice->repeated;
  std::vector<std::array<std::uint8_t, 3>> colours;
  for (const std::string& material : terrain->materials) colours.push_back(materialColour(material));

  // The largest first: no core is left with one at the end.
  std::vector<LatticeTile>& tiles = lattice.value().tiles;
  std::vector<std::uint32_t> bySize(tiles.size());
  std::iota(bySize.begin(), bySize.end(), 0u);
  std::stable_sort(bySize.begin(), bySize.end(), [&](std::uint32_t a, std::uint32_t b) {
    return tiles[a].triangles.size() > tiles[b].triangles.size();
  });
  std::uint64_t total = 0;
  for (const LatticeTile& tile : tiles) total += tile.triangles.size();
  std::atomic<std::uint64_t> done{0};
  std::vector<BuiltTile> built(tiles.size());
  const auto work = [&](std::uint32_t i, const GoesOn& goesOn) {
    LatticeTile& tile = tiles[bySize[i]];
    std::vector<float> lines;
    if (options.keepLines) lines = lineWidths(tile, terrain->materials);
    const LodTree tree =
        buildTree(tile, options.trianglesPerNode, std::move(lines), terrain->materials, goesOn);
    if (tree.nodes.empty()) return;
    built[bySize[i]] = finished(tile.name, tree, colours);
    done += tile.triangles.size();
    tile = {};
  };
  const auto carryOn = [&](double) {
    const double share = static_cast<double>(done) / static_cast<double>(total);
    return !options.progress || options.progress(share, "simplifying tiles");
  };
  if (!forEachParallel(static_cast<std::uint32_t>(tiles.size()), work, carryOn)) return stopped;
  for (BuiltTile& tile : built) add(*terrain, std::move(tile));
  countStaticLod(*terrain);
  return {std::shared_ptr<const StaticLodTerrain>(std::move(terrain)), lattice.findings()};
}

}  // namespace trimtab::terrain
