#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "file.h"

/// Heights of several files at the same posts, made one surface.
namespace trimtab::terrain {

/// Rows that are read and merged at a time, and the posts over which a file gives way to another.
inline constexpr std::uint32_t kChunkRows = 32;
inline constexpr std::uint32_t kGiveWay = 32;
static_assert(kGiveWay <= kChunkRows);

/// What one file has in a chunk.
struct ElevationLayer {
  std::size_t file = 0;  ///< by its say
  std::size_t name = 0;  ///< the same for a file and itself a turn of the earth away, which have no border
  std::uint32_t firstColumn = 0, columns = 0;
  std::vector<float> heights;  ///< kChunkRows rows
  std::vector<Continued> continued;

  bool has(std::uint32_t row, std::uint32_t column) const;
};

struct ElevationChunk {
  std::uint32_t columns = 0;
  /// Columns at either end that are there for their neighbours' sake and count for nobody.
  std::uint32_t margin = 0;
  std::vector<ElevationLayer> layers;  ///< the file with most say first
  std::vector<std::uint8_t> reached;   ///< by any file's posts or outline, kChunkRows rows
  std::vector<std::uint8_t> covered;   ///< how many have a height, at most 255

  void count();
  bool counts(std::size_t post) const { return post % columns - margin < columns - 2 * margin; }
};

/// Heights of a chunk's posts, NaN where none has one, and its part of what each file gave. Neighbours: null
/// where the grid ends.
void mergeChunk(const ElevationChunk* below, const ElevationChunk& chunk, const ElevationChunk* above,
                std::span<float> heights, std::span<std::uint64_t> given);

}  // namespace trimtab::terrain
