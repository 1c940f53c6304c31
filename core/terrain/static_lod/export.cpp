#include "trimtab/terrain/static_lod/export.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/unfinished.h"
#include "trimtab/terrain/static_lod/level.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

Finding wrong(const std::string& where, std::string key, std::string expected, std::string found) {
  return {Severity::error, where, std::move(key), std::move(expected), std::move(found)};
}

/// Returns the bucket whose number is the tile's name; -1 if the name is none.
long bucketNamed(const std::string& name) {
  long index = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  if (error != std::errc{} || end != name.data() + name.size()) return -1;
  return bucketOf(index).index;
}

/// The tiles that one list names.
struct List {
  std::string base;
  std::set<std::string> objects;

  std::string text() const {
    std::string lines;
    if (!base.empty()) lines += "OBJECT_BASE " + base + ".btg\n";
    for (const std::string& name : objects) lines += "OBJECT " + name + ".btg\n";
    return lines;
  }
};

constexpr const char* kRoot = "Terrain";

/// Reports whether an export makes this: the folders, the lists, and the tiles.
bool isOfAnExport(const fs::path& inFolder) {
  const std::string name = inFolder.filename().string();
  if (*inFolder.begin() != kRoot) return false;
  const auto depth = std::distance(inFolder.begin(), inFolder.end());
  constexpr int kFileDepth = 4;  // Terrain/e120n30/e128n36/3072816.stg
  return depth < kFileDepth || (depth == kFileDepth && (name.ends_with(".stg") || name.ends_with(".btg.gz")));
}

Result<Done> makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return wrong(folder.string(), "", "a folder that can be made", error.message());
  return Done{};
}

Findings faultsOf(const StaticLodTerrain& terrain, const SceneryExport& options, const std::string& where) {
  Findings findings;
  std::uint32_t levels = 0;
  for (const StaticLodIndex::Node& node : terrain.index.nodes)
    levels = std::max<std::uint32_t>(levels, node.depth + 1u);
  if (options.level >= levels)
    findings.push_back(
        wrong(where, "level", "0 to " + std::to_string(levels - 1), std::to_string(options.level)));
  std::error_code error;
  if (fs::exists(options.output, error) &&
      !(fs::is_directory(options.output, error) && fs::is_empty(options.output, error)))
    findings.push_back(
        wrong(options.output.string(), "", "a folder that does not exist or is empty",
              fs::is_directory(options.output, error) ? "one that holds something" : "a file"));
  return findings;
}

}  // namespace

BtgSurface btgOfLevel(const StaticLodTerrain& terrain, std::size_t tile, std::uint32_t level) {
  const StaticLodTile& from = terrain.tiles[tile];
  const LocalFrame& frame = terrain.index.frame;
  const Mat3 toEarth = transposed(frame.ecefToLocal());
  BtgSurface surface;
  SceneryMesh& mesh = surface.mesh;
  mesh.name = from.name;
  mesh.materials = terrain.materials;
  // The tree has a vertex for each material; the tile needs one for each place, there and in the texture.
  std::map<std::array<float, 5>, std::uint32_t> numbers;
  for (const std::uint32_t node : nodesOfLevel(terrain, tile, level)) {
    const StaticLodRange range = terrain.ranges[node];
    for (std::uint32_t t = range.firstTriangle; t < range.firstTriangle + range.triangles; ++t) {
      SceneryMesh::Triangle triangle{{}, from.material[t]};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t number = from.indices[std::size_t{t} * 3 + k];
        const StaticLodVertex& v = from.vertices[number];
        const TexturePlace texture = from.texture.empty() ? TexturePlace{} : from.texture[number];
        const auto [at, isNew] = numbers.try_emplace({v.x, v.y, v.z, texture[0], texture[1]},
                                                     static_cast<std::uint32_t>(mesh.vertices.size()));
        triangle.vertex[k] = at->second;
        if (!isNew) continue;
        const Vec3 local{v.x + 16.0 * from.origin[0], v.y + 16.0 * from.origin[1],
                         v.z + 16.0 * from.origin[2]};
        const Vec3 normal{v.normal[0] / 127.0, v.normal[1] / 127.0, v.normal[2] / 127.0};
        mesh.vertices.push_back(frame.toEcef(local));
        surface.normals.push_back(toEarth * normal);
        if (!from.texture.empty()) surface.texture.push_back(texture);
      }
      mesh.triangles.push_back(triangle);
    }
  }
  if (!mesh.vertices.empty() && from.texture.empty()) surface.texture = textureByPlace(mesh.vertices);
  return surface;
}

Result<SceneryExported> exportScenery(const StaticLodTerrain& terrain, const SceneryExport& options,
                                      const std::string& where) {
  Findings findings = faultsOf(terrain, options, where);
  if (!findings.empty()) return findings;
  std::error_code ignored;
  fs::create_directories(options.output.parent_path(), ignored);
  auto unfinished = Unfinished::folder(options.output, isOfAnExport);
  if (!unfinished) return unfinished.findings();
  const fs::path root = unfinished->path() / kRoot;
  if (auto made = makeFolder(root); !made) return made.findings();

  SceneryExported done;
  std::map<long, List> lists;
  for (std::size_t tile = 0; tile < terrain.tiles.size(); ++tile) {
    const std::string& name = terrain.tiles[tile].name;
    if (options.progress &&
        !options.progress(static_cast<double>(tile) / static_cast<double>(terrain.tiles.size()), name))
      return Finding{Severity::note, options.output.string(), "", "to be completed", "cancelled"};
    if (name.starts_with("sea-")) {
      ++done.seas;
      continue;
    }
    const BtgSurface surface = btgOfLevel(terrain, tile, options.level);
    long bucket = bucketNamed(name);
    const bool base = bucket >= 0;
    if (!base) {
      Vec3 sum{};
      for (const Vec3 v : surface.mesh.vertices) sum = sum + v;
      const GeodeticPosition middle =
          toGeodetic(sum * (1 / static_cast<double>(surface.mesh.vertices.size())));
      bucket = bucketAt(middle.latitude, middle.longitude).index;
    }
    List& list = lists[bucket];
    const bool isNew = base ? list.base.empty() : list.objects.insert(name).second;
    if (base) list.base = name;
    if (!isNew || name.find('/') != std::string::npos) {
      findings.push_back(wrong(where, "tile " + name,
                               "a file name that is its own in bucket " + std::to_string(bucket),
                               isNew ? "a path" : "a second tile of this name"));
      continue;
    }
    const fs::path folder = root / bucketFolder(bucket);
    if (auto made = makeFolder(folder); !made) return made.findings();
    const std::string bytes = gzip(btgBytes(surface));
    if (auto written = writeOwn(folder / (name + ".btg.gz"), bytes); !written) return written.findings();
    ++(base ? done.tiles : done.airports);
    done.triangles += surface.mesh.triangles.size();
    done.bytes += bytes.size();
    for (const std::uint32_t node : nodesOfLevel(terrain, tile, options.level)) {
      done.rmsErrorM = std::max(done.rmsErrorM, double{terrain.index.rmsErrorM[node]});
      done.maxErrorM = std::max(done.maxErrorM, double{terrain.index.maxErrorM[node]});
    }
  }
  if (!findings.empty()) return findings;
  for (const auto& [bucket, list] : lists) {
    const std::string text = list.text();
    if (auto written = writeOwn(root / bucketFolder(bucket) / (std::to_string(bucket) + ".stg"), text);
        !written)
      return written.findings();
    ++done.lists;
    done.bytes += text.size();
  }
  if (auto placed = unfinished->putInPlace(); !placed) return placed.findings();
  return {done, unfinished.findings()};
}

}  // namespace trimtab::terrain
