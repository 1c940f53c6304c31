#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/scene/gl/stage_clock.h"
#include "core/scene/passes/lines.h"
#include "core/scene/passes/scene_view.h"
#include "trimtab/culling/horizon.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/built_ahead.h"
#include "trimtab/scene/distance_image.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

class OcclusionStage;

/// Holds what a drawer reads of the frame that is being made.
struct FrameInProgress {
  const FrameRequest& request;
  EyePose eye;  ///< in the terrain's frame
  ViewShape shape;
  int guardBand;  ///< guard_band.h
  StageClock& clock;
  bool software;  ///< GL is this processor
};

/// Holds what preparing a terrain for one frame found, for the renderer to merge.
struct PreparedTerrain {
  OcclusionResult occlusion;
  PagingFrame paging;
  FrameCounters counters;          ///< of this frame
  std::optional<DepthView> depth;  ///< the depth map that the GPU is to draw
  bool oneSided = false;           ///< SceneView::oneSided
  bool treePicture = false;        ///< SceneView::treePicture
  std::vector<LineVertex> lines;   ///< overlay lines
  /// One flag per cell of the objects on the ground, not 0 if the horizon hides it; or nothing.
  std::span<const std::uint8_t> hiddenCells;
};

/// Binds, while it lives, the buffer textures that tell the terrain's vertex shaders which node a vertex
/// belongs to.
class BoundSlots {
 public:
  BoundSlots(unsigned slots, unsigned tints) { bind(slots, tints); }
  ~BoundSlots() { bind(0, 0); }
  BoundSlots(const BoundSlots&) = delete;
  BoundSlots& operator=(const BoundSlots&) = delete;

 private:
  static void bind(unsigned slots, unsigned tints);
};

/// One form of a terrain: which of its nodes a frame draws, which of them are on the GPU, and how they are
/// drawn. Calls with a program or a frame need the context current that `initialize` was called in.
class TerrainDrawer {
 public:
  virtual ~TerrainDrawer() = default;

  /// Starts with another terrain, or with none if it is null. If there is a context, it must be current.
  virtual void setTerrain(std::shared_ptr<const terrain::Database> database) = 0;
  virtual void initialize() = 0;
  virtual void release() = 0;
  virtual void plant(const Defects& defects) = 0;

  /// Selects the nodes to draw, removes those that are known to be hidden, and uploads the rest. What `frame`
  /// refers to must live until the frame is drawn.
  virtual PreparedTerrain prepare(const FrameInProgress& frame) = 0;
  /// Builds meshes of nodes for coming frames, in order, until `deadline`; see Renderer::buildAhead.
  virtual BuiltAhead buildAhead(std::span<const std::uint32_t>, std::chrono::steady_clock::time_point) {
    return {};
  }
  /// Reports what the finished frame cost.
  virtual void finished(const FrameResult&) {}
  /// Draws the image's surface. Afterwards `visible` is complete.
  virtual void draw(unsigned program);
  /// Draws the same again as lines.
  void drawWire(unsigned program);
  /// Prepares the nodes that drawNumbered draws: those of the last frame or, if `unculled`, also those that
  /// were left out of its cut, except for what is far outside the view. Returns how many meshes had to be
  /// made.
  std::size_t prepareNumbers(bool unculled);
  /// Draws what prepareNumbers found, each node as its number.
  virtual void drawNumbered(unsigned program) { drawNodes(program, numbered_); }

  /// Returns the frame that was prepared last; one must have been.
  const FrameInProgress& frame() const { return *frame_; }
  virtual const std::vector<TileDraw>& cut() const = 0;
  virtual const VisibleSet& visible() const = 0;
  virtual DistanceImage readDepthMap() const { return {}; }
  /// Returns the horizon that the last frame used, or null.
  virtual const Horizon* horizon() const { return nullptr; }

 protected:
  virtual const std::vector<Box>& bounds() const = 0;
  /// Returns one normal cone per node, or nothing.
  virtual std::span<const NormalCone> cones() const { return {}; }
  /// Returns the level that the overlay colourByLevel shows.
  virtual int levelOf(TileDraw node) const = 0;
  /// Makes sure that the nodes are on the GPU, or makes them `anew`; returns how many were made.
  virtual std::size_t upload(std::span<const TileDraw> nodes, bool anew) = 0;
  virtual void drawNodes(unsigned program, std::span<const TileDraw> nodes) = 0;
  /// Draws each node with its colour (RGBA8).
  virtual void drawTinted(unsigned program, std::span<const TileDraw> nodes,
                          std::span<const std::uint32_t> colours) = 0;
  /// Sorts nodes into the order of drawing: those drawn from both sides first, then by distance, because
  /// near ones hide others. Both depend on node and view alone, so leaving one out changes nothing in the
  /// rest. Nodes that face away are not drawn from both sides, as some culling cases leave them out.
  virtual void arrange(std::vector<TileDraw>& nodes) const;

  /// Call it first of all in `prepare`.
  void begin(const FrameInProgress& frame);
  /// Draws nodes with the colours that an overlay asks for.
  void drawSurface(unsigned program, std::span<const TileDraw> nodes);
  /// Returns what is drawn: the visible nodes, or all of the cut if reasons are shown.
  const std::vector<TileDraw>& shown() const;
  /// Finds what of a cut is visible to an eye for which `stage` has begun. Returns false if that cannot have
  /// changed. Does not count vertices.
  bool findVisible(OcclusionStage& stage, const LevelCut& cut, VisibleSet& visible);
  /// Uploads what is shown and returns how many meshes were built for it. Its time counts as paging only if
  /// any were.
  std::size_t uploadShown();
  /// Returns the boxes of the cut as lines if an overlay asks for them, else nothing.
  std::vector<LineVertex> tileBounds() const;

  std::optional<FrameInProgress> frame_;
  std::vector<TileDraw> drawn_, numbered_;

 private:
  std::vector<std::uint32_t> tints_;
  struct Place {
    std::uint64_t key;  ///< whether it is drawn from one side, the square of its distance, then its number
    TileDraw node;
  };
  mutable std::vector<Place> places_;
};

}  // namespace trimtab::scene
