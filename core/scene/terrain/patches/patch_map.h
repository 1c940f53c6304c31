#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/scene/occlusion/map_culling.h"
#include "core/scene/surface/surfaces_in_use.h"
#include "patch_culling.h"
#include "trimtab/scene/data_extent.h"

namespace trimtab::scene {

/// A patch for the CPU's depth map: its own triangles, and walls down from its border, so that no ray slips
/// through where neighbours are lowered differently.
///
/// The patch alone shows how steep the drawn surface is near a vertex, by squares of `mesh.reach`. Nearer to
/// its border than that, the slopes of its neighbours in this cut count too.
struct PatchSurface {
  DepthMesh mesh;
  depth::Triangles triangles;
  std::uint8_t variant = 0;
  bool inside = false;                     ///< so far inside the data that it may hide others
  std::vector<float> slope;                ///< of the patch alone
  std::vector<std::uint32_t> border;       ///< vertices whose slope depends on neighbours
  float steepest = 0, borderSteepest = 0;  ///< of all, and within `reach` of the border; infinite: no graph
  float around = -1;                       ///< the neighbours' slope in mesh.slope
};

void makePatchSurface(const terrain::PatchMesh& mesh, int variant, PatchSurface& out);

/// The CPU's depth map over the patches of a cut. Needs no GL context.
class PatchMapCulling {
 public:
  /// Starts with another terrain, or with none if it is null.
  void setTerrain(std::shared_ptr<const terrain::Database> database);
  /// Tests the patches of `visible`, which are those of the cut in view that are not known to be hidden.
  /// Returns one flag per patch, in their order, as removeOccluded reads them. `cut` is a new number for
  /// each cut. PatchGround::refusal must not refuse the eye.
  std::span<const std::uint8_t> hidden(const PatchCulling& patches, std::uint64_t cut,
                                       std::span<const TileDraw> visible, const EyePose& eye,
                                       const MapView& view, SurfaceShare& share);
  /// Returns the last map as an image in greys.
  DistanceImage picture() const { return culling_.picture(); }

 private:
  const PatchSurface* surfaceOf(TileDraw patch) const;  ///< null if it is not made
  void make(const PatchCulling& patches, TileDraw patch);
  /// Raises slopes by those of neighbours. Returns whether all surfaces that can be made are there.
  bool takeInNeighbours(const PatchCulling& patches, Vec3 eye, SurfaceShare& share);

  DataExtent extent_;
  double metresEast_ = 1, metresNorth_ = 1;  ///< from post to post
  SurfacesInUse<PatchSurface> surfaces_;
  std::uint64_t cut_ = 0;
  bool known_ = false;  ///< all neighbours of that cut
  DepthMapCulling culling_;
  std::vector<DepthMapCulling::Item> items_;
  struct Place {
    float low, high;
    std::uint32_t patch;
  };
  std::vector<Place> places_;
};

}  // namespace trimtab::scene
