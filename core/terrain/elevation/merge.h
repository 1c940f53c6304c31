#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "file.h"

/// Blends the heights of several files at the same posts to one surface.
namespace trimtab::terrain {

/// Rows that are read and merged at a time, and the posts over which one file is blended into another.
inline constexpr std::uint32_t kChunkRows = 32;
inline constexpr std::uint32_t kGiveWay = 32;
static_assert(kGiveWay <= kChunkRows);

/// Holds what one file has in a chunk.
struct ElevationLayer {
  std::size_t file = 0;  ///< index; a lower one has precedence
  std::size_t name = 0;  ///< equal for a file and its copy a turn of the earth away: they have no border
  std::uint32_t firstColumn = 0, columns = 0;
  std::vector<float> heights;  ///< kChunkRows rows
  std::vector<Continued> continued;

  bool has(std::uint32_t row, std::uint32_t column) const;
};

struct ElevationChunk {
  std::uint32_t columns = 0;
  /// Columns at either end that only the blending of their neighbours needs; they are not output.
  std::uint32_t margin = 0;
  std::vector<ElevationLayer> layers;  ///< in order of precedence
  std::vector<std::uint8_t> reached;   ///< by any file's posts or outline, kChunkRows rows
  std::vector<std::uint8_t> covered;   ///< how many have a height, at most 255

  void count();
  bool counts(std::size_t post) const { return post % columns - margin < columns - 2 * margin; }
};

/// ElevationLayer::file of posts that have no height.
inline constexpr std::uint32_t kNoFile = std::numeric_limits<std::uint32_t>::max();

/// Computes the heights of a chunk's posts, NaN where no file has one, and `from`, the file that gave each
/// height or most of it. `below` and `above` are the adjacent chunks, null at the ends of the grid.
void mergeChunk(const ElevationChunk* below, const ElevationChunk& chunk, const ElevationChunk* above,
                std::span<float> heights, std::span<std::uint32_t> from);

}  // namespace trimtab::terrain
