#include <algorithm>
#include <cmath>

#include "array_file.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

/// Version 2 added borderErrorM: without it the LOD cut cannot see that a node has lost a runway. Files of
/// version 1 are refused and have to be baked again. Version 3 adds texture coordinates to each tile; it is
/// written only if a tile has some.
namespace trimtab::terrain {

template <>
inline constexpr bool kFillsItsBytes<StaticLodVertex> = sizeof(StaticLodVertex) == 20;

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kVersion = 2, kTexturedVersion = 3;

constexpr ArrayFileKind kKind{
    {'T', 'R', 'I', 'M', 'T', 'R', 'E', 'E'}, "static levels of detail", kVersion, kTexturedVersion};

void write(ArrayWriter& out, const StaticLodTerrain& terrain, bool textured) {
  const StaticLodIndex& index = terrain.index;
  const GeodeticPosition& origin = index.frame.origin();
  out.number(terrain.trianglesPerNode);
  for (const double v : {origin.latitude.value(), origin.longitude.value(), origin.height.value()})
    out.number(v);
  for (const std::uint64_t v : {terrain.counts.distinctFaces, terrain.counts.joinedVertices,
                                terrain.counts.degenerate, terrain.counts.repeated, terrain.counts.folded})
    out.number(v);
  out.number(std::uint64_t{terrain.materials.size()});
  for (const std::string& material : terrain.materials) out.text(material);
  out.array(index.roots);
  out.number(std::uint64_t{index.nodes.size()});
  for (std::size_t i = 0; i < index.nodes.size(); ++i) {
    const StaticLodIndex::Node& node = index.nodes[i];
    for (const std::uint32_t v :
         {node.children[0], node.children[1], node.tile, terrain.ranges[i].firstTriangle, node.triangles})
      out.number(v);
    out.number(node.depth);
    out.number(static_cast<std::uint8_t>(node.lockedMinimum));
  }
  out.array(index.bounds);
  out.array(index.rmsErrorM);
  out.array(index.maxErrorM);
  out.array(index.borderErrorM);
  out.array(index.slopeMax);
  out.number(std::uint64_t{terrain.tiles.size()});
  for (const StaticLodTile& tile : terrain.tiles) {
    out.text(tile.name);
    for (const std::int32_t v : tile.origin) out.number(v);
    out.array(tile.vertices);
    out.array(tile.indices);
    out.array(tile.locked);
    out.array(tile.material);
    if (textured) out.array(tile.texture);
  }
}

void read(ArrayReader& in, StaticLodTerrain& terrain, bool textured) {
  constexpr std::size_t kNodeBytes = 22, kLeastTileBytes = 52;
  StaticLodIndex& index = terrain.index;
  in.number(terrain.trianglesPerNode);
  double latitude = 0, longitude = 0, height = 0;
  for (double* v : {&latitude, &longitude, &height}) in.number(*v);
  if (!(std::abs(latitude) <= 90 && std::abs(longitude) <= 180 && std::abs(height) <= 1e6))
    return in.refuse();
  index.frame = LocalFrame({Degrees{latitude}, Degrees{longitude}, Metres{height}});
  for (std::uint64_t* v : {&terrain.counts.distinctFaces, &terrain.counts.joinedVertices,
                           &terrain.counts.degenerate, &terrain.counts.repeated, &terrain.counts.folded})
    in.number(*v);
  terrain.materials.resize(in.length(8));
  for (std::string& material : terrain.materials) in.text(material);
  in.array(index.roots);
  const std::uint64_t nodes = in.length(kNodeBytes);
  index.nodes.resize(nodes);
  terrain.ranges.resize(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    StaticLodIndex::Node& node = index.nodes[i];
    for (std::uint32_t* v : {&node.children[0], &node.children[1], &node.tile,
                             &terrain.ranges[i].firstTriangle, &node.triangles})
      in.number(*v);
    terrain.ranges[i].triangles = node.triangles;
    in.number(node.depth);
    std::uint8_t locked = 0;
    in.number(locked);
    node.lockedMinimum = locked != 0;
  }
  in.array(index.bounds);
  in.array(index.rmsErrorM);
  in.array(index.maxErrorM);
  in.array(index.borderErrorM);
  in.array(index.slopeMax);
  terrain.tiles.resize(in.length(kLeastTileBytes));
  for (StaticLodTile& tile : terrain.tiles) {
    in.text(tile.name);
    for (std::int32_t& v : tile.origin) in.number(v);
    in.array(tile.vertices);
    in.array(tile.indices);
    in.array(tile.locked);
    in.array(tile.material);
    if (textured) in.array(tile.texture);
  }
}

bool allFinite(const std::vector<float>& values, std::size_t count) {
  if (values.size() != count) return false;
  for (const float v : values)
    if (!(v >= 0 && std::isfinite(v))) return false;
  return true;
}

/// Returns the first thing that keeps a reader from relying on the arrays, or nothing.
std::string faultOf(const StaticLodTerrain& terrain) {
  const StaticLodIndex& index = terrain.index;
  const std::size_t nodes = index.size();
  if (terrain.trianglesPerNode < 1 || terrain.trianglesPerNode > kMostTrianglesPerNode)
    return "triangles a node";
  if (index.bounds.size() != nodes || !allFinite(index.rmsErrorM, nodes) ||
      !allFinite(index.maxErrorM, nodes) || !allFinite(index.borderErrorM, nodes) ||
      !allFinite(index.slopeMax, nodes))
    return "numbers of nodes";
  for (const Box& b : index.bounds)
    if (!(b.minX <= b.maxX && b.minY <= b.maxY && b.minZ <= b.maxZ && std::isfinite(b.maxX - b.minX) &&
          std::isfinite(b.maxY - b.minY) && std::isfinite(b.maxZ - b.minZ)))
      return "bounds";
  for (const StaticLodTile& tile : terrain.tiles) {
    const std::size_t triangles = tile.material.size();
    if (tile.indices.size() != 3 * triangles || tile.locked.size() != triangles) return "arrays of a tile";
    if (!tile.texture.empty() && tile.texture.size() != tile.vertices.size()) return "texture coordinates";
    for (const auto& [u, v] : tile.texture)
      if (!std::isfinite(u) || !std::isfinite(v)) return "texture coordinates";
    for (const std::uint32_t i : tile.indices)
      if (i >= tile.vertices.size()) return "indices";
    for (const std::uint16_t m : tile.material)
      if (m >= terrain.materials.size()) return "materials";
    for (const StaticLodVertex& v : tile.vertices)
      if (!(std::abs(v.x) <= 65536 && std::abs(v.y) <= 65536 && std::abs(v.z) <= 65536)) return "vertices";
  }
  if (index.roots.size() != terrain.tiles.size()) return "roots";
  std::vector<std::uint8_t> parents(nodes);
  for (std::size_t t = 0; t < index.roots.size(); ++t) {
    if (index.roots[t] >= nodes) return "roots";
    const StaticLodIndex::Node& root = index.nodes[index.roots[t]];
    if (root.tile != t || root.depth != 0 || parents[index.roots[t]]++) return "roots";
  }
  for (std::size_t i = 0; i < nodes; ++i) {
    const StaticLodIndex::Node& node = index.nodes[i];
    if (node.tile >= terrain.tiles.size()) return "tiles of nodes";
    const std::size_t triangles = terrain.tiles[node.tile].material.size();
    if (terrain.ranges[i].firstTriangle > triangles ||
        node.triangles > triangles - terrain.ranges[i].firstTriangle)
      return "triangles of nodes";
    if ((node.children[0] == StaticLodIndex::kNone) != (node.children[1] == StaticLodIndex::kNone))
      return "children";
    for (const std::uint32_t child : node.children) {
      if (child == StaticLodIndex::kNone) continue;
      if (child <= i || child >= nodes || index.nodes[child].tile != node.tile ||
          index.nodes[child].depth != node.depth + 1 || parents[child]++)
        return "children";
    }
  }
  for (const std::uint8_t count : parents)
    if (count != 1) return "nodes without a parent";
  return {};
}

}  // namespace

Result<Done> writeStaticLod(const fs::path& file, const StaticLodTerrain& terrain) {
  ArrayWriter out;
  const bool textured = hasTexture(terrain);
  write(out, terrain, textured);
  const auto written = writeArrayFile(file, kKind, textured ? kTexturedVersion : kVersion, std::move(out));
  if (!written) return written.findings();
  return Done{};
}

Result<std::shared_ptr<const StaticLodTerrain>> readStaticLod(const fs::path& file) {
  const auto body = readArrayFile(file, kKind);
  if (!body) return body.findings();
  auto terrain = std::make_shared<StaticLodTerrain>();
  ArrayReader reader(body->bytes);
  read(reader, *terrain, body->version == kTexturedVersion);
  if (Findings end = endFindings(file, reader); !end.empty()) return end;
  if (std::string fault = faultOf(*terrain); !fault.empty()) return faultFinding(file, std::move(fault));
  countStaticLod(*terrain);
  return std::shared_ptr<const StaticLodTerrain>(std::move(terrain));
}

}  // namespace trimtab::terrain
