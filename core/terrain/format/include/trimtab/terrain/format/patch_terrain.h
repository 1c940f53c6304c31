#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "trimtab/frame/patch_index.h"
#include "trimtab/units/result.h"

/// The meshes of error-bounded levels, by page.
namespace trimtab::terrain {

/// As the renderer uploads it. Position: local frame, relative to the patch's origin, a multiple of 1/256 m;
/// a post is at the same place to the bit in all patches. `column` and `row`: the post, counted from the
/// patch's square (PatchMesh::firstColumn, firstRow); colours and normals are found by them.
struct PatchVertex {
  float x, y, z;
  std::int8_t normal[3];  ///< of the finest surface there, local frame, x 127
  std::uint8_t unused = 0;
  std::uint16_t column, row;
};
static_assert(sizeof(PatchVertex) == 20);

/// What a variant has in place of a triangle of the next finer one.
enum class Heir : std::uint8_t { none, same, other };

/// One patch: vertices for all of its variants, the border's first, and each variant's triangles,
/// anticlockwise from above.
struct PatchMesh {
  std::int32_t origin[3] = {};                  ///< multiples of 16 m in the local frame
  std::uint32_t firstColumn = 0, firstRow = 0;  ///< of the square that it lies in
  std::vector<PatchVertex> vertices;
  std::vector<std::uint16_t> indices;  ///< three a triangle, variant by variant from the finest
  /// Of each variant, and the size: for the one after the last, and any beyond.
  std::array<std::uint32_t, PatchIndex::kMostVariants + 1> firstIndex{};
  /// As built, one for each triangle of all variants but the coarsest; empty where it is not known. Triangles
  /// of a variant are in the order of those that they stand for, and what has none there comes last.
  std::vector<Heir> heirs;
};

/// What is known of a patch beyond what its selection needs; errors in metres.
struct PatchFacts {
  float lowestM = 0, highestM = 0;     ///< of the source posts under it, heights
  std::uint32_t bytes = 0;             ///< in its page
  std::uint32_t vertices = 0;          ///< of its mesh: with its triangles, bytes in memory
  std::uint32_t posts = 0, voids = 0;  ///< under it; of them filled
  // By variant, 0 where the index has none.
  std::array<float, PatchIndex::kMostVariants> rmsErrorM{};       ///< at the source posts
  std::array<float, PatchIndex::kMostVariants> bilinearErrorM{};  ///< largest, over the bilinear surface

  friend bool operator==(const PatchFacts&, const PatchFacts&) = default;
};

/// A page, decoded.
struct PatchPage {
  std::uint32_t page = 0;
  std::vector<PatchMesh> patches;  ///< in the index's order
  std::size_t bytes() const;       ///< of vertices and indices
};

/// Error-bounded levels, opened; safe to use by many threads.
class PatchTerrain {
 public:
  virtual ~PatchTerrain() = default;
  virtual const PatchIndex& index() const = 0;
  virtual const std::vector<PatchFacts>& facts() const = 0;  ///< one a patch
  /// Reads, checks and decodes; waits for the disk. Findings name file, page, expected and found.
  virtual Result<PatchPage> readPage(std::uint32_t page) const = 0;
  /// Of a page on disk.
  virtual std::uint64_t pageBytes(std::uint32_t page) const = 0;
};

}  // namespace trimtab::terrain
