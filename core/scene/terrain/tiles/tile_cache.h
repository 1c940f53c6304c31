#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/scene/gl/multi_draw.h"
#include "core/scene/occlusion/occluder.h"
#include "core/scene/surface/tile_indices.h"
#include "trimtab/culling/select.h"
#include "trimtab/scene/built_ahead.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// Keeps tiles' vertices on the GPU: slots of one buffer, filled on first use; the slot that was unused for
/// longest is given up first. From the second frame on it has room for all tiles of the terrain, or for 89 MB
/// of them. Shaders read where a slot's tile lies from a buffer texture by gl_VertexID, so a frame uploads
/// nothing per tile.
///
/// All calls need the context current.
class TileCache {
 public:
  static constexpr std::uint32_t kNoSlot = 0xffffffffu;

  TileCache();
  ~TileCache();
  TileCache(const TileCache&) = delete;
  TileCache& operator=(const TileCache&) = delete;

  /// Forgets all tiles.
  void setDatabase(std::shared_ptr<const terrain::Database> database);
  /// Makes sure that the tiles have slots: builds those that miss one, or all of them with `anew`, and
  /// returns how many were built. Without memory for more, the slots that were unused for longest are given
  /// up, and tiles beyond that have none.
  std::size_t prepare(std::span<const TileDraw> tiles, bool anew = false);

  /// Builds tiles that miss a slot, in order, until `deadline`, for coming frames.
  BuiltAhead buildAhead(std::span<const std::uint32_t> nodes, std::chrono::steady_clock::time_point deadline);

  /// Draws tiles in order; those without a slot are skipped. The program in use reads attributes 0 position,
  /// 1 normal, 2 slope, 3 colour.
  void draw(std::span<const TileDraw> tiles);
  /// Draws the tiles' occluder meshes: attribute 0 is OccluderVertex.
  void drawOccluders(std::span<const TileDraw> tiles);

  /// RGBA32I, two texels a slot: the tile's origin in units of 16 m and its node, and OccluderLimits as the
  /// bits of floats.
  unsigned slotTexture() const { return slotTexture_; }
  /// RGBA32F, 2 x kParts texels a slot: low and high corner of each part.
  unsigned partTexture() const { return partTexture_; }
  /// Sets the colours (RGBA8) that `tintTexture` has by slot; `colours` are in the order of `tiles`.
  void setTints(std::span<const TileDraw> tiles, std::span<const std::uint32_t> colours);
  unsigned tintTexture() const { return tintTexture_; }

  std::uint32_t slotOf(std::uint32_t node) const { return slotOfNode_[node]; }
  std::size_t bytes() const;

 private:
  struct Slot {
    std::uint32_t node = TerrainIndex::kNone;
    std::uint64_t lastUse = 0;
  };
  struct SlotData {
    std::int32_t origin[4];  ///< the fourth is the node
    OccluderLimits limits;
  };

  std::uint32_t takeSlot();
  void makeRoom();
  bool growTo(std::size_t after);
  void fill(std::uint32_t slot, std::uint32_t node);

  std::shared_ptr<const terrain::Database> database_;
  TileIndices indices_;
  std::vector<Slot> slots_;
  std::vector<SlotData> slotData_;
  std::vector<std::uint32_t> slotOfNode_;
  std::vector<std::uint32_t> tints_;
  MultiDraw surface_, occluders_;
  std::uint64_t places_ = 1;  ///< changes whenever a slot gets or loses a tile
  terrain::TileMesh mesh_;
  TileOccluder occluder_;
  std::uint64_t frame_ = 0;
  std::uint32_t used_ = 0;
  unsigned vertexArray_ = 0, vertexBuffer_ = 0, indexBuffer_ = 0;
  unsigned occluderArray_ = 0, occluderBuffer_ = 0, occluderIndexBuffer_ = 0;
  std::uint32_t occluderIndices_ = 0;
  unsigned slotBuffer_ = 0, slotTexture_ = 0, tintBuffer_ = 0, tintTexture_ = 0, partBuffer_ = 0,
           partTexture_ = 0;
};

}  // namespace trimtab::scene
