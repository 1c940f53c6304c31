#pragma once

#include <memory>

#include "trimtab/frame/weather_decision.h"

namespace trimtab::bench {

/// osgParticle::PrecipitationEffect as OpenSceneGraph ships it, in a viewer and a context of its own: over a
/// picture of one colour, with its own shaders.
class OsgPrecipitation {
 public:
  OsgPrecipitation(int widthPx, int heightPx);
  ~OsgPrecipitation();
  bool ready() const;

  /// Milliseconds of a finished frame; density 0 is the picture alone.
  double ms(Precipitation kind, double density, double time);
  /// Pixels of the last frame that something fell through.
  double wetShare();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::bench
