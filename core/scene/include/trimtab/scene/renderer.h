#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/built_ahead.h"
#include "trimtab/scene/distance_image.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/terrain/format/database.h"

/// Draws a frame. The workbench's widget, the IG's window and the context without a window use the same
/// class.
namespace trimtab::scene {

/// Returns the form in which a terrain is drawn: the one that the request asks for if the terrain has it,
/// else tiles or patches, whichever it has. Static trees are drawn only if they are asked for (asksForTrees).
/// It is unset if `database` is null or has no form to draw.
std::optional<TerrainForm> formDrawn(const FrameRequest& request, const terrain::Database* database);

struct Defects;

/// Draws frames of one terrain in one GL context. Every call from initialize() on needs the context current
/// in which initialize() was called. What readPixels() and its like return belongs to the last draw(); most
/// of them wait for the GPU, so they are for measurements and tools. A node's number is its index in the form
/// of the terrain that was drawn.
class Renderer {
 public:
  /// Needs no context.
  Renderer();
  /// Needs the context current, unless release() was called.
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Makes the GL objects in the current context. If the report says that the context is not usable, draw()
  /// draws nothing. It never throws. It may be called again, for the same or another context, and keeps the
  /// terrain.
  GlReport initialize();
  /// Frees the GL objects and keeps the terrain; call it before the context goes away. Does nothing if there
  /// is nothing to free.
  void release();

  /// Draws this terrain from now on, or none if it is null. Everything made for the one before is discarded.
  /// It may be called before initialize(), and needs no context then.
  void setTerrain(std::shared_ptr<const terrain::Database> database);
  /// Draws an image of the request's size and copies it to the lower left corner of the framebuffer `fbo` (0
  /// is the window's), which must be at least as large. Leaves `fbo` bound, no program in use, and depth
  /// test, face culling, blending and scissor test off; the viewport is not restored.
  ///
  /// Without a usable context or without pixels it does nothing and returns a default result. FrameRequest
  /// says when it waits for the GPU (waitForImage) and for pages (waitForPages).
  FrameResult draw(const FrameRequest& request, unsigned fbo);

  /// Builds and uploads meshes that coming images will draw, so that those do not take the time: in order, of
  /// the nodes that miss one, as Session::nodesAhead names them. It stops after `withinMs` (milliseconds) and
  /// finishes the mesh that it has begun: a tile's takes about 0.1 ms, that of a tile of static trees takes
  /// milliseconds. Call it between images, with the context current. It changes no image. Patches are read
  /// ahead by draw().
  BuiltAhead buildAhead(std::span<const std::uint32_t> nodes, double withinMs);

  /// Returns the distance from the eye to the terrain that each pixel of the last image shows, metres;
  /// infinity where it shows none. The size is the image's at any render scale, and row 0 is at the bottom.
  /// Returns nothing before the first draw() after initialize(), and without a usable context.
  std::vector<float> readDistances();

  /// Returns the depth map with which the last frame culled (OcclusionMethod), as an image for people. If a
  /// horizon alone served, the image is grey where the horizon hides what is behind it, and white elsewhere.
  /// It has no pixels if there was neither.
  DistanceImage readDepthMap();
  /// Returns the horizon with which the last frame culled, as `samples` elevations, degrees above the level
  /// plane of the terrain's local frame. Each belongs to the middle of one of `samples` equal sectors, which
  /// begin at south and go on to west. NaN means that no ground is known there. Unless
  /// FrameRequest::wholeHorizon is set, the horizon is only as high as the tests of nodes needed. It is empty
  /// if no horizon served, or if `samples` is not above 0.
  std::vector<float> readHorizon(int samples);
  /// Returns the first pages of patches, and the first tiles of the ground's colours, that could not be read
  /// since the terrain was set. The terrain stays coarser there. PagingFrame::failed counts all of them.
  Findings pageFailures() const;
  /// Makes a blur begin anew: the next image is not mixed with those before it.
  void forgetPictures();
  static constexpr std::uint32_t kNoNode = 0xffffffffu;  ///< a pixel of readNodes() that shows no node
  /// Returns for each pixel of the last image the number of the node that it shows, or kNoNode where it is
  /// sky; row 0 is at the bottom. It is empty if nothing was drawn since initialize() or setTerrain(). It
  /// draws the same vertices once more, in the same order with the same depth test, at the image's size at
  /// any render scale. What only an overlay draws (lines, edges) belongs to no node.
  ///
  /// With `unculled`, it returns which node would show if nothing of the same cut had been culled, as in the
  /// image of CullingCase::none, except for nodes that are far outside the view (nearView in node_pass.h).
  /// What the weather's far cut takes away is still sky.
  std::vector<std::uint32_t> readNodes(bool unculled = false);
  /// Returns for each pixel of the last image the number of the object that it shows, in
  /// ObjectIndex::instances, or kNoNode where it shows ground or sky. As readNodes() in all else.
  std::vector<std::uint32_t> readObjects();
  /// Returns RGBA of the lower left corner of the last image, row 0 at the bottom, from the renderer's own
  /// copy of it. The size must not exceed the last image's, or pixels are undefined. Without a usable context
  /// all are 0.
  std::vector<std::uint8_t> readPixels(int width, int height);

  struct Impl;  ///< for renderer.cpp alone

 private:
  friend void plant(Renderer& renderer, const Defects& defects);  // planted_defects.h
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
