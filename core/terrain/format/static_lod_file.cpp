#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/format/store.h"

/// The file holds magic, version, number of bytes that follow, their checksum; then numbers as they are in
/// memory, and arrays with their length in front. Version 2 added borderErrorM: without it the LOD cut cannot
/// see that a node has lost a runway. Files of version 1 are refused and have to be baked again. Version 3
/// adds texture coordinates to each tile; it is written only if a tile has some.
namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::array<char, 8> kMagic{'T', 'R', 'I', 'M', 'T', 'R', 'E', 'E'};
constexpr std::uint32_t kVersion = 2, kTexturedVersion = 3;
constexpr std::size_t kHeaderBytes = 8 + 4 + 8 + 8;

Finding wrong(const fs::path& file, std::string key, std::string expected, std::string found) {
  return {Severity::error, file.string(), std::move(key), std::move(expected), std::move(found)};
}

class Writer {
 public:
  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class T>
  void array(const std::vector<T>& values) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, float> ||
                  std::is_same_v<T, Box> || std::is_same_v<T, std::array<float, 2>> ||
                  std::is_same_v<T, StaticLodVertex>);
    number(std::uint64_t{values.size()});
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void text(const std::string& value) {
    number(std::uint64_t{value.size()});
    bytes += value;
  }

  std::string bytes;
};

/// Stops at the first number or array that would reach past the end; then everything reads as nothing.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  bool failed() const { return failed_; }
  void refuse() { failed_ = true; }
  bool atEnd() const { return at_ == bytes_.size(); }

  template <class T>
  void number(T& value) {
    if (take(sizeof value)) std::memcpy(&value, bytes_.data() + at_ - sizeof value, sizeof value);
  }
  template <class T>
  void array(std::vector<T>& values) {
    const std::uint64_t count = length(sizeof(T));
    values.resize(count);
    if (count > 0) std::memcpy(values.data(), bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }
  void text(std::string& value) {
    const std::uint64_t count = length(1);
    value.assign(bytes_.data() + at_, count);
    at_ += count;
  }
  /// Reads how many things of at least `each` bytes follow; never more than the file can hold.
  std::uint64_t length(std::size_t each) {
    std::uint64_t count = 0;
    number(count);
    if (count > (bytes_.size() - at_) / each) failed_ = true;
    return failed_ ? 0 : count;
  }

 private:
  bool take(std::size_t size) {
    if (failed_ || size > bytes_.size() - at_) return !(failed_ = true);
    at_ += size;
    return true;
  }
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

bool isTextured(const StaticLodTerrain& terrain) {
  return std::any_of(terrain.tiles.begin(), terrain.tiles.end(),
                     [](const StaticLodTile& tile) { return !tile.texture.empty(); });
}

void write(Writer& out, const StaticLodTerrain& terrain, bool textured) {
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

void read(Reader& in, StaticLodTerrain& terrain, bool textured) {
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
  Writer body;
  // The header is put in front of the body in one piece, so that there is no second copy of it.
  body.bytes.assign(kHeaderBytes, '\0');
  const bool textured = isTextured(terrain);
  write(body, terrain, textured);
  const std::string_view behind = std::string_view(body.bytes).substr(kHeaderBytes);
  Writer header;
  header.bytes.assign(kMagic.data(), kMagic.size());
  header.number(textured ? kTexturedVersion : kVersion);
  header.number(std::uint64_t{behind.size()});
  header.number(checksum(behind));
  std::copy(header.bytes.begin(), header.bytes.end(), body.bytes.begin());
  return writeAtomically(file, body.bytes);
}

Result<std::shared_ptr<const StaticLodTerrain>> readStaticLod(const fs::path& file) {
  if (const auto data = checkIsData(file); !data) return data.findings();
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (error) return wrong(file, "", "a readable file", error.message());
  std::ifstream in(file, std::ios::binary);
  std::array<char, kHeaderBytes> header{};
  in.read(header.data(), kHeaderBytes);
  if (in.gcount() != kHeaderBytes || std::memcmp(header.data(), kMagic.data(), kMagic.size()) != 0)
    return wrong(file, "", "static levels of detail (TRIMTREE)",
                 "another file of " + std::to_string(size) + " bytes");
  std::uint32_t version;
  std::uint64_t bodySize, sum;
  std::memcpy(&version, &header[8], 4);
  std::memcpy(&bodySize, &header[12], 8);
  std::memcpy(&sum, &header[20], 8);
  if (version != kVersion && version != kTexturedVersion)
    return wrong(
        file, "version",
        std::to_string(kVersion) + " or " + std::to_string(kTexturedVersion) + " (bake the sources again)",
        std::to_string(version));
  if (bodySize != size - kHeaderBytes)
    return wrong(file, "size", std::to_string(bodySize) + " bytes after the header",
                 std::to_string(size - kHeaderBytes) + " bytes");
  std::string body(bodySize, '\0');
  in.read(body.data(), static_cast<std::streamsize>(bodySize));
  if (!in) return wrong(file, "", "a readable file", std::strerror(errno));
  if (const std::uint64_t found = checksum(body); found != sum)
    return wrong(file, "checksum", hexadecimal(sum), hexadecimal(found));

  auto terrain = std::make_shared<StaticLodTerrain>();
  Reader reader(body);
  read(reader, *terrain, version == kTexturedVersion);
  if (reader.failed() || !reader.atEnd())
    return wrong(file, "", "arrays that end with the file",
                 reader.failed() ? "one past its end" : "bytes left over");
  if (const std::string fault = faultOf(*terrain); !fault.empty())
    return wrong(file, fault, "numbers that agree with each other", "some that do not");
  countStaticLod(*terrain);
  return std::shared_ptr<const StaticLodTerrain>(std::move(terrain));
}

}  // namespace trimtab::terrain
