#include "trimtab/terrain/store.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>

#include "trimtab/terrain/post_geometry.h"
#include "trimtab/terrain/static_lod.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

constexpr std::uint32_t kMostPosts = 1u << 20;  ///< a side
constexpr std::size_t kNodeFloats = 8;

template <class T>
std::string_view bytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

Finding wrong(const fs::path& file, std::string key, std::string expected, std::string found) {
  return {Severity::error, file.string(), std::move(key), std::move(expected), std::move(found)};
}

std::vector<float> nodeFloats(const TerrainIndex& index) {
  std::vector<float> all;
  all.reserve(index.size() * kNodeFloats);
  for (std::size_t i = 0; i < index.size(); ++i) {
    const Box& b = index.bounds[i];
    for (const float f : {b.minX, b.minY, b.minZ, b.maxX, b.maxY, b.maxZ, index.errorM[i], index.slopeMax[i]})
      all.push_back(f);
  }
  return all;
}

/// Where the manifest's own checksum stands: it is over every byte but these.
std::size_t checksumPlace(const std::string& text) {
  constexpr std::string_view kKey = "\"checksum\": \"";
  const std::size_t at = text.rfind(kKey);
  return at == std::string::npos || at + kKey.size() + 16 > text.size() ? std::string::npos
                                                                        : at + kKey.size();
}
std::string manifestChecksum(const std::string& text, std::size_t place) {
  return hexadecimal(checksum(text.substr(0, place) + text.substr(place + 16)));
}

Result<std::string> readWhole(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return wrong(file, "", "a readable file", std::strerror(errno));
  std::string text{std::istreambuf_iterator<char>(in), {}};
  return text;
}

/// Reads a file of the manifest straight into an array, and checks it.
template <class T>
void readArray(const fs::path& folder, const char* name, const Json& files, std::size_t count,
               std::vector<T>& values, std::uint64_t& total, Findings& findings) {
  const fs::path file = folder / name;
  const std::uint64_t expected = std::uint64_t{count} * sizeof(T);
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (error) {
    findings.push_back(wrong(file, "", std::to_string(expected) + " bytes", error.message()));
    return;
  }
  if (size != expected) {
    findings.push_back(
        wrong(file, "size", std::to_string(expected) + " bytes", std::to_string(size) + " bytes"));
    return;
  }
  values.resize(count);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(expected));
  if (!in) {
    findings.push_back(wrong(file, "", "a readable file", std::strerror(errno)));
    return;
  }
  const Json entry = files.value(name, Json::object());
  const std::string wanted = entry.is_object() && entry.contains("fnv64") && entry["fnv64"].is_string()
                                 ? entry["fnv64"].get<std::string>()
                                 : "";
  const std::string found = hexadecimal(checksum(bytesOf(values)));
  if (found != wanted)
    findings.push_back(wrong(file, "checksum", wanted.empty() ? "one in the manifest" : wanted, found));
  total += size;
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

/// The trees, if they are those of this manifest's terrain.
std::shared_ptr<const StaticLodTerrain> readTrees(const fs::path& file, const Json& json,
                                                  const PostGrid& posts, Findings& findings) {
  const auto trees = readStaticLod(file);
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

}  // namespace

std::uint64_t checksum(std::string_view bytes) {
  constexpr std::uint64_t kPrime = 0x100000001b3u;
  std::array<std::uint64_t, 4> lane{0xcbf29ce484222325u, 0x84222325cbf29ce4u, 0x9ce484222325cbf2u,
                                    0x2325cbf29ce48422u};
  std::size_t at = 0;
  for (; at + 32 <= bytes.size(); at += 32)
    for (std::size_t k = 0; k < 4; ++k) {
      std::uint64_t word;
      std::memcpy(&word, bytes.data() + at + 8 * k, 8);
      lane[k] = (lane[k] ^ word) * kPrime;
    }
  for (std::size_t k = 0; at < bytes.size(); at += 8, ++k) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min<std::size_t>(8, bytes.size() - at));
    lane[k] = (lane[k] ^ word) * kPrime;
  }
  std::uint64_t sum = bytes.size();
  for (std::uint64_t value : lane) {
    value ^= value >> 32;
    sum = (sum ^ value) * kPrime;
    sum = std::rotl(sum, 29);
  }
  return sum ^ (sum >> 31);
}

std::string hexadecimal(std::uint64_t value) {
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; value >>= 4) text[i] = "0123456789abcdef"[value & 15];
  return text;
}

Result<Done> writeContents(const fs::path& folder, const Contents& contents) {
  Json files = Json::object();
  Findings findings;
  const auto put = [&](const char* name, std::string_view bytes) {
    std::ofstream out(folder / name, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out)
      findings.push_back(wrong(folder / name, "", "room to write " + std::to_string(bytes.size()) + " bytes",
                               std::strerror(errno)));
    files[name] = {{"bytes", bytes.size()}, {"fnv64", hexadecimal(checksum(bytes))}};
  };
  put("heights.f32", bytesOf(contents.grid.heights));
  put("nodes.f32", bytesOf(nodeFloats(contents.index)));
  put("slopes.u8", bytesOf(contents.slopes.cells));
  if (!contents.grid.image.empty()) put("image.rgba", bytesOf(contents.grid.image));
  if (contents.staticLod) {
    const auto written = writeStaticLod(folder / kStaticLodName, *contents.staticLod);
    findings.insert(findings.end(), written.findings().begin(), written.findings().end());
    std::error_code error;
    files[kStaticLodName] = {{"bytes", fs::file_size(folder / kStaticLodName, error)}};
  }

  const PostGrid& posts = contents.grid.posts;
  Json manifest;
  manifest["format"] = "trimtab-terrain";
  manifest["version"] = kFormatVersion;
  manifest["name"] = contents.info.name;
  manifest["source"] = contents.info.source;
  manifest["grid"] = {{"west_deg", posts.west},
                      {"south_deg", posts.south},
                      {"step_longitude_deg", posts.stepLongitude},
                      {"step_latitude_deg", posts.stepLatitude},
                      {"columns", posts.columns},
                      {"rows", posts.rows}};
  manifest["lowest_m"] = contents.info.lowest.value();
  manifest["highest_m"] = contents.info.highest.value();
  manifest["voids_filled"] = contents.info.voidsFilled;
  manifest["image"] = !contents.grid.image.empty();
  if (const auto& scenery = contents.info.scenery)
    manifest["scenery"] = {{"tiles", scenery->tiles},
                           {"airports", scenery->airports},
                           {"triangles_in_file", scenery->trianglesInFile},
                           {"degenerate", scenery->degenerate},
                           {"triangles", scenery->triangles},
                           {"missing", scenery->missing}};
  if (contents.staticLod)
    manifest["static_lod"] = {{"triangles_per_node", contents.staticLod->trianglesPerNode}};
  manifest["files"] = files;
  manifest["checksum"] = std::string(16, '0');
  std::string text = manifest.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
  const std::size_t place = checksumPlace(text);
  text.replace(place, 16, manifestChecksum(text, place));
  put(kManifestName, text);
  if (!findings.empty()) return findings;
  return Done{};
}

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
  if (!manifest.contains("version") || manifest["version"] != kFormatVersion)
    return wrong(file, "version", std::to_string(kFormatVersion) + " (bake the sources again)",
                 manifest.contains("version") ? manifest["version"].dump() : "nothing");
  const std::size_t place = checksumPlace(*text);
  if (place == std::string::npos) return wrong(file, "checksum", "16 hexadecimal digits", "nothing");
  if (const std::string sum = manifestChecksum(*text, place); text->substr(place, 16) != sum)
    return wrong(file, "checksum", text->substr(place, 16), sum);

  Findings findings;
  const Reader read{file, findings};
  const Json grid = manifest.value("grid", Json::object());
  PostGrid posts;
  posts.west = read.number(grid, "west_deg", -540, 540);
  posts.south = read.number(grid, "south_deg", -90, 90);
  posts.stepLongitude = read.number(grid, "step_longitude_deg", 1e-9, 180);
  posts.stepLatitude = read.number(grid, "step_latitude_deg", 1e-9, 90);
  posts.columns = static_cast<std::uint32_t>(read.number(grid, "columns", 2, kMostPosts));
  posts.rows = static_cast<std::uint32_t>(read.number(grid, "rows", 2, kMostPosts));
  TerrainInfo info;
  info.name = read.text(manifest, "name");
  info.source = read.text(manifest, "source");
  info.checksum = text->substr(place, 16);
  info.lowest = Metres{read.number(manifest, "lowest_m", -20000, 20000)};
  info.highest = Metres{read.number(manifest, "highest_m", -20000, 20000)};
  info.voidsFilled = static_cast<std::uint64_t>(read.number(manifest, "voids_filled", 0, 1e15));
  info.hasImage = manifest.contains("image") && manifest["image"] == true;
  if (manifest.contains("scenery")) info.scenery = sceneryOf(manifest["scenery"], read);
  if (posts.latitude(posts.rows - 1) > 90 + 1e-6)
    findings.push_back(
        wrong(file, "grid", "rows up to latitude 90", std::to_string(posts.latitude(posts.rows - 1))));
  if (!findings.empty()) return findings;
  const Json files = manifest.value("files", Json::object());
  // Before anything is allocated by what the manifest claims.
  std::error_code error;
  if (const auto size = fs::file_size(folder / "heights.f32", error);
      error || size != posts.size() * sizeof(float))
    return wrong(folder / "heights.f32", "size", std::to_string(posts.size() * sizeof(float)) + " bytes",
                 error ? error.message() : std::to_string(size) + " bytes");

  TerrainIndex index = makeLevels(posts);
  CellSlopes slopes(index);
  Contents contents{info, {posts, {}, 0, {}}, std::move(index), std::move(slopes), {}};
  std::uint64_t bytes = text->size();
  std::vector<float> nodes;
  readArray(folder, "heights.f32", files, posts.size(), contents.grid.heights, bytes, findings);
  readArray(folder, "nodes.f32", files, contents.index.size() * kNodeFloats, nodes, bytes, findings);
  readArray(folder, "slopes.u8", files, contents.slopes.cells.size(), contents.slopes.cells, bytes, findings);
  if (info.hasImage)
    readArray(folder, "image.rgba", files, posts.size() * 4, contents.grid.image, bytes, findings);
  if (manifest.contains("static_lod")) {
    contents.staticLod = readTrees(folder / kStaticLodName, manifest["static_lod"], posts, findings);
    bytes += fs::file_size(folder / kStaticLodName, error);
  }
  if (!findings.empty()) return findings;
  for (std::size_t i = 0; i < contents.index.size(); ++i) {
    const std::span<const float> n(&nodes[i * kNodeFloats], kNodeFloats);
    contents.index.bounds[i] = {n[0], n[1], n[2], n[3], n[4], n[5]};
    contents.index.errorM[i] = n[6];
    contents.index.slopeMax[i] = n[7];
  }
  contents.info.bytes = bytes;
  return contents;
}

}  // namespace trimtab::terrain
