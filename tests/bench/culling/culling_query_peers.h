#pragma once

#include <memory>

#include "trimtab/culling/select.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::bench {

/// The frame of the renderer's terrain and sky, by its shaders from its vertices, where the hardware says
/// what is hidden: OpenSceneGraph's way with a node a tile, or plain GL. In a context of its own with
/// standard depth.
class QueryPeers {
 public:
  enum class Way {
    none,  ///< all that is in the frustum
    node,  ///< osg::OcclusionQueryNode a tile, which knows what it saw some frames ago
    gl  ///< what was seen in the frame before, then a query for each other tile's box, then what that finds
  };

  QueryPeers(std::shared_ptr<const terrain::Database> database, int widthPx, int heightPx);
  ~QueryPeers();
  QueryPeers(const QueryPeers&) = delete;
  QueryPeers& operator=(const QueryPeers&) = delete;
  bool ready() const;

  /// The tiles of the frames to come; nothing is known of what is hidden. `heightM` above the ellipsoid.
  void begin(const LevelCut& cut, Vec3 up, double heightM);
  /// Milliseconds of a frame until its last pixel.
  double ms(Way way, const EyePose& eye, const ViewShape& view);
  /// Tiles that the last frame drew.
  std::size_t drawn() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::bench
