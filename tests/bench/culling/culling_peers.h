#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/scene/gl/multi_draw.h"
#include "trimtab/culling/select.h"

/// OpenSceneGraph's own ways of the same work, run as OSG runs them.
namespace trimtab::bench {

/// The two tests of a box that OSG has.
class OsgBoxTests {
 public:
  OsgBoxTests(const EyePose& eye, const ViewShape& view);
  ~OsgBoxTests();
  OsgBoxTests(const OsgBoxTests&) = delete;
  OsgBoxTests& operator=(const OsgBoxTests&) = delete;
  /// How many boxes each keeps.
  std::size_t cullingSet(std::span<const Box> boxes);
  std::size_t polytope(std::span<const Box> boxes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A quadtree of groups over the finest tiles of an index, one drawable a tile.
class OsgQuadtree {
 public:
  explicit OsgQuadtree(const TerrainIndex& index);
  ~OsgQuadtree();
  OsgQuadtree(const OsgQuadtree&) = delete;
  OsgQuadtree& operator=(const OsgQuadtree&) = delete;
  /// One cull traversal; how many tiles it keeps.
  std::size_t cull(const EyePose& eye, const ViewShape& view);
  /// Those tiles of the last traversal, by node.
  std::vector<std::uint32_t> kept() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// How tiles of one triangle are submitted.
struct Submission {
  std::optional<scene::DrawWay> way = {};  ///< none: an osg::Geometry a tile
  bool anew = false;                       ///< another list of tiles each frame
};
/// Milliseconds that OSG's draw traversal takes to submit `tiles` such tiles. Needs the context current; the
/// least of `frames`.
double submitMilliseconds(int tiles, Submission submission, unsigned framebuffer, int frames);

}  // namespace trimtab::bench
