#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "trimtab/terrain/scenery/scenery.h"

/// A tile is read or refused with reasons; one that is read points nowhere but into its own arrays.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  std::string_view bytes(reinterpret_cast<const char*>(data), size);
  Result<std::string> unzipped{std::string()};
  if (size > 2 && data[0] == 0x1f && data[1] == 0x8b) {
    unzipped = terrain::gunzip(bytes, "fuzz");
    if (!unzipped && unzipped.findings().empty()) std::abort();
    if (!unzipped) return 0;
    bytes = *unzipped;
  }
  const auto mesh = terrain::parseBtg(bytes, "fuzz", true);
  if (!mesh && mesh.findings().empty()) std::abort();
  if (!mesh) return 0;
  if (mesh->trianglesInFile != mesh->degenerate + mesh->triangles.size()) std::abort();
  if (!mesh->texture.empty() && mesh->texture.size() != mesh->triangles.size()) std::abort();
  for (const auto& t : mesh->triangles)
    for (const std::uint32_t v : t.vertex)
      if (v >= mesh->vertices.size() || t.material >= mesh->materials.size()) std::abort();
  return 0;
}
