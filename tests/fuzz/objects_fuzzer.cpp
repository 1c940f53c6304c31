#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>

#include "trimtab/terrain/format/object_file.h"
#include "trimtab/terrain/format/store.h"

/// A file of objects, its checksum made right so that its lies are believed: refused with reasons, or whoever
/// walks its cells, instances, levels, meshes and lights stays within its arrays and ends.
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
  const int file = ::memfd_create("objects", 0);
  if (::write(file, bytes.data(), size) != static_cast<ssize_t>(size)) std::abort();
  const auto objects = terrain::readObjects("/proc/self/fd/" + std::to_string(file));
  ::close(file);
  if (!objects) {
    if (objects.findings().empty()) std::abort();
    return 0;
  }
  const ObjectIndex& index = (*objects)->index;
  std::uint64_t seen = 0;
  for (std::uint32_t cell = 0; cell < index.cells.size(); ++cell) {
    if (!index.cells[cell].isLeaf(cell)) continue;
    for (std::uint32_t i = 0; i < index.cells[cell].instances; ++i, ++seen) {
      const ObjectIndex::Model& model =
          index.models.at(index.instances.at(index.cells[cell].firstInstance + i).model);
      const terrain::ObjectMesh& mesh = (*objects)->meshes.at(model.firstLevel + model.levels - 1);
      for (std::uint32_t k = 0; k < mesh.indices; ++k) {
        const terrain::ObjectVertex& vertex =
            (*objects)->vertices.at(mesh.firstVertex + (*objects)->indices.at(mesh.firstIndex + k));
        if (vertex.texture != terrain::ObjectVertex::kNoTexture)
          static_cast<void>((*objects)->textures.at(vertex.texture));
      }
    }
  }
  if (seen != index.instances.size()) std::abort();
  const LightIndex& lights = (*objects)->lights;
  for (const LightIndex::Cell& cell : lights.cells)
    for (std::uint32_t i = 0; i < cell.count; ++i) static_cast<void>(lights.points.at(cell.first + i));
  return 0;
}
