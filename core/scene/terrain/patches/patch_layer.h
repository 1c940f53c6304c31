#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/gl/mesh_pool.h"
#include "core/scene/gl/multi_draw.h"
#include "trimtab/terrain/format/patch_terrain.h"

namespace trimtab::scene {

/// Keeps the meshes of pages of patches on the GPU and draws them with one multi-draw. Shaders read where a
/// patch lies from a buffer texture by gl_VertexID, so a frame uploads nothing per patch.
///
/// All calls need the context current.
class PatchLayer {
 public:
  PatchLayer();
  ~PatchLayer();
  PatchLayer(const PatchLayer&) = delete;
  PatchLayer& operator=(const PatchLayer&) = delete;

  /// Forgets all pages. `index` must outlive their use; null for no terrain.
  void setTerrain(const PatchIndex* index);
  /// Makes room for pages with so many bytes of vertices and of indices, so that adding them moves nothing
  /// that is there, which would make a frame late. Without memory for that, the room stays as it is.
  void reserve(std::size_t vertexBytes, std::size_t indexBytes) { pool_.reserve(vertexBytes, indexBytes); }
  /// Adds a page. Returns false and leaves everything else as it was if there is no memory for it.
  bool add(const terrain::PatchPage& page);
  void drop(std::uint32_t page);
  bool has(std::uint32_t page) const { return !pages_[page].empty(); }

  /// Draws patches in order. The program in use reads attributes 0 position, 1 normal, 2 the post (column,
  /// row) in its square. Patches whose page is not there are left out.
  void draw(std::span<const TileDraw> patches);
  /// RGBA32I, two texels per block of kPatchBlock vertices: origin in units of 16 m and patch; first column
  /// and row of the square.
  unsigned slotTexture() const { return pool_.slotTexture(); }
  /// Sets the colours (RGBA8) that `tintTexture` has by block.
  void setTints(std::span<const TileDraw> patches, std::span<const std::uint32_t> colours);
  unsigned tintTexture() const { return tintTexture_; }

  /// Returns the bytes that a patch takes.
  static std::size_t bytesOf(std::size_t vertices, std::size_t indices);
  std::size_t bytes() const { return pool_.bytes(); }                  ///< of the pages that are there
  std::size_t reservedBytes() const { return pool_.reservedBytes(); }  ///< of the buffers

 private:
  struct Mesh {
    MeshPool::Place place;
    std::array<std::uint32_t, PatchIndex::kMostVariants + 1> firstIndex{};
  };
  void attach();
  const Mesh* meshOf(std::uint32_t patch) const;
  bool put(const terrain::PatchMesh& mesh, std::uint32_t patch, Mesh& kept);

  const PatchIndex* index_ = nullptr;
  std::vector<std::vector<Mesh>> pages_;  ///< the patches of each page; empty: not there
  MeshPool pool_;
  MultiDraw surface_;
  std::vector<std::uint32_t> tints_;
  std::uint64_t placesNumber_ = 1;  ///< changes whenever a page comes or goes
  unsigned vertexArray_ = 0, tintBuffer_ = 0, tintTexture_ = 0;
};

}  // namespace trimtab::scene
