#pragma once

#include "core/scene/occlusion/frame_culling.h"
#include "core/scene/occlusion/occlusion.h"
#include "core/scene/terrain/terrain_drawer.h"
#include "tile_cache.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::scene {

/// The terrain as levels of square tiles, with the horizon or a depth map of their own.
class TileDrawer final : public TerrainDrawer {
 public:
  void setTerrain(std::shared_ptr<const terrain::Database> database) override;
  void initialize() override;
  void release() override { gl_.reset(); }
  void plant(const Defects& defects) override { culling_.plant(defects); }

  PreparedTerrain prepare(const FrameInProgress& frame) override;
  void finished(const FrameResult& result) override { culling_.occlusion().finished(result); }
  // The depth map's passes, where `prepare` set a depth view.
  void drawOccluders();
  void reduce(unsigned program) { gl_->occlusion.reduce(program); }
  void removeHidden() { culling_.removeHidden(gl_->tiles, gl_->occlusion); }

  const std::vector<TileDraw>& cut() const override { return culling_.cut().tiles; }
  const VisibleSet& visible() const override { return culling_.visible(); }
  const Horizon* horizon() const override { return culling_.occlusion().horizon(); }
  Renderer::Grey readDepthMap() const override { return culling_.readDepthMap(gl_->occlusion); }

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

  struct Gl {
    TileCache tiles;
    OcclusionPass occlusion;
  };
  std::shared_ptr<const terrain::Database> database_;
  FrameCulling culling_;
  std::unique_ptr<Gl> gl_;
};

}  // namespace trimtab::scene
