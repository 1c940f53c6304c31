#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "trimtab/frame/patch_index.h"
#include "trimtab/units/result.h"

/// The meshes of patches, by page.
namespace trimtab::terrain {

/// A vertex as the renderer uploads it. Its position is relative to the patch's origin in the local frame, in
/// multiples of 1/256 m; a post has the same place to the bit in all patches. `column` and `row` are those of
/// the post, counted from the patch's square (PatchMesh::firstColumn, firstRow); colours and normals are
/// found by them.
struct PatchVertex {
  float x, y, z;
  std::int8_t normal[3];  ///< 127 times the normal of the finest surface there, local frame
  std::uint8_t unused = 0;
  std::uint16_t column, row;
};
static_assert(sizeof(PatchVertex) == 20);

/// Says what a variant has where the next finer one has a triangle: nothing there, the same triangle (it is
/// inherited), or another one in its place.
enum class Inherited : std::uint8_t { none, same, other };

/// The meshes of one patch: vertices for all variants, the border's first, and each variant's triangles,
/// anticlockwise from above.
struct PatchMesh {
  std::int32_t origin[3] = {};                  ///< multiples of 16 m in the local frame
  std::uint32_t firstColumn = 0, firstRow = 0;  ///< of the square that it lies in
  std::vector<PatchVertex> vertices;
  std::vector<std::uint16_t> indices;  ///< three per triangle, variant by variant from the finest
  /// The first index of each variant; the number of indices for all beyond the last variant.
  std::array<std::uint32_t, PatchIndex::kMostVariants + 1> firstIndex{};
  /// One entry per triangle of all variants but the coarsest; empty if it is not known. The triangles of a
  /// variant have the order of the finer triangles that they replace; those that replace none come last.
  std::vector<Inherited> inherited;
};

/// Holds what is known about a patch and not needed for selecting it; errors in metres.
struct PatchFacts {
  float lowestM = 0, highestM = 0;     ///< heights of the source posts under it
  std::uint32_t bytes = 0;             ///< in its page
  std::uint32_t vertices = 0;          ///< of its meshes
  std::uint32_t posts = 0, voids = 0;  ///< under it; how many of them were filled
  // Per variant; 0 beyond the last.
  std::array<float, PatchIndex::kMostVariants> rmsErrorM{};       ///< at the source posts
  std::array<float, PatchIndex::kMostVariants> bilinearErrorM{};  ///< worst, against the bilinear surface

  friend bool operator==(const PatchFacts&, const PatchFacts&) = default;
};

/// A page that has been decoded.
struct PatchPage {
  std::uint32_t page = 0;
  std::vector<PatchMesh> patches;  ///< in the index's order
  std::size_t bytes() const;       ///< of vertices and indices
};

/// The patches of an opened database. All functions may be called from any thread.
class PatchTerrain {
 public:
  virtual ~PatchTerrain() = default;
  virtual const PatchIndex& index() const = 0;
  virtual const std::vector<PatchFacts>& facts() const = 0;  ///< one per patch
  /// Reads, checks and decodes a page, and waits for the disk. Findings name file, page, expected and found.
  virtual Result<PatchPage> readPage(std::uint32_t page) const = 0;
  /// Returns the size of a page on disk.
  virtual std::uint64_t pageBytes(std::uint32_t page) const = 0;
};

}  // namespace trimtab::terrain
