#pragma once

#include <string>
#include <vector>

#include "trimtab/terrain/format/object_terrain.h"
#include "trimtab/terrain/objects/source_model.h"
#include "trimtab/units/result.h"

/// Turns a model of a file into levels whose error is known.
namespace trimtab::terrain {

/// One mesh of a model, without triangles that cannot be drawn, its vertices welded where they are the same.
struct BuiltLevel {
  SourceMesh mesh;
  /// No point of this mesh is farther from the first level than this, and no point of the first level is
  /// farther from this mesh: metres. It is too large by at most a fiftieth of itself or a thousandth of the
  /// model's radius, but for meshes so tangled that the search ends before (farthestFrom). The outlines that
  /// both draw are no farther apart either, from wherever they are seen. 0 for the first level, at least
  /// kLeastErrorM for others. It says nothing of colours and of holes in textures.
  float errorM = 0;
};
inline constexpr float kLeastErrorM = 0.001f;

struct BuiltModel {
  std::string name;
  std::vector<BuiltLevel> levels;       ///< finest first; errors rise, triangles fall; none: lights alone
  std::vector<ObjectTexture> textures;  ///< in the order of the source's
  std::vector<SourceLight> lights = {};
};

/// What a model may hold at most.
struct ModelLimits {
  static constexpr std::size_t kTriangles = 1000000;  ///< of one level: they take about a minute
  /// A level of fewer triangles gets no others but stand-ins.
  static constexpr std::size_t kSimplified = 24;
  /// A level that is made is kept if it has at most this share of the triangles of the one before.
  static constexpr double kFewer = 0.7;
};

/// Checks a model and makes its levels. Given levels are kept if they have fewer triangles than the one
/// before and a greater error, which is measured. A model of one level of more than ModelLimits::kSimplified
/// triangles is simplified by meshoptimizer (whose own error is no bound) to halves, quarters and so on, by
/// collapsing edges and by joining near vertices; vertices are welded where it stalls, last without their
/// texture. At the end come stand-ins of two to
/// twelve triangles in the model's average colour: boxes, a pyramid, a double pyramid, crossed cards. Of all
/// these, only levels with a greater error and at most ModelLimits::kFewer of the triangles of the one before
/// stay.
///
/// Triangles that cannot be drawn (not a number, no area, corners that are not there) are left out with a
/// warning, and so are lights that are not numbers or beyond ObjectLimits::kRadiusM. Refuses a model with
/// neither a light nor any other triangle, one with too many, and one that reaches farther than
/// ObjectLimits::kRadiusM. The same model gives the same result to the bit.
Result<BuiltModel> buildModel(const SourceModel& source);

}  // namespace trimtab::terrain
