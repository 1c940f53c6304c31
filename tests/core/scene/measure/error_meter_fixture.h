#pragma once

#include <cmath>
#include <random>

#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/error_meter.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::test {

/// A meter beside the renderer, in its context.
class ErrorMeterTest : public SceneTest {
 protected:
  void SetUp() override {
    SceneTest::SetUp();
    if (offscreen) {
      ASSERT_TRUE(meter.initialize().usable);
    }
  }
  void TearDown() override {
    if (offscreen) meter.release();
    SceneTest::TearDown();
  }
  void measureOver(std::shared_ptr<const terrain::Database> terrain) {
    use(terrain);
    meter.setTerrain(std::move(terrain));
  }

  /// Low in the mountains, where much is hidden.
  FrameRequest lowRequest(double heading = 30) const {
    auto r = request(over(0.45, 0.4, 130), {Degrees{heading}, Degrees{-5}, Degrees{}});
    r.decision.depthMap = DepthMapSize{320, 240};
    return r;
  }
  /// A view along a flight of views that look anywhere, most of them low.
  FrameRequest anyRequest(std::mt19937& random) const {
    std::uniform_real_distribution<double> place(0.15, 0.85), unit(0, 1);
    const double above = 60 * std::pow(80.0, std::pow(unit(random), 2.0)), east = place(random);
    auto r = request(over(east, place(random), above),
                     {Degrees{360 * unit(random)}, Degrees{-25 + 30 * unit(random)},
                      Degrees{unit(random) < 0.3 ? 360 * unit(random) : 0}});
    r.decision.depthMap = DepthMapSize{320, 240};
    return r;
  }
  FrameError measure(const FrameRequest& r, const FrameRequest* before = nullptr,
                     scene::ErrorPictures* pictures = nullptr) {
    return meter.measure(r, before, pictures);
  }

  scene::ErrorMeter meter;
};

}  // namespace trimtab::test
