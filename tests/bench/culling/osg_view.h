#pragma once

#include <osg/BoundingBox>
#include <osg/Matrixd>

#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/terrain_index.h"

/// Our views as OpenSceneGraph's matrices, for the peers that it draws and culls.
namespace trimtab::bench {

/// Standard depth, which osg::OcclusionQueryNode takes for granted.
inline osg::Matrixd projectionOf(const ViewShape& v, double farM) {
  const double n = v.nearM;
  return osg::Matrixd::frustum(v.left * n, v.right * n, v.bottom * n, v.top * n, n, farM);
}

inline osg::Matrixd rotationOf(const EyePose& eye) {
  osg::Matrixd m;
  for (int i = 0; i < 3; ++i) {
    const Vec3& row = eye.axes.row[static_cast<std::size_t>(i)];
    m(0, i) = row.x;
    m(1, i) = row.y;
    m(2, i) = row.z;
  }
  return m;
}

inline osg::Matrixd viewOf(const EyePose& eye) {
  const Vec3 p = eye.position;
  return osg::Matrixd::translate(-p.x, -p.y, -p.z) * rotationOf(eye);
}

inline osg::BoundingBox boundOf(const Box& b) {
  return {b.minX, b.minY, b.minZ, b.maxX, b.maxY, b.maxZ};
}

}  // namespace trimtab::bench
