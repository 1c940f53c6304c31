#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/occlusion/occlusion_ground.h"
#include "core/scene/surface/surfaces_in_use.h"
#include "core/scene/terrain/box_lids.h"
#include "patch_culling.h"
#include "trimtab/scene/data_extent.h"

namespace trimtab::scene {

/// The terrain's patches as ground that hides and is hidden.
class PatchGround final : public OcclusionGround {
 public:
  /// `patches` must outlive it.
  explicit PatchGround(const PatchCulling& patches) : patches_(patches) {}
  /// Starts with another terrain, or with none if it is null.
  void setTerrain(std::shared_ptr<const terrain::Database> database);

  const LevelCut& cut() const override { return patches_.cut(); }
  const CutNumber& cutNumber() const override { return patches_.cutNumber(); }
  std::string refusal(const EyePose& eye, const ViewShape& view) override;
  std::size_t makeSurfaces(Vec3 eye) override;
  void fill(std::vector<HorizonTile>& tiles) override;
  SurfaceTree tree() const override { return SurfaceTree::of(patches_.index(), surfaceErrorM_); }
  bool mayOcclude(std::uint32_t node) override;
  bool replacementsStayNear(std::uint32_t node) const override;
  void forgetOthers() override {
    surfaces_.forgetOthers(cut());
    lids_.forgetOthers(cut());
  }
  bool isGraph() override;

 private:
  struct Surface {
    MeshRelief relief;
    std::uint8_t variant = 0;
    bool inside = false;  ///< so far inside the data that no ray to it leaves the data
    bool replacementsStayNear = false;
  };
  /// Returns the surface of a patch; null if it is not made.
  const Surface* surfaceOf(TileDraw patch) const;
  /// Returns the surface under the eye, and makes it if the patch's page is there; null otherwise. Leaves
  /// alone what `fill` gave away.
  const Surface* surfaceUnder(TileDraw patch);
  void make(const terrain::PatchMesh& mesh, TileDraw patch, Surface& surface);
  /// Reports whether the cone of a patch's normals proves that none of its triangles stands upright or hangs
  /// over.
  bool normalsRise(std::uint32_t node);

  const PatchCulling& patches_;
  DataExtent extent_;
  VariantTable<float> surfaceErrorM_;                 ///< what SurfaceTree reads
  std::uint32_t marginColumns_ = 0, marginRows_ = 0;  ///< posts beside a patch that `inside` needs
  SurfacesInUse<Surface> surfaces_;                   ///< some 10 KB each
  BoxLids lids_;
  struct Under {
    std::uint32_t node;
    std::unique_ptr<Surface> surface;
  };
  std::vector<Under> under_;
  std::optional<std::uint64_t> graphOf_;  ///< the last cut that was found to be a graph
  // Per patch: 0 unknown, 1 no, 2 yes.
  std::vector<std::uint8_t> inside_;       ///< of mayOcclude
  std::vector<std::uint8_t> normalsRise_;  ///< for all of its triangles, proven
  terrain::PostGrid posts_;
  std::vector<ReliefVertex> vertices_;
};

/// Fills `relief` with one variant of a patch, as a surface for the horizon.
void makeRelief(const terrain::PatchMesh& mesh, int variant, std::vector<ReliefVertex>& vertices,
                MeshRelief& relief);

}  // namespace trimtab::scene
