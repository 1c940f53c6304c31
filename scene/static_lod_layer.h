#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/culling/select.h"

namespace trimtab::terrain {
struct StaticLodTerrain;
}

namespace trimtab::scene {

/// The trees' meshes on the GPU: a tile's vertices and the triangles of all its nodes in two buffers of their
/// own, uploaded when a frame first needs the tile. A tile's origin is a uniform, in units of 16 m, so its
/// vertices close with every other tile's to the bit (relativePosition in shaders.h).
///
/// All calls need the context current. Nodes are those of the terrain's index; of one tile they stand
/// together.
class StaticLodLayer {
 public:
  StaticLodLayer() = default;
  ~StaticLodLayer();
  StaticLodLayer(const StaticLodLayer&) = delete;
  StaticLodLayer& operator=(const StaticLodLayer&) = delete;

  /// Forgets all meshes.
  void setTerrain(std::shared_ptr<const terrain::StaticLodTerrain> terrain);
  /// Uploads the tiles that the nodes lie in, where that was not done yet, or all of them with `anew`.
  /// Returns how many were.
  std::size_t prepare(std::span<const TileDraw> nodes, bool anew = false);

  /// One multi-draw a tile. `program` is in use and reads attributes 0 position, 1 normal, 3 colour.
  void draw(unsigned program, std::span<const TileDraw> nodes);
  /// The same, node by node, each with its colour (RGBA8) as uniform `treeTint`.
  void drawTinted(unsigned program, std::span<const TileDraw> nodes, std::span<const std::uint32_t> colours);
  /// The same, node by node, each with its number as uniform `treeNode`.
  void drawNumbered(unsigned program, std::span<const TileDraw> nodes);
  /// Document E's picture: faces light grey, edges red, locked edges black.
  void drawPicture(unsigned program, std::span<const TileDraw> nodes);

  std::size_t bytes() const { return bytes_; }  ///< on the GPU

 private:
  struct Tile {
    unsigned vertexArray = 0, vertexBuffer = 0, indexBuffer = 0;
    unsigned edgeArray = 0;
  };
  /// A node's edges as pairs of indices: those that may change, then the locked ones.
  struct Edges {
    unsigned buffer = 0;
    int free = 0, locked = 0;  ///< indices
  };

  void clear();
  void drop(Tile& tile);
  void upload(std::uint32_t tile);
  const Edges& edgesOf(std::uint32_t node);
  /// Calls `draw` with each run of nodes of one tile, its origin set.
  template <class Draw>
  void eachTile(unsigned program, std::span<const TileDraw> nodes, const Draw& draw);

  std::shared_ptr<const terrain::StaticLodTerrain> terrain_;
  std::vector<Tile> tiles_;
  std::vector<Edges> edges_;  ///< one a node; made on first use
  std::vector<int> counts_;
  std::vector<const void*> offsets_;
  std::size_t bytes_ = 0;
};

}  // namespace trimtab::scene
