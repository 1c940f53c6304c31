#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/occlusion_ground.h"
#include "trimtab/scene/patch_culling.h"
#include "trimtab/scene/patch_map.h"
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
  SurfaceTree tree() const override { return SurfaceTree::of(patches_.index()); }
  bool mayOcclude(std::uint32_t node) override;
  bool isGraph() override;
  bool drawsMap() const override { return true; }
  std::span<const std::uint8_t> hiddenByMap(std::span<const TileDraw> visible, const EyePose& eye,
                                            const ViewShape& view, DepthMapSize size,
                                            double loweringScale) override {
    return map_.hidden(patches_, cutNumber().cut, visible, eye, {view, size, loweringScale});
  }
  Renderer::Grey mapPicture() const override { return map_.picture(); }

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
  PatchMapCulling map_;
  DataExtent extent_;
  std::uint32_t marginColumns_ = 0, marginRows_ = 0;  ///< posts that `inside` asks for
  SurfacesInUse<Surface> surfaces_;                   ///< some 10 KB each
  struct Under {
    std::uint32_t node;
    std::unique_ptr<Surface> surface;
  };
  std::vector<Under> under_;
  std::optional<std::uint64_t> graphOf_;  ///< the cut that `graph_` is of
  bool graph_ = false;
  std::vector<std::uint8_t> inside_;  ///< of mayOcclude: 0 is not known, 1 no, 2 yes
  Degrees west_, south_;
  double postLongitude_ = 1, postLatitude_ = 1;
  std::vector<ReliefVertex> vertices_;
  std::uint64_t reliefs_ = 0;
};

/// A patch's surface for the horizon: one of its variants.
void makeRelief(const terrain::PatchMesh& mesh, int variant, std::vector<ReliefVertex>& vertices,
                MeshRelief& relief);

}  // namespace trimtab::scene
