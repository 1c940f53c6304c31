#include "trimtab/scene/error_meter.h"
#include "trimtab/scene/planted_defects.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/scene/gl/gl_api.h"
#include "error_meter_fixture.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"

namespace trimtab {
namespace {

class ErrorMeter : public test::ErrorMeterTest {
 protected:
  /// Largest error of views at an error bound, as a share of what geometricBound allows.
  void staysWithinTheBound(double boundPx, double lodScale, TerrainForm form, int views) {
    std::mt19937 random(3);
    double largest = 0, share = 0;
    for (int i = 0; i < views; ++i) {
      auto r = anyRequest(random);
      r.levers.drawn.errorPx = r.levers.drawn.treeErrorPx = boundPx;
      r.terrain.form = form;
      r.staticLod.error = ErrorMeasure::maximum;
      r.levers.drawn.lodScale = lodScale;
      const FrameError error = measure(r);
      EXPECT_EQ(error.wronglyCulledPixels, 0u) << "view " << i;
      EXPECT_LE(error.geometricMaxPx, test::geometricBoundPx(r)) << "view " << i;
      largest = std::max(largest, error.geometricMaxPx);
      share = std::max(share, error.geometricMaxPx / test::geometricBoundPx(r));
    }
    std::printf("at %g px x %g: largest %.2f px, %.0f %% of the bound\n", boundPx, lodScale, largest,
                100 * share);
  }
};

TEST_F(ErrorMeter, theReferencesPictureIsTheUnculledOne) {
  measureOver(test::syntheticMountains());
  std::mt19937 random(11);
  for (int i = 0; i < 16; ++i) {
    auto r = scene::referenceOf(anyRequest(random));
    FrameResult frustum, none;
    const auto culled = picture(r, &frustum);
    r.cullingCase = CullingCase::none;
    EXPECT_EQ(differing(culled, picture(r, &none)), 0u) << "view " << i;
    EXPECT_LT(frustum.visible.tiles.size(), none.visible.tiles.size());
    for (const TileDraw& tile : none.visible.tiles) ASSERT_EQ(database->index().level[tile.node], 0);
  }
}

TEST_F(ErrorMeter, theReferencesPictureIsTheUnculledOneOverRealTerrains) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest");
  use(bakeShared("dem-srtm3-everest"));
  ASSERT_TRUE(database);
  std::mt19937 random(12);
  for (int i = 0; i < 6; ++i) {
    auto r = scene::referenceOf(anyRequest(random));
    const auto culled = picture(r);
    r.cullingCase = CullingCase::none;
    EXPECT_EQ(differing(culled, picture(r)), 0u) << "view " << i;
  }
}

TEST_F(ErrorMeter, findsNothingWhereNothingIsLost) {
  measureOver(test::syntheticMountains());
  auto r = lowRequest(), before = lowRequest(29.5);
  for (auto* frame : {&r, &before}) {
    frame->levers.drawn.errorPx = 1e-6;
    frame->exactSlivers = true;  // as the meter draws
  }
  before.time = -1.0 / 60;
  for (const CullingCase method : {CullingCase::none, CullingCase::view_frustum, CullingCase::proposed}) {
    r.cullingCase = before.cullingCase = method;
    scene::ErrorPictures pictures;
    const FrameError error = measure(r, &before, &pictures);
    EXPECT_EQ(error.wronglyCulledPixels, 0u);
    EXPECT_EQ(error.geometricMaxPx, 0);
    EXPECT_EQ(error.geometricMeanPx, 0);
    EXPECT_TRUE(std::isinf(error.psnrDb));
    EXPECT_EQ(error.ssim, 1);
    EXPECT_EQ(error.flip, 0);
    EXPECT_EQ(error.pop, 0);
    EXPECT_EQ(pictures.ours, pictures.reference);
    EXPECT_EQ(pictures.ours, picture(r));
    EXPECT_EQ(pictures.flip.size(), static_cast<std::size_t>(kWidth * kHeight));
    EXPECT_EQ(pictures.drawn.visible.occluded > 0, method == CullingCase::proposed);
    EXPECT_EQ(pictures.drawnReference.visible.occluded, 0u);
  }
}

TEST_F(ErrorMeter, sharesWhatWasDrawnAndOwnsNothing) {
  measureOver(test::syntheticMountains());
  auto r = lowRequest();
  r.cullingCase = CullingCase::view_frustum;
  const double share = measure(r).hiddenDrawnShare;
  // Counted by leaving each out: it owns nothing if that changes nothing.
  FrameResult result;
  const auto whole = picture(r, &result);
  std::size_t hidden = 0;
  for (const TileDraw& tile : result.visible.tiles) {
    plant(renderer, {.culledNode = tile.node});
    hidden += differing(whole, picture(r)) == 0;
  }
  plant(renderer, {});
  EXPECT_GT(hidden, 5u);
  EXPECT_EQ(share, static_cast<double>(hidden) / static_cast<double>(result.visible.tiles.size()));
  r.cullingCase = CullingCase::proposed;
  EXPECT_LT(measure(r).hiddenDrawnShare, share) << "what the depth map is for";
  r.eye.height = r.eye.height + Metres{20000};
  r.attitude.pitch = Degrees{60};
  r.cullingCase = CullingCase::view_frustum;
  EXPECT_TRUE(std::isnan(measure(r).hiddenDrawnShare)) << "nothing but sky: no share of it";
}

TEST_F(ErrorMeter, geometricErrorStaysWithinWhatTheLevelsPromise) {
  measureOver(test::syntheticMountains());
  for (const double bound : {2.0, 8.0}) staysWithinTheBound(bound, 1, TerrainForm::tiles, 10);
  staysWithinTheBound(2, 4, TerrainForm::tiles, 10);
}

TEST_F(ErrorMeter, geometricErrorStaysWithinWhatTheLevelsPromiseOverKansai) {
  TRIMTAB_NEEDS_SHARED("data/fg-kansai-e135n35");
  measureOver(bakeShared("fg-kansai-e135n35"));
  ASSERT_TRUE(database);
  staysWithinTheBound(2, 1, TerrainForm::tiles, 8);
  staysWithinTheBound(4, 1, TerrainForm::static_trees, 8);
}

TEST_F(ErrorMeter, aCoarserPictureIsFartherFromTheReference) {
  measureOver(test::syntheticMountains());
  auto r = lowRequest();
  FrameError last;
  for (const double bound : {2.0, 8.0, 32.0}) {
    r.levers.drawn.errorPx = bound;
    const FrameError error = measure(r);
    if (bound > 2) {
      EXPECT_GT(error.geometricMeanPx, last.geometricMeanPx);
      EXPECT_LT(error.psnrDb, last.psnrDb);
      EXPECT_LT(error.ssim, last.ssim);
      EXPECT_GT(error.flip, last.flip);
    }
    last = error;
  }
}

TEST_F(ErrorMeter, showsTheBlurThatTheFramesBeforeLeave) {
  measureOver(test::syntheticMountains());
  std::vector<FrameRequest> frames;
  for (int i = 0; i < 6; ++i) {
    auto r = lowRequest(30 + 2.0 * i);
    r.time = 100 + i / 60.0;
    r.levers.drawn.blurStrength = i == 0 ? 0 : 0.6;
    r.levers.drawn.errorPx = 1e-6;
    r.exactSlivers = true;  // as the meter draws
    frames.push_back(r);
  }
  std::vector<std::uint8_t> live;
  for (const auto& frame : frames) live = picture(frame);
  const std::span<const FrameRequest> all(frames);
  scene::ErrorPictures pictures;
  const FrameError error = meter.measure(all.back(), all.first(5), &pictures);
  EXPECT_EQ(pictures.ours, live) << "what whoever flies it sees";
  EXPECT_LT(error.psnrDb, 40);
  EXPECT_GT(error.flip, 0);
  EXPECT_EQ(error.geometricMaxPx, 0) << "a blur moves nothing";
  EXPECT_EQ(error.wronglyCulledPixels, 0u);
  // Older frames that have left no trace change nothing, and with none before there is none to see.
  std::vector<FrameRequest> older(40, frames[0]);
  for (std::size_t i = 0; i < older.size(); ++i) older[i].time = 90 + static_cast<double>(i) / 60;
  older.insert(older.end(), frames.begin(), frames.end() - 1);
  EXPECT_EQ(meter.measure(all.back(), older, nullptr).flip, error.flip);
  EXPECT_EQ(measure(all.back()).flip, 0);
}

TEST_F(ErrorMeter, tellsTheWeathersCutByColoursAndNotByDepths) {
  measureOver(test::syntheticMountains());
  auto r = lowRequest();
  r.levers.drawn.errorPx = 1e-6;
  r.decision.weather = {.fogged = true, .visibilityM = 6000, .extinctionPerM = 2.5e-4, .farM = 6000};
  r.levers.drawn.farM = r.decision.weather.farM;
  scene::ErrorPictures pictures;
  const FrameError error = measure(r, nullptr, &pictures);
  EXPECT_GT(pictures.drawn.visible.beyondVisibility, 0u);
  EXPECT_EQ(pictures.drawnReference.visible.beyondVisibility, 0u);
  EXPECT_EQ(error.wronglyCulledPixels, 0u);
  EXPECT_LT(error.geometricMaxPx, 0.5);
  EXPECT_LT(error.psnrDb, 60);
  EXPECT_GT(error.flip, 0);
  r.levers.drawn.farM = WeatherDecision::kUnlimited;
  EXPECT_EQ(measure(r).flip, 0) << "the fog is the reference's too";
}

TEST_F(ErrorMeter, popIsChangeThatTheReferenceDoesNotShow) {
  measureOver(test::syntheticMountains());
  auto before = lowRequest(), r = before;
  r.time = 1.0 / 60;
  EXPECT_EQ(measure(r, &before).pop, 0) << "nothing changes";
  r.levers.drawn.lodScale = 16;
  const double pop = measure(r, &before).pop;
  EXPECT_GT(pop, 0) << "levels change while the view stands still";
  EXPECT_TRUE(std::isnan(measure(r).pop));
  before.view.widthPx = 320;
  EXPECT_TRUE(std::isnan(measure(r, &before).pop));
}

TEST(TemporalPop, isTheDistanceFromWhatTheReferenceExplains) {
  const auto pixel = [](int value) {
    const auto v = static_cast<std::uint8_t>(value);
    return std::vector<std::uint8_t>{v, v, v, 255};
  };
  const auto pop = [&](int referenceBefore, int reference, int oursBefore, int ours) {
    return scene::temporalPop(pixel(referenceBefore), pixel(reference), pixel(oursBefore), pixel(ours));
  };
  EXPECT_EQ(pop(100, 100, 90, 90), 0) << "an error that stands still does not pop";
  EXPECT_EQ(pop(100, 130, 90, 120), 0) << "nor one that follows";
  EXPECT_EQ(pop(100, 130, 90, 100), 0) << "nor one that lags";
  EXPECT_EQ(pop(100, 130, 90, 125), 5);
  EXPECT_EQ(pop(100, 130, 90, 80), 10) << "the other way";
  EXPECT_EQ(pop(130, 100, 90, 50), 10);
  EXPECT_EQ(pop(100, 100, 0, 255), 255);
  auto oneChannel = pixel(100);
  oneChannel[1] = 106;
  EXPECT_EQ(scene::temporalPop(pixel(0), pixel(0), pixel(100), oneChannel), 2);
  oneChannel[1] = 100;
  oneChannel[3] = 0;
  EXPECT_EQ(scene::temporalPop(pixel(0), pixel(0), pixel(100), oneChannel), 0) << "alpha is no colour";
  EXPECT_TRUE(std::isnan(scene::temporalPop({}, {}, {}, {})));
  const auto two = std::vector<std::uint8_t>(8);
  EXPECT_TRUE(std::isnan(scene::temporalPop(two, pixel(0), two, two)));
}

/// Bit for bit, NaN included.
bool same(const FrameError& a, const FrameError& b) {
  const auto equal = [](double x, double y) { return std::isnan(x) ? std::isnan(y) : x == y; };
  return a.wronglyCulledPixels == b.wronglyCulledPixels && equal(a.geometricMaxPx, b.geometricMaxPx) &&
         equal(a.geometricMeanPx, b.geometricMeanPx) && equal(a.psnrDb, b.psnrDb) && equal(a.ssim, b.ssim) &&
         equal(a.flip, b.flip) && equal(a.pop, b.pop) && equal(a.hiddenDrawnShare, b.hiddenDrawnShare);
}

TEST_F(ErrorMeter, repeatsExactlyInAnyOrder) {
  const auto terrain = test::syntheticMountains();
  measureOver(terrain);
  std::mt19937 random(5);
  std::vector<std::vector<FrameRequest>> runs;  // each the frames before, then the frame
  for (int i = 0; i < 4; ++i) {
    auto r = anyRequest(random), before = r;
    before.time = 50 + i;
    r.time = before.time + 1.0 / 60;
    before.attitude.heading = before.attitude.heading + Degrees{1.5};
    if (i % 2) before.levers.drawn.blurStrength = r.levers.drawn.blurStrength = 0.5;
    if (i % 3 == 2)
      r.decision.weather = before.decision.weather = {.precipitation = Precipitation::rain,
                                                      .density = 0.5,
                                                      .fogged = true,
                                                      .visibilityM = 9000,
                                                      .extinctionPerM = 4e-4,
                                                      .farM = 8000};
    r.levers.drawn.farM = r.decision.weather.farM;
    r.levers.drawn.errorPx = 4.0 + i;
    if (i == 3) r.view.widthPx = before.view.widthPx = 400;
    runs.push_back({before, r});
  }
  const auto measureRun = [this](const std::vector<FrameRequest>& run) {
    return measure(run[1], run.data());
  };
  std::vector<FrameError> first;
  for (const auto& run : runs) first.push_back(measureRun(run));
  for (std::size_t i = runs.size(); i-- > 0;) EXPECT_TRUE(same(measureRun(runs[i]), first[i])) << i;
  // Nothing cached, another context's objects, defects come and gone.
  plant(meter, {.loweringScale = 0, .culledNode = 3, .statedErrorScale = 0.1});
  for (const auto& run : runs) measureRun(run);
  plant(meter, {});
  meter.release();
  ASSERT_TRUE(meter.initialize().usable);
  for (std::size_t i = runs.size(); i-- > 0;) EXPECT_TRUE(same(measureRun(runs[i]), first[i])) << i;
}

TEST_F(ErrorMeter, whatFallsIsMeasuredAgainstItsOwnReference) {
  measureOver(test::syntheticMountains());
  std::mt19937 random(6);
  auto r = anyRequest(random);
  r.time = 20;
  r.levers.drawn.errorPx = 6;
  r.decision.weather = {.precipitation = Precipitation::snow,
                        .density = 1,
                        .fogged = true,
                        .visibilityM = 9000,
                        .extinctionPerM = 4e-4,
                        .farM = 8000};
  r.levers.drawn.farM = r.decision.weather.farM;
  std::vector<FrameRequest> requests(6, r);
  requests[1].wind = {MetresPerSecond{40}, Degrees{90}, MetresPerSecond{}};
  requests[2].airDrift = {17, 5, 3};
  requests[3].snow.red = Ratio{0.1};
  requests[4].snow.size = Ratio{3};
  requests[5].decision.weather.layerTopM = r.eye.height.value() + 30;
  std::vector<FrameError> kept, fresh;
  for (const FrameRequest& each : requests) kept.push_back(measure(each));
  for (const FrameRequest& each : requests) {
    meter.release();
    ASSERT_TRUE(meter.initialize().usable);
    meter.setTerrain(database);
    fresh.push_back(measure(each));
  }
  for (std::size_t i = 0; i < requests.size(); ++i) EXPECT_TRUE(same(kept[i], fresh[i])) << i;
}

// Near where it hid next to nothing a horizon is not built: what was measured before must not decide what is
// drawn.
TEST_F(ErrorMeter, repeatsExactlyWhereAHorizonHidesLittle) {
  measureOver(test::syntheticMountains());
  std::vector<FrameRequest> requests;
  for (int i = 0; i < 10; ++i) {
    auto r = request(over(0.45, 0.4, 2100 - 40.0 * i), {Degrees{30}, Degrees{-5}, {}});
    r.view.widthPx = 160, r.view.heightPx = 80;
    r.view.left = -2, r.view.right = 2, r.view.bottom = -1, r.view.top = 1;
    r.levers.drawn.occlusion = OcclusionResolution{320, 240};
    r.occlusion = OcclusionMethod::horizon;
    r.levers.drawn.errorPx = 0.02;
    requests.push_back(r);
  }
  std::vector<std::size_t> down, up;
  for (const auto& r : requests) down.push_back(renderer.draw(r, offscreen->framebuffer()).visible.occluded);
  for (auto r = requests.rbegin(); r != requests.rend(); ++r)
    up.push_back(renderer.draw(*r, offscreen->framebuffer()).visible.occluded);
  std::reverse(up.begin(), up.end());
  ASSERT_NE(down, up) << "nothing is left out here because of another picture";
  std::vector<FrameError> first;
  for (const auto& r : requests) first.push_back(measure(r));
  for (std::size_t i = requests.size(); i-- > 0;) EXPECT_TRUE(same(measure(requests[i]), first[i])) << i;
  for (std::size_t i = 1; i < requests.size(); i += 3) EXPECT_TRUE(same(measure(requests[i]), first[i])) << i;
}

TEST_F(ErrorMeter, leavesAnothersPictureAndBindingsAlone) {
  measureOver(test::syntheticMountains());
  const auto r = lowRequest();
  const auto before = picture(r);
  glBindFramebuffer(GL_FRAMEBUFFER, offscreen->framebuffer());
  glViewport(1, 2, 30, 40);
  auto overlaid = r;
  overlaid.overlays.wireframe = overlaid.overlays.tileBounds = overlaid.overlays.colourByLevel = true;
  overlaid.frozenEye = EyePose{};
  EXPECT_TRUE(same(measure(overlaid), measure(r))) << "what is for the engineer is no error";
  GLint bound = 0, viewport[4] = {};
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &bound);
  glGetIntegerv(GL_VIEWPORT, viewport);
  EXPECT_EQ(static_cast<unsigned>(bound), offscreen->framebuffer());
  EXPECT_EQ(viewport[2], 30);
  EXPECT_EQ(renderer.readPixels(kWidth, kHeight), before);
  EXPECT_EQ(picture(r), before);
}

TEST_F(ErrorMeter, measuresNothingWithoutAContextOrPixels) {
  measureOver(test::syntheticMountains());
  auto r = lowRequest();
  r.view.heightPx = 0;
  EXPECT_TRUE(same(measure(r), FrameError{}));
  meter.release();
  EXPECT_TRUE(same(measure(lowRequest()), FrameError{}));
}

}  // namespace
}  // namespace trimtab
