#pragma once

#include "trimtab/scene/ground_texture.h"
#include "trimtab/scene/patch_culling.h"
#include "trimtab/scene/patch_horizon.h"
#include "trimtab/scene/patch_layer.h"
#include "trimtab/scene/terrain_drawer.h"

namespace trimtab::scene {

/// The terrain as error-bounded patches, paged, in the ground's own colours and light.
class PatchDrawer final : public TerrainDrawer {
 public:
  void setTerrain(std::shared_ptr<const terrain::Database> database) override;
  void initialize() override;
  void release() override { gl_.reset(); }
  void plant(const Defects& defects) override;

  void prepare(FrameInProgress& frame) override;

  const std::vector<TileDraw>& cut() const override { return culling_.cut().tiles; }
  const VisibleSet& visible() const override { return culling_.visible(); }
  /// A picture of the last horizon, if one served.
  Renderer::Grey readDepthMap() const override;
  /// Pages of meshes and tiles of the ground.
  Findings failures() const;
  const Horizon* horizon() const override { return horizonView_ ? &horizon_.memory().horizon() : nullptr; }

 private:
  const std::vector<Box>& bounds() const override { return terrain_->index().bounds; }
  int levelOf(TileDraw patch) const override;
  /// They are: what is not on the GPU is in no cut.
  std::size_t upload(std::span<const TileDraw>, bool) override { return 0; }
  void drawNodes(unsigned program, std::span<const TileDraw> patches) override;
  void drawTinted(unsigned program, std::span<const TileDraw> patches,
                  std::span<const std::uint32_t> colours) override;
  void arrange(std::vector<TileDraw>& patches, Vec3 eye) const override;

  void setGl();
  /// By the horizon, whatever method is asked for: there is no depth map of patches. `refusal`: why nothing
  /// may be hidden.
  std::span<const std::uint8_t> findHidden(FrameInProgress& frame, const EyePose& eye,
                                           const std::string& refusal);
  void updateGround();

  struct Gl {
    PatchLayer layer;
    GroundTexture ground;
  };
  std::shared_ptr<const terrain::Database> database_;
  std::shared_ptr<const terrain::PatchTerrain> terrain_;
  PatchCulling culling_;
  PatchHorizon horizon_;
  Defects defects_;
  int subpixelBits_ = 4;
  /// That the horizon served in the last frame.
  struct HorizonView {
    EyePose eye;
    ViewShape view;
    DepthMapSize size;
  };
  std::optional<HorizonView> horizonView_;
  std::unique_ptr<Gl> gl_;
  struct Place {
    float distance;
    TileDraw patch;
  };
  mutable std::vector<Place> places_;
};

}  // namespace trimtab::scene
