#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>

#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/format/store.h"

/// A file of static trees, its checksum made right so that its lies are believed: refused with reasons, or
/// its nodes and triangles lead nowhere but into its own arrays.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  constexpr std::size_t kHeader = 28;
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size >= kHeader) {
    const std::uint64_t body = size - kHeader,
                        sum = terrain::checksum(std::string_view(bytes).substr(kHeader));
    std::memcpy(&bytes[12], &body, 8);
    std::memcpy(&bytes[20], &sum, 8);
  }
  const int file = ::memfd_create("trees", 0);
  if (::write(file, bytes.data(), size) != static_cast<ssize_t>(size)) std::abort();
  const auto trees = terrain::readStaticLod("/proc/self/fd/" + std::to_string(file));
  ::close(file);
  if (!trees) {
    if (trees.findings().empty()) std::abort();
    return 0;
  }
  for (const terrain::StaticLodTile& tile : (*trees)->tiles) {
    for (const std::uint32_t vertex : tile.indices)
      if (vertex >= tile.vertices.size()) std::abort();
    for (const std::uint16_t material : tile.material)
      if (material >= (*trees)->materials.size()) std::abort();
    if (tile.material.size() * 3 != tile.indices.size()) std::abort();
  }
  if ((*trees)->ranges.size() != (*trees)->index.size()) std::abort();
  return 0;
}
