#include "trimtab/terrain/format/store.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "manifest_checksum.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/format/object_file.h"
#include "trimtab/terrain/format/post_sources.h"

namespace trimtab::terrain {

namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

/// A folder is a database's own if its manifest begins so and its files have no other names.
bool holdsNothingElse(const std::filesystem::path& folder) {
  constexpr std::string_view kBegins = "{\n  \"format\": \"trimtab-terrain\"";
  std::error_code error;
  // A pipe would never give its first byte.
  if (!std::filesystem::is_regular_file(folder / kManifestName, error) ||
      !checkIsData(folder / kManifestName))
    return false;
  std::string begins(kBegins.size(), 0);
  std::ifstream(folder / kManifestName, std::ios::binary)
      .read(begins.data(), static_cast<std::streamsize>(begins.size()));
  if (begins != kBegins) return false;
  using Entries = std::filesystem::directory_iterator;
  for (auto entry = Entries(folder, error); !error && entry != Entries(); entry.increment(error)) {
    std::error_code unseen;
    if (!std::filesystem::is_regular_file(entry->symlink_status(unseen)) ||
        !isDatabaseFile(entry->path().filename().string()))
      return false;
  }
  return !error;
}

}  // namespace

bool isDatabaseFile(std::string_view name) {
  constexpr std::array<std::string_view, 13> kNames = {
      kManifestName, kHeightsName, kHeightSumsName, kImageName,     kImageSumsName, kNodesName,  kSlopesName,
      kConesName,    kPatchesName, kGroundName,     kStaticLodName, kSourcesName,   kObjectsName};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

bool mayReplace(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::file_status there = std::filesystem::symlink_status(folder, error);
  if (there.type() == std::filesystem::file_type::not_found) return true;
  return std::filesystem::is_directory(folder, error) &&
         (std::filesystem::is_empty(folder, error) || holdsNothingElse(folder)) && !error;
}

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

std::size_t manifestChecksumPlace(const std::string& text) {
  constexpr std::string_view kKey = "\"checksum\": \"";
  const std::size_t at = text.rfind(kKey);
  return at == std::string::npos || at + kKey.size() + 16 > text.size() ? std::string::npos
                                                                        : at + kKey.size();
}

std::string manifestChecksum(const std::string& text, std::size_t place) {
  return hexadecimal(checksum(text.substr(0, place) + text.substr(place + 16)));
}

std::vector<float> nodeNumbers(const TerrainIndex& index) {
  std::vector<float> all;
  all.reserve(index.size() * 8);
  for (std::size_t i = 0; i < index.size(); ++i) {
    const Box& b = index.bounds[i];
    for (const float f : {b.minX, b.minY, b.minZ, b.maxX, b.maxY, b.maxZ, index.errorM[i], index.slopeMax[i]})
      all.push_back(f);
  }
  return all;
}

Result<FileEntry> writeFile(const std::filesystem::path& folder, const std::string& name,
                            std::string_view bytes) {
  if (auto written = writeOwn(folder / name, bytes); !written) return written.findings();
  return FileEntry{name, bytes.size(), checksum(bytes)};
}

Result<Done> writeManifest(const std::filesystem::path& folder, const TerrainInfo& info,
                           const PostGrid& posts, const std::vector<FileEntry>& files,
                           std::optional<std::uint32_t> trianglesPerNode, const std::string& recipe) {
  Json manifest;
  manifest["format"] = "trimtab-terrain";
  manifest["version"] = kFormatVersion;
  manifest["name"] = info.name;
  manifest["source"] = info.source;
  manifest["recipe"] = Json::parse(recipe, nullptr, false);
  manifest["grid"] = {{"west_deg", posts.west},
                      {"south_deg", posts.south},
                      {"step_longitude_deg", posts.stepLongitude},
                      {"step_latitude_deg", posts.stepLatitude},
                      {"columns", posts.columns},
                      {"rows", posts.rows}};
  manifest["lowest_m"] = info.lowest.value();
  manifest["highest_m"] = info.highest.value();
  manifest["voids_filled"] = info.voidsFilled;
  manifest["image"] = info.hasImage;
  if (const auto& scenery = info.scenery)
    manifest["scenery"] = {{"tiles", scenery->tiles},
                           {"airports", scenery->airports},
                           {"triangles_in_file", scenery->trianglesInFile},
                           {"degenerate", scenery->degenerate},
                           {"triangles", scenery->triangles},
                           {"missing", scenery->missing}};
  if (trianglesPerNode) manifest["static_lod"] = {{"triangles_per_node", *trianglesPerNode}};
  manifest["files"] = Json::object();
  for (const FileEntry& file : files) {
    manifest["files"][file.name] = {{"bytes", file.bytes}};
    if (file.sum) manifest["files"][file.name]["fnv64"] = hexadecimal(*file.sum);
  }
  manifest["checksum"] = std::string(16, '0');
  std::string text = manifest.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
  const std::size_t place = manifestChecksumPlace(text);
  text.replace(place, 16, manifestChecksum(text, place));
  const auto written = writeFile(folder, kManifestName, text);
  if (!written) return written.findings();
  return Done{};
}

}  // namespace trimtab::terrain
