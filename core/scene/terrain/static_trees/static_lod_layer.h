#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/scene/gl/mesh_pool.h"
#include "core/scene/gl/multi_draw.h"
#include "trimtab/culling/select.h"
#include "trimtab/scene/built_ahead.h"

namespace trimtab::terrain {
struct StaticLodTerrain;
}

namespace trimtab::scene {

/// The trees' meshes on the GPU: pages of tiles in two buffers with room to reuse, a tile's vertices and the
/// triangles of all its nodes together, uploaded when a frame first needs the tile and given up when others
/// need the room. Where a vertex's tile lies stands in a texture buffer by gl_VertexID, in units of 16 m, so
/// its vertices close with every other tile's to the bit (relative_position.glsl).
///
/// All calls need the context current. Nodes are those of the terrain's index; of one tile they stand
/// together.
class StaticLodLayer {
 public:
  /// Releases the tiles unused for longest once the meshes exceed `keptBytes`; a frame that needs more than
  /// that still gets all of its tiles.
  explicit StaticLodLayer(std::size_t keptBytes = std::size_t{64} << 20);
  ~StaticLodLayer();
  StaticLodLayer(const StaticLodLayer&) = delete;
  StaticLodLayer& operator=(const StaticLodLayer&) = delete;

  /// Forgets all meshes.
  void setTerrain(std::shared_ptr<const terrain::StaticLodTerrain> terrain);
  /// Uploads the tiles of the nodes that are not on the GPU yet, or all of them with `anew`. Returns the
  /// number of tiles uploaded. Nodes of a tile for which there is no memory are not drawn.
  std::size_t prepare(std::span<const TileDraw> nodes, bool anew = false);

  /// Uploads tiles of nodes in order until `deadline`, for coming frames, as far as there is room without
  /// giving up others.
  BuiltAhead buildAhead(std::span<const std::uint32_t> nodes, std::chrono::steady_clock::time_point deadline);

  /// Draws the nodes with one multi-draw, in order. The program in use reads attributes 0 position, 1 normal,
  /// 2 texture coordinates (0 where the terrain kept none), 3 colour.
  void draw(std::span<const TileDraw> nodes);
  /// Does the same with each node's number and colour (RGBA8; or none) as attributes 4 and 5.
  void drawNumbered(std::span<const TileDraw> nodes, std::span<const std::uint32_t> colours = {});
  /// Document E's image: faces light grey, edges red, locked edges black.
  void drawPicture(unsigned program, std::span<const TileDraw> nodes);

  /// RGBA32I: the origin of the tile that a block of vertices is of.
  unsigned slotTexture() const { return pool_.slotTexture(); }
  std::size_t bytes() const { return pool_.bytes(); }  ///< of the tiles that are there
  bool has(std::uint32_t tile) const { return places_[tile].blocks > 0; }

 private:
  struct Place : MeshPool::Place {
    std::uint64_t lastUse = 0;
  };
  /// A node's edges as pairs of indices: those that may change, then the locked ones.
  struct Edges {
    unsigned buffer = 0;
    int free = 0, locked = 0;  ///< indices
  };
  struct DrawData {
    std::uint32_t node, tint;
  };

  void drop(std::uint32_t tile);
  bool dropOldest();
  void makeRoom();
  std::size_t bytesOf(std::uint32_t tile) const;
  bool upload(std::uint32_t tile);
  void attach();
  const Place& placeOf(std::uint32_t node) const;
  void addCommands(MultiDraw& draw, std::span<const TileDraw> nodes);
  const Edges& edgesOf(std::uint32_t node);
  void drawEdges(std::span<const TileDraw> nodes, bool locked);

  std::size_t keptBytes_;
  std::shared_ptr<const terrain::StaticLodTerrain> terrain_;
  bool textured_ = false;      ///< the terrain has texture coordinates, which are attribute 2 then
  std::vector<Place> places_;  ///< one a tile
  std::vector<Edges> edges_;   ///< one a node; made on first use
  MeshPool pool_;
  std::uint64_t frame_ = 0, placesNumber_ = 1;
  MultiDraw surface_, numbered_;
  std::vector<DrawData> data_;
  unsigned array_ = 0, numberedArray_ = 0, edgeArray_ = 0;
  unsigned dataBuffer_ = 0;
};

}  // namespace trimtab::scene
