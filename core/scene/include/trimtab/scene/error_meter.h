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

/// Returns the request for the reference image: only frustum culling (a test proves it equal to none), the
/// finest LODs, no blur and no far cut, with the same eye, air, precipitation, symbols and time. Overlays and
/// a frozen eye are left out. Patches are drawn to an eighth of a pixel, which is as fine as an image can
/// show, and the frame waits for all pages.
FrameRequest referenceOf(const FrameRequest& request);

/// Both images of a measurement, RGBA, row 0 at the bottom.
struct ErrorPictures {
  int widthPx = 0, heightPx = 0;
  std::vector<std::uint8_t> reference, ours;
  std::vector<float> flip;  ///< the difference map, 0..1 per pixel
  FrameResult drawnReference, drawn;
};

struct Defects;

/// Measures how far a frame's image is from its reference. It draws with its own renderer into its own
/// framebuffers and restores what was bound, so it disturbs nobody who draws in the same context. Every call
/// needs the context current in which `initialize` was called.
///
/// The same requests give the same numbers to the bit, whatever was measured before. Overlays and a frozen
/// eye are left out of both images, because they are for the engineer.
class ErrorMeter {
 public:
  ErrorMeter();
  ~ErrorMeter();
  ErrorMeter(const ErrorMeter&) = delete;
  ErrorMeter& operator=(const ErrorMeter&) = delete;

  GlReport initialize();
  void release();
  void setTerrain(std::shared_ptr<const terrain::Database> database);

  /// Measures a frame. `before` holds the frames before it, oldest first. Temporal pop is measured against
  /// the last of them; it is not measured without one, or if that has another size. A blur mixes an image
  /// with those before it, so only they tell what a request with blur shows: the first of them stands for
  /// all older ones, and without any there is no blur. As many are drawn as matter to a quarter of a grey
  /// level, so more than enough may be passed.
  ///
  /// It draws the reference and the image, the same of the frame before if pop is measured, and the nodes of
  /// the image with and without culling. The last few references are kept, so measure the presets and cases
  /// of one frame in turn, or frames in order. `pictures`, if not null, receives what was compared. Without
  /// pixels or a context the result is a default FrameError.
  FrameError measure(const FrameRequest& request, std::span<const FrameRequest> before,
                     ErrorPictures* pictures);
  FrameError measure(const FrameRequest& request, const FrameRequest* before, ErrorPictures* pictures) {
    return measure(request, std::span(before, before ? 1u : 0u), pictures);
  }

 private:
  friend void plant(ErrorMeter& meter, const Defects& defects);  // planted_defects.h
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns the temporal pop of one step: by how much the change of each channel lies outside of what the
/// reference's change explains (from none to all of it), as a mean over red, green and blue, of 255. An
/// image that stands still, or follows the reference half of the way, does not pop. Returns NaN unless all
/// four are RGBA of one size.
double temporalPop(std::span<const std::uint8_t> referenceBefore, std::span<const std::uint8_t> reference,
                   std::span<const std::uint8_t> oursBefore, std::span<const std::uint8_t> ours);

}  // namespace trimtab::scene
