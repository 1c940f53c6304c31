#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/distance_image.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/terrain/format/database.h"

/// Draws a frame. The same class behind the workbench's widget, the IG's window and the surfaceless context.
namespace trimtab::scene {

/// Returns the form in which a terrain is drawn: the one that the request asks for if the terrain has it,
/// else one that it has. Unset without a terrain, or if it has no form at all.
std::optional<TerrainForm> formDrawn(const FrameRequest& request, const terrain::Database* database);

struct Defects;

class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Every call below needs the context current in which `initialize` was called. It never throws; the report
  /// says what the context lacks.
  GlReport initialize();
  /// Frees the GL objects; call it before the context goes away. `initialize` may be called again.
  void release();

  void setTerrain(std::shared_ptr<const terrain::Database> database);
  /// Draws into the framebuffer `fbo` (0 is the window's), which is at least as large as the view, and leaves
  /// it bound.
  FrameResult draw(const FrameRequest& request, unsigned fbo);

  /// Returns the distance from the eye to what each pixel of the last image shows, metres; infinity where
  /// nothing was drawn. Row 0 is at the bottom.
  std::vector<float> readDistances();

  /// Returns the depth map of the last frame; without pixels if it had none.
  DistanceImage readDepthMap();
  /// Returns the horizon that the last frame used as `samples` elevations in degrees, evenly spaced clockwise
  /// from south in the terrain's frame; NaN where nothing bounds the sky. Empty if no horizon was used.
  std::vector<float> readHorizon(int samples);
  /// Reports the pages of the terrain and the tiles of its ground that could not be read, where it stays
  /// coarser; PagingFrame::failed counts them.
  Findings pageFailures() const;
  /// Lets a blur accumulate anew, as if the next image were the first.
  void forgetPictures();
  /// Returns for each pixel of the last image the node that it shows, or kNoNode where it is sky; row 0 at
  /// the bottom. Empty if nothing was drawn yet. Draws the same vertices once more, in the same order with
  /// the same depth test. What only an overlay draws (lines, edges) belongs to no node.
  ///
  /// With `unculled`, returns which node would show if nothing of the same levels had been left out, as in
  /// the image of CullingCase::none, except for what is far outside the view (nearView in node_pass.h). What
  /// the weather's far cut takes away is still sky.
  static constexpr std::uint32_t kNoNode = 0xffffffffu;
  std::vector<std::uint32_t> readNodes(bool unculled = false);
  /// Returns RGBA of what `draw` left, row 0 at the bottom.
  std::vector<std::uint8_t> readPixels(int width, int height);

 private:
  friend void plant(Renderer& renderer, const Defects& defects);  // planted_defects.h
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
