#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/host_symbols.h"
#include "trimtab/preset/parameters.h"
#include "trimtab/session/air_drift.h"
#include "trimtab/session/precipitation_fade.h"

namespace trimtab {

/// Holds what the next image is drawn of.
struct ImageOf {
  AircraftState eye;
  std::optional<Velocity> velocity;
  FrameDecision decision;
  std::shared_ptr<const HostSymbols> symbols;  ///< of the host; may be null
};

/// Holds how large the image may be, and what its shape follows from.
struct ImageSize {
  int widthPx = 0, heightPx = 0;  ///< of the window
  ViewFit fit = ViewFit::preset;
};

/// Makes the request for each image from the eye and the decision, and remembers what goes on from image to
/// image: the air that drifts, what falls and fades, how long a blur has been seen.
class RequestMaker {
 public:
  /// Says that the next image is the first of another decision.
  void decided() { blurPicturedAt_.reset(); }
  /// Says that the parameters were edited: what falls is shown as they say at once.
  void edited() { fade_.settle(); }

  /// Returns the request for the image at `now`, seconds of CLOCK_REALTIME. The remaining time of a blur runs
  /// from the first image of its decision.
  FrameRequest make(const ImageOf& image, const TuningParameters& parameters, double now,
                    const ImageSize& size);

  /// Reports whether an image of this eye would differ from the last one, if nothing else has changed; true
  /// before the first.
  bool differs(const AircraftState& eye, const HostSymbols* symbols,
               const TuningParameters& parameters) const;

 private:
  AirDrift drift_;
  PrecipitationFade fade_;
  std::optional<double> blurPicturedAt_;   ///< when the first image of the last decision was requested
  std::optional<AircraftState> drawnEye_;  ///< of the last image
  std::vector<std::uint16_t> drawnDark_;   ///< the host's dark symbols in it
};

}  // namespace trimtab
