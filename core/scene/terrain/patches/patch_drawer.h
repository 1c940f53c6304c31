#pragma once

#include "core/scene/occlusion/occlusion_stage.h"
#include "core/scene/terrain/ground/ground_texture.h"
#include "core/scene/terrain/terrain_drawer.h"
#include "patch_culling.h"
#include "patch_ground.h"
#include "patch_layer.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::scene {

/// Draws the terrain as error-bounded patches, paged, in the ground's own colours and light.
class PatchDrawer final : public TerrainDrawer {
 public:
  void setTerrain(std::shared_ptr<const terrain::Database> database) override;
  void initialize() override;
  void release() override { gl_.reset(); }
  void plant(const Defects& defects) override;

  PreparedTerrain prepare(const FrameInProgress& frame) override;
  void finished(const FrameResult& result) override { occlusion_.finished(result); }

  const std::vector<TileDraw>& cut() const override { return culling_.cut().tiles; }
  const VisibleSet& visible() const override { return visible_; }
  DistanceImage readDepthMap() const override { return occlusion_.picture(); }
  /// Returns the pages of meshes and the tiles of the ground that could not be read.
  Findings failures() const;
  const Horizon* horizon() const override { return occlusion_.horizon(); }

 private:
  const std::vector<Box>& bounds() const override { return terrain_->index().bounds; }
  std::span<const NormalCone> cones() const override { return terrain_->index().cones; }
  int levelOf(TileDraw patch) const override;
  /// Does nothing: what is not on the GPU is in no cut.
  std::size_t upload(std::span<const TileDraw>, bool) override { return 0; }
  void drawNodes(unsigned program, std::span<const TileDraw> patches) override;
  void drawTinted(unsigned program, std::span<const TileDraw> patches,
                  std::span<const std::uint32_t> colours) override;

  void setGl();
  /// Moves the ground's texture to the eye, and completes what paging reports.
  void updateGround(PagingFrame& paging);

  struct Gl {
    PatchLayer layer;
    GroundTexture ground;
  };
  std::shared_ptr<const terrain::Database> database_;
  std::shared_ptr<const terrain::PatchTerrain> terrain_;
  PatchCulling culling_;
  PatchGround hiding_{culling_};
  OcclusionStage occlusion_{hiding_};
  VisibleSet visible_;
  std::uint64_t pagesRead_ = 0;  ///< up to the last frame
  std::unique_ptr<Gl> gl_;
};

}  // namespace trimtab::scene
