#include "trimtab/terrain/scenery_memory.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

#include "trimtab/terrain/scenery.h"
#include "trimtab/terrain/scenery_import.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

/// Measured: 214 MB for Cologne's 25 MB, 738 MB for the 111 MB of a degree of Kansai, posts apart.
constexpr double kProgram = 64e6, kByByte = 6.2, kByPost = 12;

/// gzip ends with the size of what it packed, where it was not cut off: tiles are packed to two fifths.
std::uint64_t unzippedSize(const fs::path& file) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (error) return 0;
  if (file.extension() != ".gz") return size;
  std::ifstream in(file, std::ios::binary);
  std::array<unsigned char, 4> end{};
  in.seekg(-4, std::ios::end);
  in.read(reinterpret_cast<char*>(end.data()), 4);
  std::uint64_t bytes = 0;
  for (std::size_t i = 4; in && i-- > 0;) bytes = bytes << 8 | end[i];
  return bytes >= size && bytes <= 20 * size ? bytes : 3 * size;
}

}  // namespace

std::uint64_t sceneryBakeBytes(std::span<const fs::path> files, std::optional<Metres> post) {
  double bytes = kProgram, west = 1e9, south = 1e9, east = -1e9, north = -1e9;
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    if (name.find(".btg") == std::string::npos) continue;
    bytes += kByByte * static_cast<double>(unzippedSize(file));
    long index = -1;
    std::from_chars(name.data(), name.data() + name.size(), index);
    const Bucket bucket = bucketOf(index);
    if (bucket.index < 0) continue;
    // On one side of the earth with the first.
    const double turn = west < 1e9 ? 360 * std::round((west - bucket.west.value()) / 360) : 0;
    west = std::min(west, bucket.west.value() + turn), east = std::max(east, bucket.east.value() + turn);
    south = std::min(south, bucket.south.value()), north = std::max(north, bucket.north.value());
  }
  if (west < east)
    if (const auto posts = postsOver(west, south, east, north, post))
      bytes += kByPost * static_cast<double>(posts->size());
  return static_cast<std::uint64_t>(bytes);
}

}  // namespace trimtab::terrain
