#include <cmath>

#include "tests/core/scene/passes/bilinear_twin.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/measure/image_error.h"
#include "trimtab/preset/table.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab {
namespace {

class RenderScale : public test::SceneTest {
 protected:
  void SetUp() override {
    SceneTest::SetUp();
    if (offscreen) use(test::syntheticMountains());
  }
  FrameRequest ofMountains(double scale) {
    auto r = request(over(0.4, 0.4, 400), {Degrees{30}, Degrees{-8}, Degrees{5}});
    r.levers.drawn.renderScale = scale;
    return r;
  }
};

TEST(ScaledShape, keepsThePerspectiveAndEvenSizes) {
  const ViewShape whole{.widthPx = 1281, .heightPx = 719};
  EXPECT_EQ(scaledShape(whole, 1), whole);
  EXPECT_EQ(scaledShape(whole, 0.5), (ViewShape{.widthPx = 640, .heightPx = 360}));
  EXPECT_EQ(scaledShape({.widthPx = 1, .heightPx = 1}, 0.25), (ViewShape{.widthPx = 2, .heightPx = 2}));
  for (const double scale : {0.0, -1.0, 1.5, HUGE_VAL, std::nan("")})
    EXPECT_EQ(scaledShape(whole, scale), whole);
}

TEST_F(RenderScale, ofOneIsTheImageItself) {
  EXPECT_EQ(differing(picture(ofMountains(1)), picture(ofMountains(2))), 0u);
}

/// The twin: the same view at a smaller size, scaled up in doubles between the middles of its pixels.
TEST_F(RenderScale, isTheSmallerImageScaledUpBetweenItsPixels) {
  const double within = report.software ? 1 : 2;
  for (const double scale : {0.5, 0.3, 0.8, 0.95}) {
    const auto scaled = picture(ofMountains(scale));
    auto smaller = ofMountains(1);
    smaller.view = scaledShape(smaller.view, scale);
    smaller.levers.drawn.errorPx *= pixelsPerRadian(smaller.view) / pixelsPerRadian(ofMountains(1).view);
    const auto small = picture(smaller);
    double worst = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (int c = 0; c < 3; ++c)
          worst = std::max(worst, std::abs(scaled[static_cast<std::size_t>((y * kWidth + x) * 4 + c)] -
                                           test::scaledUp(small, smaller.view.widthPx, smaller.view.heightPx,
                                                          kWidth, kHeight, x, y, c)));
    EXPECT_LE(worst, within) << "grey levels at scale " << scale;
    EXPECT_GT(differing(scaled, picture(ofMountains(1))), 10000u) << scale;
  }
}

TEST_F(RenderScale, neitherSelectsOtherLevelsNorLeavesATrace) {
  const auto plain = picture(ofMountains(1));
  FrameResult whole, scaled;
  picture(ofMountains(1), &whole);
  picture(ofMountains(0.5), &scaled);
  EXPECT_EQ(scaled.tilesInCut, whole.tilesInCut) << "errors count the image's pixels";
  EXPECT_EQ(differing(plain, picture(ofMountains(1))), 0u);
}

TEST_F(RenderScale, cullingChangesNoPixelOfIt) {
  for (const double scale : {0.3, 0.5, 0.71}) {
    auto unculled = ofMountains(scale), culled = ofMountains(scale);
    unculled.cullingCase = CullingCase::none;
    culled.decision.scheme = Scheme::dynamic;
    culled.levers.drawn.occlusion = OcclusionResolution{640, 480};
    for (const OcclusionMethod method : {OcclusionMethod::depth_map, OcclusionMethod::horizon}) {
      culled.occlusion = method;
      EXPECT_EQ(differing(picture(unculled), picture(culled)), 0u) << scale;
    }
  }
}

TEST_F(RenderScale, leavesSymbolsSharp) {
  auto plain = ofMountains(1), scaled = ofMountains(0.5), bare = ofMountains(0.5);
  TuningParameters p;
  p.symbology.enabled = true;
  const Attitude a{Degrees{30}, Degrees{-2}, Degrees{5}};
  plain.symbology = scaled.symbology =
      SymbologyRequest{{a, a, Metres{1234}, Knots{240}, true,
                        Velocity{MetresPerSecond{100}, MetresPerSecond{60}, MetresPerSecond{2}}},
                       symbologySetup(p),
                       {}};
  const auto withSymbols = picture(scaled), without = picture(bare), sharp = picture(plain);
  std::size_t symbolPixels = 0, other = 0;
  for (std::size_t i = 0; i < sharp.size(); i += 4) {
    // Where a symbol covers a pixel wholly, its colour does not depend on the scene below.
    const bool opaque = sharp[i + 1] > 200 && sharp[i] < 60 && withSymbols[i + 1] != without[i + 1];
    if (!opaque) continue;
    ++symbolPixels;
    other += std::abs(int{sharp[i + 1]} - int{withSymbols[i + 1]}) > 8;
  }
  EXPECT_GT(symbolPixels, 300u);
  EXPECT_EQ(other, 0u);
}

TEST_F(RenderScale, noDistancesAreReadBeforeThereIsAnImage) {
  scene::Renderer fresh;
  EXPECT_TRUE(fresh.readDistances().empty());
  ASSERT_TRUE(fresh.initialize().usable);
  EXPECT_TRUE(fresh.readDistances().empty());
  fresh.setTerrain(database);
  EXPECT_TRUE(fresh.readDistances().empty());
  renderer.release();
  ASSERT_TRUE(renderer.initialize().usable);
  EXPECT_TRUE(renderer.readDistances().empty()) << "the images of an earlier context are gone";
}

TEST_F(RenderScale, distancesAndNodesAreReadAtTheImagesSize) {
  picture(ofMountains(1));
  const auto whole = renderer.readDistances();
  picture(ofMountains(0.5));
  const auto scaled = renderer.readDistances();
  ASSERT_EQ(scaled.size(), std::size_t{kWidth} * kHeight);
  ASSERT_EQ(renderer.readNodes().size(), scaled.size());
  std::size_t near = 0;
  for (std::size_t i = 0; i < whole.size(); ++i)
    near += std::isfinite(whole[i]) == std::isfinite(scaled[i]) &&
            (!std::isfinite(whole[i]) || std::abs(whole[i] - scaled[i]) < 0.1 * whole[i]);
  EXPECT_GT(near, whole.size() * 97 / 100);
}

TEST_F(RenderScale, countsAsErrorAndDrawsNothingThatIsHidden) {
  scene::ErrorMeter meter;
  ASSERT_TRUE(meter.initialize().usable);
  meter.setTerrain(database);
  const auto plain = meter.measure(ofMountains(1), nullptr, nullptr),
             scaled = meter.measure(ofMountains(0.5), nullptr, nullptr);
  EXPECT_GT(scaled.flip, plain.flip + 0.005);
  EXPECT_EQ(scaled.wronglyCulledPixels, 0u);
  meter.release();
}

/// Odd sizes and tiny ones: nothing is drawn beyond the image, and the smallest scene has two pixels.
TEST_F(RenderScale, worksAtAnySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 5}, {641, 359}, {1023, 17}})
    for (const double scale : {0.25, 0.5, 0.77, 0.999}) {
      auto r = ofMountains(scale);
      r.view.widthPx = width;
      r.view.heightPx = height;
      EXPECT_EQ(picture(r).size(), static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    }
}

/// A share of the particles is fewer of the same drops, not other weather.
TEST_F(RenderScale, aShareOfTheParticlesDrawsFewerDrops) {
  auto r = ofMountains(1);
  const auto clear = picture(r);
  r.decision.weather.precipitation = Precipitation::snow;
  r.decision.weather.density = 0.6;
  r.time = 3;
  const auto changed = [&](double share) {
    r.levers.drawn.particleShare = share;
    return differing(clear, picture(r));
  };
  const std::size_t all = changed(1), half = changed(0.5);
  EXPECT_GT(all, 1000u);
  EXPECT_LT(half, all * 8 / 10);
  EXPECT_GT(half, all * 2 / 10);
  EXPECT_EQ(changed(0), 0u);
  EXPECT_EQ(changed(1), all);
}

}  // namespace
}  // namespace trimtab
