#pragma once

#include "core/scene/terrain/terrain_drawer.h"
#include "trimtab/scene/osg_database.h"

namespace trimtab::scene {

/// Draws an OsgDatabase with OpenSceneGraph's own update, cull, draw and paging. It has no nodes of ours, so
/// what the other forms say of nodes is empty here.
///
/// Depth is reversed as in the rest of the image: near / distance. So the tests of the scene's own state sets
/// are overridden by "greater or equal". Polygon offsets of a scene act the other way round.
class OsgDrawer final : public TerrainDrawer {
 public:
  OsgDrawer();
  ~OsgDrawer() override;

  void setTerrain(std::shared_ptr<const terrain::Database> database) override;
  void initialize() override {}
  void release() override;
  void plant(const Defects&) override {}

  /// Tells whether the terrain is such a scene.
  bool active() const { return database_ != nullptr; }
  /// Updates and culls the scene. With FrameRequest::waitForPages it does so until no page is missing.
  PreparedTerrain prepare(const FrameInProgress& frame) override;
  /// Draws what prepare() found into the framebuffer that is bound, in the view's air.
  void drawScene(const Air& air);
  /// Returns the first parts of the scene that could not be read.
  Findings failures() const;

  const std::vector<TileDraw>& cut() const override { return drawn_; }
  const VisibleSet& visible() const override { return visible_; }

 private:
  const std::vector<Box>& bounds() const override { return noBounds_; }
  int levelOf(TileDraw) const override { return 0; }
  std::size_t upload(std::span<const TileDraw>, bool) override { return 0; }
  void drawNodes(unsigned, std::span<const TileDraw>) override {}
  void drawTinted(unsigned, std::span<const TileDraw>, std::span<const std::uint32_t>) override {}

  struct Scene;
  std::shared_ptr<const OsgDatabase> database_;
  std::unique_ptr<Scene> scene_;  ///< read when it is first drawn, because each context has a copy
  VisibleSet visible_;
  const std::vector<Box> noBounds_;
};

}  // namespace trimtab::scene
