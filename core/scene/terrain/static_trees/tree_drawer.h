#pragma once

#include "core/scene/terrain/terrain_drawer.h"
#include "static_lod_culling.h"
#include "static_lod_layer.h"
#include "trimtab/culling/depth_pyramid.h"
#include "trimtab/scene/planted_defects.h"

namespace trimtab::scene {

/// Draws the terrain as trees of static levels of detail.
class TreeDrawer final : public TerrainDrawer {
 public:
  void setTerrain(std::shared_ptr<const terrain::Database> database) override;
  void initialize() override;
  void release() override { gl_.reset(); }
  void plant(const Defects& defects) override { culling_.plant(defects); }

  PreparedTerrain prepare(const FrameInProgress& frame) override;
  BuiltAhead buildAhead(std::span<const std::uint32_t> nodes,
                        std::chrono::steady_clock::time_point deadline) override {
    return gl_->layer.buildAhead(nodes, deadline);
  }
  /// Draws all visible nodes. With a depth map it draws the near ones, then the far ones that they do not
  /// hide.
  void draw(unsigned program) override;
  /// Draws document E's image instead: faces grey, edges red, locked edges black.
  void drawPicture(unsigned program);
  void drawNumbered(unsigned program) override;

  const std::vector<TileDraw>& cut() const override { return culling_.cut(); }
  const VisibleSet& visible() const override { return culling_.visible(); }
  StaticLodFrame frame() const { return culling_.frame(); }
  DistanceImage readDepthMap() const override;

 private:
  const std::vector<Box>& bounds() const override { return culling_.index().bounds; }
  int levelOf(TileDraw node) const override { return culling_.index().nodes[node.node].depth; }
  std::size_t upload(std::span<const TileDraw> nodes, bool anew) override {
    return gl_->layer.prepare(nodes, anew);
  }
  void drawNodes(unsigned program, std::span<const TileDraw> nodes) override;
  void drawTinted(unsigned program, std::span<const TileDraw> nodes,
                  std::span<const std::uint32_t> colours) override;
  /// Does nothing: the nodes are in drawing order already (StaticLodCulling::visible).
  void arrange(std::vector<TileDraw>&) const override {}

  struct Gl {
    StaticLodLayer layer;
  };
  std::shared_ptr<const terrain::StaticLodTerrain> terrain_;
  StaticLodCulling culling_;
  std::unique_ptr<Gl> gl_;
  /// Finds the far nodes that the near ones, which are drawn, hide. Blocks until they are drawn.
  ///
  /// The occluders of occlusion.h need a surface without holes and with a bounded slope; scenery promises
  /// neither. The image's own depths need neither: each texel of the map is the farthest depth of all pixels
  /// that it touches (depth_pyramid.h), so what lies behind it would fail the depth test in all of them.
  void readMap();

  std::vector<float> depths_;
  DepthPyramid pyramid_;  ///< the last map
  /// Size of the last frame's map, if only by what it hid when it was drawn.
  std::optional<OcclusionResolution> map_;
  bool mapDrawn_ = false;  ///< in the last frame
  double nearM_ = 1;
};

}  // namespace trimtab::scene
