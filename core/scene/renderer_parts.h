#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/scene/foreign/osg_drawer.h"
#include "core/scene/gl/frame_buffer.h"
#include "core/scene/gl/guard_band.h"
#include "core/scene/gl/stage_clock.h"
#include "core/scene/objects/object_drawer.h"
#include "core/scene/occlusion/horizon_memory.h"
#include "core/scene/passes/blur_pass.h"
#include "core/scene/passes/lines.h"
#include "core/scene/passes/node_pass.h"
#include "core/scene/passes/precipitation_effect.h"
#include "core/scene/passes/precipitation_pass.h"
#include "core/scene/passes/scale_up_pass.h"
#include "core/scene/passes/scene_programs.h"
#include "core/scene/passes/symbology_pass.h"
#include "core/scene/terrain/patches/patch_drawer.h"
#include "core/scene/terrain/static_trees/tree_drawer.h"
#include "core/scene/terrain/tiles/tile_drawer.h"
#include "trimtab/scene/renderer.h"

/// Declares the parts of a Renderer, for renderer.cpp alone.
namespace trimtab::scene {

inline constexpr ViewShape kNoImage{.widthPx = 0, .heightPx = 0};

struct Renderer::Impl {
  GlReport report;
  std::shared_ptr<const terrain::Database> database;
  TileDrawer tiles;
  PatchDrawer patches;
  TreeDrawer trees;
  OsgDrawer foreign;
  ObjectDrawer objects;
  TerrainDrawer* terrain = nullptr;  ///< that drew the last image; null: no terrain
  FrameCounters counters;            ///< since this renderer was made

  /// The last image's, and the size at which its scene was drawn; without pixels before the first image.
  ViewShape lastView = kNoImage, lastScene = kNoImage;
  std::optional<SceneView> shown;  ///< the last image's
  std::vector<LineVertex> lines;

  /// Holds what lives in the context, but for the terrain.
  struct Gl {
    explicit Gl(bool software) : blur(software), scaleUp(software) {}
    FrameBuffer frame;
    FrameBuffer small;  ///< the scene before it is scaled up, if the request asks for that
    NodeTarget nodes;
    ScenePrograms programs;
    LineBuffer lineBuffer;
    PrecipitationPass precipitation;
    std::optional<PrecipitationEffect> effect;  ///< made when it first falls
    BlurPass blur;
    ScaleUpPass scaleUp;
    SymbologyPass symbology;
    StageClock clock;
    const ViewportLimits viewports = viewportLimitsOfContext();
  };
  std::unique_ptr<Gl> gl;

  /// The forms in the order of TerrainForm, and after them a scene of OpenSceneGraph.
  std::array<TerrainDrawer*, 4> forms() { return {&tiles, &patches, &trees, &foreign}; }
  SceneView viewOf(const FrameRequest& r) const;
  FrameResult prepare(const FrameRequest& r, SceneView& view);
  const FrameBuffer& scene() const { return lastScene == lastView ? gl->frame : gl->small; }
  /// Draws the form of the terrain in the guard band, with its own shaders.
  void drawForm(const SceneView& view, SceneShaders tilesShaders, bool wire,
                void (TerrainDrawer::*drawNodes)(unsigned program));
  FrameResult draw(const FrameRequest& r, unsigned fbo);
  static void leaveContext(unsigned fbo);
  /// Reads the numbers of nodes, or of the objects in front of them.
  std::vector<std::uint32_t> readNumbers(bool unculled, bool ofObjects);
};

}  // namespace trimtab::scene
