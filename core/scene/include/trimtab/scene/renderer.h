#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/distance_image.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/terrain/format/database.h"

/// Draws a frame. The same class behind the workbench's widget, the IG's window and the surfaceless context.
namespace trimtab::scene {

/// In which form a terrain is drawn: that which is asked for where it has it, else what there is. None where
/// there is nothing.
std::optional<TerrainForm> formDrawn(const FrameRequest& request, const terrain::Database* database);

struct Defects;

class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// All calls below need the context current that `initialize` was called with. No-throw; the report says
  /// what is missing.
  GlReport initialize();
  /// The context is going away: frees GL objects. `initialize` may be called again.
  void release();

  void setTerrain(std::shared_ptr<const terrain::Database> database);
  /// Draws into framebuffer `fbo` (0: the window's), whose size is at least the view's; leaves that
  /// framebuffer bound.
  FrameResult draw(const FrameRequest& request, unsigned fbo);

  /// Metres from the eye to what the last picture shows, infinity where nothing was drawn; row 0 at the
  /// bottom.
  std::vector<float> readDistances();

  /// The depth map of the last frame; without pixels if it had none.
  DistanceImage readDepthMap();
  /// The horizon that served in the last picture: elevation in degrees, evenly round from south by west,
  /// north and east of the terrain's frame; NaN where nothing bounds the sky. Empty where none served.
  std::vector<float> readHorizon(int samples);
  /// Pages of the terrain and tiles of its ground that could not be read (PagingFrame::failed counts them);
  /// it stays coarser there.
  Findings pageFailures() const;
  /// A blur accumulates from the next picture on, as if it were the first.
  void forgetPictures();
  /// For each pixel of the last picture the node that it shows, kNoNode where it is sky; row 0 at the bottom.
  /// Draws what was drawn once more: the same vertices in the same order with the same depth test. What only
  /// an overlay draws (lines, edges) is nobody's. Empty where nothing was drawn yet.
  ///
  /// `unculled`: which node it would show if nothing of the same levels had been left out, as in the picture
  /// of CullingCase::none (but for what is far outside the view: nearView in node_pass.h); what the weather's
  /// far cut takes away is still sky.
  static constexpr std::uint32_t kNoNode = 0xffffffffu;
  std::vector<std::uint32_t> readNodes(bool unculled = false);
  /// RGBA of what `draw` left, row 0 at the bottom.
  std::vector<std::uint8_t> readPixels(int width, int height);

 private:
  friend void plant(Renderer& renderer, const Defects& defects);  // planted_defects.h
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::scene
