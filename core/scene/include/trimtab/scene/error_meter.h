#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/measure/frame_error.h"
#include "trimtab/scene/gl_report.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// Returns the request for the reference image. It has the same eye, size, air, precipitation, symbols and
/// time, but the finest LODs, the whole render scale, all particles, no blur, no far cut, no overlays and no
/// frozen eye. It culls by the frustum only, which gives the same pixels as no culling (a test compares
/// them).
///
/// If the request asks for patches, their allowed error is an eighth of a pixel, below which an image shows
/// no difference. The frame waits for all pages, which may take 8 GB of memory, or the request's cache if
/// that is larger.
FrameRequest referenceOf(const FrameRequest& request);

/// Holds both images of a measurement, row 0 at the bottom.
struct ErrorPictures {
  int widthPx = 0, heightPx = 0;
  std::vector<std::uint8_t> reference, ours;  ///< RGBA
  std::vector<float> flip;                    ///< FLIP's difference map, 0..1 per pixel
  FrameResult drawnReference, drawn;          ///< what drawing the two gave
};

struct Defects;

/// Measures how far a frame's image is from its reference. Every call from initialize() on needs the context
/// current in which initialize() was called. It draws with a renderer and framebuffers of its own, and
/// restores the framebuffers that were bound and the viewport; the rest of GL's state is as Renderer::draw
/// leaves it.
///
/// The same requests give the same numbers to the bit, whatever was measured before. Overlays and a frozen
/// eye are left out of both images, because they are for the engineer; only Overlays::treeDepth counts in the
/// image that is measured.
class ErrorMeter {
 public:
  /// Needs no context.
  ErrorMeter();
  /// Needs the context current, unless release() was called.
  ~ErrorMeter();
  ErrorMeter(const ErrorMeter&) = delete;
  ErrorMeter& operator=(const ErrorMeter&) = delete;

  /// Does what Renderer::initialize does, and forgets the references.
  GlReport initialize();
  /// Frees the GL objects and the references, and keeps the terrain; call it before the context goes away.
  void release();
  /// Measures on this terrain from now on, or on none if it is null. It may be called before initialize().
  void setTerrain(std::shared_ptr<const terrain::Database> database);

  /// Measures a frame. `before` holds the frames before it, oldest first. Temporal pop is measured against
  /// the last of them; it is NaN without one, or if that one has another size in pixels.
  ///
  /// A blur mixes an image with those before it, so a request with blur needs them: the first of them stands
  /// for all older ones, and without any there is no blur. Only those are drawn that change the image by a
  /// quarter of a grey level or more, so more than enough may be passed.
  ///
  /// It draws the reference and the image, both of the frame before too if pop is measured, and the nodes of
  /// the image with and without culling. It waits for all pages and reads every image back. A reference costs
  /// most, and the last four are kept: measure all presets and cases of one frame before the next frame, and
  /// frames in order.
  ///
  /// `pictures`, if not null, receives what was compared. Without pixels or a usable context the result is a
  /// default FrameError, and `pictures` stays as it is.
  FrameError measure(const FrameRequest& request, std::span<const FrameRequest> before,
                     ErrorPictures* pictures);
  /// Does the same with one frame before it, or with none if `before` is null.
  FrameError measure(const FrameRequest& request, const FrameRequest* before, ErrorPictures* pictures) {
    return measure(request, std::span(before, before ? 1u : 0u), pictures);
  }

  /// Draws what measure() measures of a frame alone, and returns what it gave. It is for times that are
  /// compared: draw both frames in turns, several times, after a first turn that does not count.
  FrameResult draw(const FrameRequest& request);

 private:
  friend void plant(ErrorMeter& meter, const Defects& defects);  // planted_defects.h
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns the temporal pop of one step, 0..255: the mean over all pixels and over red, green and blue of the
/// change that the reference does not explain. It explains every change between none and its own: if a
/// channel of the reference rises by 10 and ours rises by 13, 3 count, and if ours falls by 2, 2 count. So an
/// image that stands still, or follows the reference half of the way, does not pop. Returns NaN if the four
/// are empty, not RGBA, or not of one size.
double temporalPop(std::span<const std::uint8_t> referenceBefore, std::span<const std::uint8_t> reference,
                   std::span<const std::uint8_t> oursBefore, std::span<const std::uint8_t> ours);

}  // namespace trimtab::scene
