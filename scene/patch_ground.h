#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/occlusion_ground.h"
#include "trimtab/scene/patch_culling.h"
#include "trimtab/scene/surfaces_in_use.h"

namespace trimtab::scene {

/// The terrain's patches as ground that hides and is hidden; keeps what it knows of patches while they are in
/// use.
class PatchGround final : public OcclusionGround {
 public:
  /// `patches` must live as long.
  explicit PatchGround(const PatchCulling& patches) : patches_(patches) {}
  /// Null: none.
  void setTerrain(std::shared_ptr<const terrain::Database> database);

  const LevelCut& cut() const override { return patches_.cut(); }
  const CutNumber& cutNumber() const override { return patches_.cutNumber(); }
  std::string refusal(const EyePose& eye, const ViewShape& view) override;
  void fill(std::vector<HorizonTile>& tiles) override;

  std::uint64_t reliefs() const { return reliefs_; }  ///< meshes that were looked at

 private:
  struct Surface {
    MeshRelief relief;
    std::uint8_t variant = 0;
    bool inside = false;  ///< so far from the data's edge that no way to it leads over the edge
  };
  /// Null where the patch's page is not there.
  const Surface* surfaceOf(TileDraw patch);
  /// The same for where the eye is over, which leaves alone what `fill` gave away.
  const Surface* surfaceUnder(TileDraw patch);
  void make(const terrain::PatchMesh& mesh, TileDraw patch, Surface& surface);

  const PatchCulling& patches_;
  DataExtent extent_;
  std::uint32_t marginColumns_ = 0, marginRows_ = 0;  ///< posts that `inside` asks for
  SurfacesInUse<Surface> surfaces_;                   ///< some 10 KB each
  struct Under {
    std::uint32_t node;
    std::unique_ptr<Surface> surface;
  };
  std::vector<Under> under_;
  std::vector<ReliefVertex> vertices_;
  std::uint64_t reliefs_ = 0;
};

/// A patch's surface for the horizon: one of its variants.
void makeRelief(const terrain::PatchMesh& mesh, int variant, std::vector<ReliefVertex>& vertices,
                MeshRelief& relief);

}  // namespace trimtab::scene
