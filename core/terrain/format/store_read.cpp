#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

#include "manifest_checksum.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/format/object_file.h"
#include "trimtab/terrain/format/patch_store.h"
#include "trimtab/terrain/format/post_sources.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/format/unchecked.h"
#include "trimtab/terrain/grid/post_geometry.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kNodeFloats = 8;

Finding wrong(const fs::path& file, std::string key, std::string expected, std::string found) {
  return {Severity::error, file.string(), std::move(key), std::move(expected), std::move(found)};
}
std::string bytesText(std::uint64_t bytes) {
  return std::to_string(bytes) + " bytes";
}

/// Numbers of a JSON object with what is wrong with them.
struct Reader {
  const fs::path& file;
  Findings& findings;

  double number(const Json& object, const char* key, double low, double high) const {
    if (object.is_object() && object.contains(key) && object[key].is_number()) {
      const double value = object[key].get<double>();
      if (value >= low && value <= high) return value;
    }
    std::string found = "nothing";
    if (object.is_object() && object.contains(key)) found = object[key].dump();
    Json limits = {low, high};
    findings.push_back(wrong(file, key, "a number in " + limits.dump(), found));
    return low;
  }
  std::string text(const Json& object, const char* key) const {
    if (object.is_object() && object.contains(key) && object[key].is_string())
      return object[key].get<std::string>();
    findings.push_back(wrong(file, key, "a text",
                             object.is_object() && object.contains(key) ? object[key].dump() : "nothing"));
    return {};
  }
};

SceneryCounts sceneryOf(const Json& json, const Reader& read) {
  SceneryCounts counts;
  counts.tiles = static_cast<std::uint32_t>(read.number(json, "tiles", 0, 1e9));
  counts.airports = static_cast<std::uint32_t>(read.number(json, "airports", 0, 1e9));
  counts.trianglesInFile = static_cast<std::uint64_t>(read.number(json, "triangles_in_file", 0, 1e15));
  counts.degenerate = static_cast<std::uint64_t>(read.number(json, "degenerate", 0, 1e15));
  counts.triangles = static_cast<std::uint64_t>(read.number(json, "triangles", 0, 1e15));
  if (json.is_object() && json.contains("missing") && json["missing"].is_array())
    for (const Json& name : json["missing"])
      if (name.is_string()) counts.missing.push_back(name.get<std::string>());
  return counts;
}

/// Reads the trees, if they are those of this manifest's terrain.
std::shared_ptr<const StaticLodTerrain> readTrees(const fs::path& file, const Json& json,
                                                  const PostGrid& posts, Findings& findings) {
  const auto trees = withinMemory(file, [&] { return readStaticLod(file); });
  findings.insert(findings.end(), trees.findings().begin(), trees.findings().end());
  if (!trees) return {};
  const Json found = (*trees)->trianglesPerNode;
  const Json expected = json.is_object() ? json.value("triangles_per_node", Json()) : Json();
  if (found != expected)
    findings.push_back(
        wrong(file, "triangles per node", expected.dump() + ", as the manifest says", found.dump()));
  if (!((*trees)->index.frame.origin() == PostGeometry(posts).frame().origin()))
    findings.push_back(wrong(file, "frame", "that of the heights", "another one"));
  return *trees;
}

/// Reads the objects, if they are those of this manifest and of its terrain.
std::shared_ptr<const ObjectTerrain> readListedObjects(const fs::path& file, const Json& entry,
                                                       const PostGrid& posts, Findings& findings) {
  const Json stated = entry.is_object() ? entry.value("fnv64", Json()) : Json();
  const std::string sum = stated.is_string() ? stated.get<std::string>() : "";
  if (sum.empty()) {
    findings.push_back(wrong(file, "checksum", "one in the manifest", stated.dump()));
    return {};
  }
  const auto objects = withinMemory(file, [&] { return readObjects(file, sum); });
  findings.insert(findings.end(), objects.findings().begin(), objects.findings().end());
  if (!objects) return {};
  if (!((*objects)->index.frame.origin() == PostGeometry(posts).frame().origin()))
    findings.push_back(wrong(file, "frame", "that of the heights", "another one"));
  return *objects;
}

/// The files of a manifest; what is wrong with them, and what they take.
struct Files {
  const fs::path& folder;
  Json entries;
  Findings findings = {};
  std::uint64_t bytes = 0;

  /// Opens it, if its size is right.
  std::shared_ptr<const StoredFile> open(const char* name, std::uint64_t expected) {
    const auto stored = StoredFile::open(folder / name);
    findings.insert(findings.end(), stored.findings().begin(), stored.findings().end());
    if (!stored) return {};
    bytes += (*stored)->size();
    if ((*stored)->size() == expected) return *stored;
    findings.push_back(wrong(folder / name, "size", bytesText(expected), bytesText((*stored)->size())));
    return {};
  }
  /// Opens a file whose size follows from the manifest alone, if there is one.
  void openListed(const char* name) {
    if (!entries.is_object() || !entries.contains(name)) return;
    const Json stated = entries[name].is_object() ? entries[name].value("bytes", Json()) : Json();
    open(name, stated.is_number_unsigned() ? stated.get<std::uint64_t>() : 0);
  }
  /// Reads all of it into `into`, if it is what the manifest says.
  bool whole(const StoredFile& stored, const char* name, std::span<std::byte> into) {
    const auto read = stored.read(0, into);
    findings.insert(findings.end(), read.findings().begin(), read.findings().end());
    if (read && Unchecked::any()) return true;
    return read && compare(name, checksum({reinterpret_cast<const char*>(into.data()), into.size()}));
  }
  bool compare(const char* name, std::uint64_t sum) {
    const Json entry = entries.is_object() ? entries.value(name, Json()) : Json();
    const std::string expected = entry.is_object() && entry.contains("fnv64") && entry["fnv64"].is_string()
                                     ? entry["fnv64"].get<std::string>()
                                     : "";
    if (expected == hexadecimal(sum)) return true;
    findings.push_back(wrong(folder / name, "checksum", expected.empty() ? "one in the manifest" : expected,
                             hexadecimal(sum)));
    return false;
  }
  template <class T>
  std::vector<T> array(const char* name, std::size_t count) {
    const auto stored = open(name, std::uint64_t{count} * sizeof(T));
    if (!stored) return {};
    std::vector<T> values(count);
    if (!whole(*stored, name, std::as_writable_bytes(std::span(values)))) return {};
    return values;
  }
  /// Rows with their sums beside them. `sums` is null for version 1, which has none: all is read now, and the
  /// sums are made, so that what is read later is what was compared.
  std::shared_ptr<const CheckedRows> rows(const char* name, const char* sums, std::size_t rowBytes,
                                          std::uint32_t count, CheckedRows::Sound sound) {
    const auto stored = open(name, std::uint64_t{rowBytes} * count);
    if (!stored) return {};
    const std::uint32_t perBlock = CheckedRows::rowsPerBlock(rowBytes);
    std::vector<std::uint64_t> values;
    if (sums) {
      values = array<std::uint64_t>(sums, (count + perBlock - 1) / perBlock);
      if (values.empty()) return {};
    } else {
      std::vector<std::byte> all(stored->size());
      if (!whole(*stored, name, all)) return {};
      if (sound && !sound(all)) {
        findings.push_back(wrong(folder / name, "heights", "those between the manifest's limits", "others"));
        return {};
      }
      CheckedRows::Sums made(rowBytes);
      made.add(all);
      values = made.finish();
    }
    return std::make_shared<CheckedRows>(stored, rowBytes, count, std::move(values), std::move(sound));
  }
  std::shared_ptr<const PageFile> pages(const char* name) {
    const auto opened = PageFile::open(folder / name);
    findings.insert(findings.end(), opened.findings().begin(), opened.findings().end());
    if (!opened || !compare(name, (*opened)->checksum())) return {};
    bytes += (*opened)->bytes();
    return *opened;
  }
};

void readNodes(Files& files, Contents& contents) {
  contents.index = makeLevels(contents.posts);
  contents.slopes = CellSlopes(contents.index);
  const auto nodes = files.array<float>(kNodesName, contents.index.size() * kNodeFloats);
  auto slopes = files.array<std::uint8_t>(kSlopesName, contents.slopes.cells.size());
  if (nodes.empty() || slopes.empty()) return;
  contents.slopes.cells = std::move(slopes);
  for (std::size_t i = 0; i < contents.index.size(); ++i) {
    const std::span<const float> n(&nodes[i * kNodeFloats], kNodeFloats);
    if (!std::all_of(n.begin(), n.end(), [](float f) { return std::isfinite(f); })) {
      files.findings.push_back(
          wrong(files.folder / kNodesName, "node " + std::to_string(i), "numbers", "others"));
      return;
    }
    contents.index.bounds[i] = {n[0], n[1], n[2], n[3], n[4], n[5]};
    contents.index.errorM[i] = n[6];
    contents.index.slopeMax[i] = n[7];
  }
  // Earlier bakes have none.
  if (files.entries.contains(kConesName))
    contents.index.cones = files.array<NormalCone>(kConesName, contents.index.size());
}

}  // namespace

Result<Contents> readContents(const fs::path& folder) {
  const fs::path file = folder / kManifestName;
  auto text = readWhole(file);
  if (!text) return text.findings();
  const Json manifest = Json::parse(*text, nullptr, false);
  if (!manifest.is_object())
    return wrong(file, "", "a JSON object that names a terrain database", "text that is no JSON object");
  if (!manifest.contains("format") || manifest["format"] != "trimtab-terrain")
    return wrong(file, "format", "trimtab-terrain",
                 manifest.contains("format") ? manifest["format"].dump() : "nothing");
  const Json version = manifest.value("version", Json());
  if (version != 1 && version != kFormatVersion)
    return wrong(file, "version", "1 or " + std::to_string(kFormatVersion) + " (bake the sources again)",
                 version.is_null() ? "nothing" : version.dump());
  const std::size_t place = manifestChecksumPlace(*text);
  if (place == std::string::npos) return wrong(file, "checksum", "16 hexadecimal digits", "nothing");
  if (const std::string sum = manifestChecksum(*text, place); text->substr(place, 16) != sum)
    return wrong(file, "checksum", text->substr(place, 16), sum);

  Findings findings;
  const Reader read{file, findings};
  const Json grid = manifest.value("grid", Json::object());
  PostGrid posts;
  posts.west = read.number(grid, "west_deg", -PostLimits::kWest, PostLimits::kWest);
  posts.south = read.number(grid, "south_deg", -90, 90);
  posts.stepLongitude =
      read.number(grid, "step_longitude_deg", PostLimits::kLeastStep, PostLimits::kMostStepLongitude);
  posts.stepLatitude =
      read.number(grid, "step_latitude_deg", PostLimits::kLeastStep, PostLimits::kMostStepLatitude);
  posts.columns = static_cast<std::uint32_t>(read.number(grid, "columns", 2, PostLimits::kMostSide));
  posts.rows = static_cast<std::uint32_t>(read.number(grid, "rows", 2, PostLimits::kMostSide));
  TerrainInfo info;
  info.name = read.text(manifest, "name");
  info.source = read.text(manifest, "source");
  info.checksum = text->substr(place, 16);
  info.lowest = Metres{read.number(manifest, "lowest_m", -20000, 20000)};
  info.highest = Metres{read.number(manifest, "highest_m", -20000, 20000)};
  info.voidsFilled = static_cast<std::uint64_t>(read.number(manifest, "voids_filled", 0, 1e15));
  info.hasImage = manifest.contains("image") && manifest["image"] == true;
  if (manifest.contains("scenery")) info.scenery = sceneryOf(manifest["scenery"], read);
  if (posts.latitude(posts.rows - 1) > 90 + PostLimits::kPastPole)
    findings.push_back(
        wrong(file, "grid", "rows up to latitude 90", numberText(posts.latitude(posts.rows - 1), 9)));
  if (!findings.empty()) return findings;

  const bool old = version == 1;
  Files files{folder, manifest.value("files", Json::object())};
  files.bytes = text->size();
  Contents contents{info, posts, {}, {}, {}, CellSlopes(TerrainIndex{}), {}, {}, {}, {}, {}};
  const auto lowest = static_cast<float>(info.lowest.value()),
             highest = static_cast<float>(info.highest.value());
  contents.heights =
      files.rows(kHeightsName, old ? nullptr : kHeightSumsName, std::size_t{posts.columns} * sizeof(float),
                 posts.rows, [lowest, highest](std::span<const std::byte> bytes) {
                   const auto* h = reinterpret_cast<const float*>(bytes.data());
                   const std::size_t count = bytes.size() / sizeof(float);
                   std::size_t inside = 0;
                   for (std::size_t i = 0; i < count; ++i) inside += h[i] >= lowest && h[i] <= highest;
                   return inside == count;
                 });
  // This comes before anything else is allocated by what the manifest claims.
  if (!contents.heights) return files.findings;
  // Its contents are compared when somebody asks for them (readPostSources).
  files.openListed(kSourcesName);
  // A bake that was given too little memory for them left the tiles out.
  if (old ||
      (posts.size() <= kMostTiledPosts && files.entries.is_object() && files.entries.contains(kNodesName))) {
    readNodes(files, contents);
    if (info.hasImage)
      contents.image = files.rows(kImageName, old ? nullptr : kImageSumsName, std::size_t{posts.columns} * 4,
                                  posts.rows, {});
  }
  if (manifest.contains("static_lod")) {
    contents.staticLod = readTrees(folder / kStaticLodName, manifest["static_lod"], posts, files.findings);
    std::error_code error;
    const std::uint64_t size = fs::file_size(folder / kStaticLodName, error);
    files.bytes += error ? 0 : size;
  }
  if (files.entries.is_object() && files.entries.contains(kObjectsName)) {
    contents.objects =
        readListedObjects(folder / kObjectsName, files.entries[kObjectsName], posts, files.findings);
    std::error_code error;
    const std::uint64_t size = fs::file_size(folder / kObjectsName, error);
    files.bytes += error ? 0 : size;
  }
  if (!old) {
    if (const auto pages = files.pages(kPatchesName)) {
      auto patches = openPatches(pages, folder / kPatchesName, posts);
      files.findings.insert(files.findings.end(), patches.findings().begin(), patches.findings().end());
      if (patches) contents.patches = *patches;
      contents.pageFiles.push_back(pages);
    }
    if (const auto pages = files.pages(kGroundName)) {
      auto ground = openGround(pages, folder / kGroundName, posts);
      files.findings.insert(files.findings.end(), ground.findings().begin(), ground.findings().end());
      if (ground) contents.ground = *ground;
      contents.pageFiles.push_back(pages);
    }
  }
  if (!files.findings.empty()) return files.findings;
  contents.info.bytes = files.bytes;
  return contents;
}

}  // namespace trimtab::terrain
