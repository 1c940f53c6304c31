#include <cpl_vsi.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "core/terrain/elevation/file.h"

/// A raster is read or refused with reasons; what is read is heights or voids.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab::terrain;
  std::vector<GByte> bytes(data, data + size);
  const char* const name = "/vsimem/fuzz";
  VSIFCloseL(VSIFileFromMemBuffer(name, bytes.data(), size, FALSE));
  auto file = ElevationFile::open(name, {}, {});
  if (!file && file.findings().empty()) std::abort();
  if (file && (*file)->placeOn((*file)->posts())) {
    const PostGrid& posts = (*file)->posts();
    const std::uint32_t rows = posts.rows < 8 ? posts.rows : 8;
    std::vector<float> heights(std::size_t{rows} * (*file)->columns());
    std::vector<std::uint8_t> reached(std::size_t{rows} * posts.columns);
    std::vector<Continued> continued;
    ElevationFile::Room room;
    const auto read = (*file)->read(0, rows, heights, reached, continued, room);
    if (!read && read.findings().empty()) std::abort();
    for (const float h : heights)
      if (!std::isnan(h) && !(std::abs(h) < 1e5f)) std::abort();
  }
  VSIUnlink(name);
  return 0;
}
