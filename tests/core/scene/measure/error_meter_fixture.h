#pragma once

#include <cmath>
#include <random>

#include "tests/core/scene/scene_test.h"
#include "trimtab/culling/select_static.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/error_meter.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::test {

/// Returns the limit, in pixels, of the geometric error of a request as long as LODs state their errors
/// truly: what the cut may err by, seen at the image's corner, where a pixel spans the smallest angle, and a
/// pixel and a half for silhouettes, which may lie between the pixels' centres. Infinite where nothing is
/// promised (patches; static trees by mean error or by a fixed depth).
inline double geometricBoundPx(const FrameRequest& request) {
  const ViewShape& v = request.view;
  const double across = std::max(std::abs(v.left), std::abs(v.right)),
               up = std::max(std::abs(v.bottom), std::abs(v.top));
  if (request.terrain.form == TerrainForm::patches && !asksForTrees(request))
    return std::numeric_limits<double>::infinity();
  double cutPx = request.levers.drawn.errorPx * request.levers.drawn.lodScale;
  if (asksForTrees(request)) {
    StaticLodParameters s = request.staticLod;
    s.errorPx = Pixels{request.levers.drawn.treeErrorPx};
    if (s.error != ErrorMeasure::maximum || request.overlays.treeDepth >= 0)
      return std::numeric_limits<double>::infinity();
    const double scale = pixelsPerRadian(v);
    cutPx = scale / staticLodDistancePerError(s, request.levers.drawn.lodScale, scale);
  }
  return cutPx * std::sqrt(1 + across * across + up * up) + 1.5;
}

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
    r.levers.drawn.occlusion = OcclusionResolution{320, 240};
    return r;
  }
  /// A view along a flight of views that look anywhere, most of them low.
  FrameRequest anyRequest(std::mt19937& random) const {
    std::uniform_real_distribution<double> place(0.15, 0.85), unit(0, 1);
    const double above = 60 * std::pow(80.0, std::pow(unit(random), 2.0)), east = place(random);
    auto r = request(over(east, place(random), above),
                     {Degrees{360 * unit(random)}, Degrees{-25 + 30 * unit(random)},
                      Degrees{unit(random) < 0.3 ? 360 * unit(random) : 0}});
    r.levers.drawn.occlusion = OcclusionResolution{320, 240};
    return r;
  }
  FrameError measure(const FrameRequest& r, const FrameRequest* before = nullptr,
                     scene::ErrorPictures* pictures = nullptr) {
    return meter.measure(r, before, pictures);
  }

  scene::ErrorMeter meter;
};

}  // namespace trimtab::test
