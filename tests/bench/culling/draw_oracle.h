#pragma once

#include <cstdint>
#include <memory>

namespace trimtab::bench {

/// Stands between the renderer and GL's multi-draw by base vertex. It sees which triangles own a pixel of a
/// picture, and lets only those of the same draws through that own one, or that share a block with one: what
/// no culling of triangles, of blocks or of whole meshes can beat.
///
/// The context is current for all of its life; there is one at a time, and scene::ForcedDrawWay base_vertex
/// while its pictures are drawn.
class DrawOracle {
 public:
  DrawOracle();
  ~DrawOracle();
  DrawOracle(const DrawOracle&) = delete;
  DrawOracle& operator=(const DrawOracle&) = delete;

  /// Before a picture of this size whose owners count from now on.
  void learn(int width, int height);
  /// Before any other picture: all is drawn.
  void letAll();
  /// Before a picture of the same draws as the one learnt from: a mesh is cut into squares of its extent in
  /// plan, so many along each side, all of whose triangles are drawn if one is an owner; 0: each for itself.
  void letOwners(int blocksAcross);
  /// Of the picture learnt from, and of them those that `letOwners` draws.
  std::size_t triangles() const, drawn(int blocksAcross) const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::bench
