#include "trimtab/terrain/scenery/memory.h"

#include <array>
#include <fstream>

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

/// Measured: 214 MB for Cologne's 25 MB and 0.35 million triangles, 738 MB for the 111 MB and 2.2 million of
/// a degree of Kansai, posts apart.
constexpr double kProgram = 64e6, kByByte = 6.2;
constexpr std::uint64_t kByTriangle = 420;

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

bool isTile(const fs::path& file) {
  return file.filename().string().find(".btg") != std::string::npos;
}

}  // namespace

std::uint64_t sceneryBytes(std::span<const fs::path> files) {
  double bytes = kProgram;
  for (const fs::path& file : files)
    if (isTile(file)) bytes += kByByte * static_cast<double>(unzippedSize(file));
  return static_cast<std::uint64_t>(bytes);
}

std::uint64_t madeTilesBytes(std::uint64_t triangles) {
  return triangles * kByTriangle;
}

}  // namespace trimtab::terrain
