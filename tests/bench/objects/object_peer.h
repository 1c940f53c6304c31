#pragma once

#include <memory>

#include "trimtab/culling/cut_rule.h"
#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/terrain/format/object_terrain.h"

namespace trimtab::bench {

/// Plain OpenSceneGraph over the same objects: a MatrixTransform with an osg::LOD for each instance, grouped
/// by our cells, whose ranges are the distances at which our rule exchanges levels. Its shader computes the
/// same light and haze. The context must be current for all of its life.
class ObjectPeer {
 public:
  ObjectPeer(const terrain::ObjectTerrain& objects, const CutRule& rule, int widthPx, int heightPx);
  ~ObjectPeer();
  ObjectPeer(const ObjectPeer&) = delete;
  ObjectPeer& operator=(const ObjectPeer&) = delete;

  struct Frame {
    double cullMs = 0, frameMs = 0;  ///< the frame with its cull traversal, until GL has drawn it
    double frameProcessorMs = 0;     ///< of all threads, in the same
    std::size_t drawables = 0;
  };
  Frame draw(const EyePose& eye, const ViewShape& view);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::bench
