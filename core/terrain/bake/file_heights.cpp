#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "heights.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/grid/file_at.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

Result<std::unique_ptr<FileHeights>> FileHeights::open(const WorkFolder& work, const BakedHeights& heights) {
  const fs::path file = work.database() / kHeightsName, bits = work.path() / kVoidsName;
  const int handle = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) return Finding{Severity::error, file.string(), "", "a readable file", std::strerror(errno)};
  int voids = -1;
  if (heights.voids + heights.outside > 0) {
    voids = ::open(bits.c_str(), O_RDONLY | O_CLOEXEC);
    if (voids < 0) {
      ::close(handle);
      return Finding{Severity::error, bits.string(), "", "a readable file", std::strerror(errno)};
    }
  }
  return std::unique_ptr<FileHeights>(new FileHeights(heights.posts, handle, voids));
}

FileHeights::~FileHeights() {
  ::close(file_);
  if (voids_ >= 0) ::close(voids_);
}

void FileHeights::read(const PostWindow& window, std::uint32_t stride, std::span<float> heights) const {
  thread_local std::vector<float> row;
  float* out = heights.data();
  const std::uint32_t across = strided(window.columns, stride);
  for (std::uint32_t r = 0; r < window.rows; r += stride, out += across) {
    const std::uint64_t at = (std::uint64_t{window.row + r} * posts_.columns + window.column) * sizeof(float);
    if (stride > 1) row.resize(window.columns);
    float* to = stride > 1 ? row.data() : out;
    if (!readAt(file_, at, to, window.columns * sizeof(float))) {
      failed_ = true;
      std::fill_n(to, window.columns, 0.0f);
    }
    if (stride > 1)
      for (std::uint32_t c = 0; c < across; ++c) out[c] = row[std::size_t{c} * stride];
  }
}

void FileHeights::readVoids(const PostWindow& window, std::uint32_t stride,
                            std::span<std::uint8_t> voids) const {
  if (voids_ < 0) {
    std::fill(voids.begin(), voids.end(), std::uint8_t{0});
    return;
  }
  thread_local std::vector<std::uint8_t> row;
  const std::size_t rowBytes = (posts_.columns + 7) / 8;
  const std::size_t from = window.column / 8, to = (std::size_t{window.column} + window.columns + 7) / 8;
  row.resize(to - from);
  std::uint8_t* out = voids.data();
  for (std::uint32_t r = 0; r < window.rows; r += stride) {
    if (!readAt(voids_, (window.row + r) * std::uint64_t{rowBytes} + from, row.data(), row.size())) {
      failed_ = true;
      std::fill(row.begin(), row.end(), std::uint8_t{0});
    }
    for (std::uint32_t c = 0; c < window.columns; c += stride) {
      const std::size_t bit = window.column + c - from * 8;
      *out++ = row[bit / 8] >> (bit % 8) & 1;
    }
  }
}

}  // namespace trimtab::terrain
