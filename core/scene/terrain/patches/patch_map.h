#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/scene/occlusion/map_culling.h"
#include "core/scene/terrain/surfaces_in_use.h"
#include "patch_culling.h"
#include "trimtab/scene/data_extent.h"

namespace trimtab::scene {

/// A patch as drawn, for the CPU's depth map: its own triangles, and walls down from its border, so that no
/// ray slips through where neighbours are lowered differently.
///
/// How steep the drawn surface is near a vertex is known for the patch alone, by squares of `mesh.reach`.
/// Nearer its border than that, the neighbours' slopes count, whatever they are in this cut.
struct PatchSurface {
  DepthMesh mesh;
  depth::Triangles triangles;
  std::uint8_t variant = 0;
  bool inside = false;                     ///< so far from the data's edge that it may hide others
  std::vector<float> slope;                ///< as of the patch alone
  std::vector<std::uint32_t> border;       ///< vertices whose slope neighbours have a part in
  float steepest = 0, borderSteepest = 0;  ///< of all, and within `reach` of the border; infinite: no graph
  float around = -1;                       ///< of the neighbours, that mesh.slope has taken in
};

void makePatchSurface(const terrain::PatchMesh& mesh, int variant, PatchSurface& out);

/// The CPU's depth map over the patches of a cut. Needs no context.
class PatchMapCulling {
 public:
  /// Null: none.
  void setTerrain(std::shared_ptr<const terrain::Database> database);
  /// `visible`: those of the cut in view that are not known to be hidden. One each, in their order, as
  /// removeOccluded takes them. `cut`: another number for another cut. The eye must be one that
  /// PatchGround::refusal lets pass.
  std::span<const std::uint8_t> hidden(const PatchCulling& patches, std::uint64_t cut,
                                       std::span<const TileDraw> visible, const EyePose& eye,
                                       const MapView& view, SurfaceShare& share);
  /// The last map.
  Renderer::Grey picture() const { return culling_.picture(); }

 private:
  const PatchSurface* surfaceOf(TileDraw patch) const;  ///< null where it is not made
  void make(const PatchCulling& patches, TileDraw patch);
  /// Whether all that can be made is there.
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
