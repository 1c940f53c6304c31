#pragma once

#include <array>

#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"

namespace trimtab::test {

/// What tests of rain and snow share: a view in which either form of them falls, and the same in dry air.
class FallingScene : public SceneTest {
 protected:
  static constexpr std::array<Precipitation, 2> kKinds{Precipitation::rain, Precipitation::snow};

  explicit FallingScene(PrecipitationForm form) : form_(form) {}

  FrameRequest falling(Precipitation kind, double density, double aboveM = 400) const {
    auto r = request(over(0.5, 0.5, aboveM), {Degrees{30}, Degrees{-5}, Degrees{0}});
    r.cullingCase = CullingCase::view_frustum;
    r.decision.weather.precipitation = kind;
    r.decision.weather.density = density;
    r.precipitationForm = form_;
    r.time = 12.34;
    return r;
  }
  static FrameRequest dry(FrameRequest r) {
    r.decision.weather.precipitation = Precipitation::none;
    r.decision.weather.density = 0;
    r.fading.reset();
    return r;
  }

 private:
  PrecipitationForm form_;
};

}  // namespace trimtab::test
