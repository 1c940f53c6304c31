#pragma once

#include "core/scene/occlusion/occlusion_stage.h"
#include "core/scene/terrain/terrain_drawer.h"
#include "core/scene/terrain/tiles/occlusion_pass.h"
#include "tile_cache.h"
#include "tile_ground.h"
#include "trimtab/culling/cut_rule.h"
#include "trimtab/culling/depth_pyramid.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::scene {

/// Draws the terrain as levels of square tiles, and the GPU's depth map that finds hidden ones among them.
class TileDrawer final : public TerrainDrawer {
 public:
  void setTerrain(std::shared_ptr<const terrain::Database> database) override;
  void initialize() override;
  void release() override { gl_.reset(); }
  void plant(const Defects& defects) override;

  PreparedTerrain prepare(const FrameInProgress& frame) override;
  void finished(const FrameResult& result) override { occlusion_.finished(result); }
  BuiltAhead buildAhead(std::span<const std::uint32_t> nodes,
                        std::chrono::steady_clock::time_point deadline) override {
    return gl_->tiles.buildAhead(nodes, deadline);
  }
  // Runs the depth map's passes, if `prepare` set a depth view.
  void drawOccluders();
  void reduce(unsigned program) { gl_->occlusion.reduce(program); }
  /// Tests the visible tiles against that map, waits for the result, and removes what it hides. Returns one
  /// flag per cell of the objects, not 0 if the map hides it; or nothing. They are valid until the next call.
  std::span<const std::uint8_t> removeHidden();

  const std::vector<TileDraw>& cut() const override { return cut_.tiles; }
  const VisibleSet& visible() const override { return visible_; }
  const Horizon* horizon() const override { return occlusion_.horizon(); }
  DistanceImage readDepthMap() const override;

 private:
  const std::vector<Box>& bounds() const override { return database_->index().bounds; }
  std::span<const NormalCone> cones() const override { return database_->index().cones; }
  int levelOf(TileDraw node) const override { return database_->index().level[node.node]; }
  std::size_t upload(std::span<const TileDraw> nodes, bool anew) override {
    return gl_->tiles.prepare(nodes, anew);
  }
  void drawNodes(unsigned program, std::span<const TileDraw> nodes) override;
  void drawTinted(unsigned program, std::span<const TileDraw> nodes,
                  std::span<const std::uint32_t> colours) override;
  /// Selects the cut if anything that it depends on has changed, and returns whether it did.
  bool selectCut(const FrameRequest& request);
  /// Returns the view of the depth map that the GPU must draw; unset if it draws none, and then `note` may
  /// say why. The visible tiles must have slots.
  std::optional<DepthView> prepareDepthMap(const FrameRequest& request, std::string& note);

  struct Gl {
    TileCache tiles;
    OcclusionPass occlusion;
  };
  std::shared_ptr<const terrain::Database> database_;
  TileGround ground_;
  OcclusionStage occlusion_{ground_};
  std::optional<CutKey> cutKey_;
  CutNumber cutNumber_;
  LevelCut cut_;
  VisibleSet visible_;
  EyePose eye_;
  std::vector<std::uint32_t> testedSlots_;
  std::vector<TileDraw> occluders_;  ///< drawn into the GPU's depth map
  std::vector<std::uint8_t> flags_, hiddenCells_;
  std::vector<float> depths_;  ///< of the GPU's depth map, with which cells are tested
  DepthPyramid map_;
  Defects defects_;
  bool mapDrawn_ = false;  ///< by the GPU, in the last frame
  double nearM_ = 1;       ///< of the last frame
  std::unique_ptr<Gl> gl_;
};

}  // namespace trimtab::scene
