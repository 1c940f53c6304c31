#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/culling/select.h"
#include "trimtab/terrain/format/patch_terrain.h"

namespace trimtab::scene {

/// Patches' meshes on the GPU: pages in two buffers with room to reuse, drawn by one multi-draw. Where a
/// patch lies stands in a texture buffer that shaders read by gl_VertexID, so a frame uploads nothing per
/// patch.
///
/// All calls need the context current.
class PatchLayer {
 public:
  PatchLayer();
  ~PatchLayer();
  PatchLayer(const PatchLayer&) = delete;
  PatchLayer& operator=(const PatchLayer&) = delete;

  /// Forgets all pages; null: none.
  void setTerrain(const PatchIndex* index);
  /// Room for pages with so many bytes of vertices and of indices, so that adding them moves nothing that is
  /// there: what is moved makes a frame late. Where there is no memory for that,
  /// there is the room that there was.
  void reserve(std::size_t vertexBytes, std::size_t indexBytes);
  /// False where there is no memory for it: it is not there, and what was still is.
  bool add(const terrain::PatchPage& page);
  void drop(std::uint32_t page);
  bool has(std::uint32_t page) const;

  /// One multi-draw, in order: node is a patch, `coarser` its variant. Attributes 0 position, 1 normal, 2 the
  /// post (column, row) in its square. Patches whose page is not there are left out.
  void draw(std::span<const TileDraw> patches);
  /// RGBA32I, two texels a block of kBlock vertices: origin in units of 16 m and patch; first column and row
  /// of the square.
  static constexpr int kBlock = 32;
  unsigned slotTexture() const;
  /// RGBA8 a patch of the last `setTints`, by block.
  void setTints(std::span<const TileDraw> patches, std::span<const std::uint32_t> colours);
  unsigned tintTexture() const;

  /// What a patch takes.
  static std::size_t bytesOf(std::size_t vertices, std::size_t indices);
  std::size_t bytes() const;          ///< of the pages that are there
  std::size_t reservedBytes() const;  ///< of the buffers

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
