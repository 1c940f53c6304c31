#include <array>
#include <cmath>
#include <iomanip>
#include <random>
#include <string>
#include <vector>

#include "error_meter_fixture.h"

/// A software rasteriser decides by rounded vertices which pixels a triangle covers, but interpolates by the
/// unrounded ones: a sliver shows a depth and a colour that none of its corners has.
namespace trimtab::test {
namespace {

class Slivers : public ErrorMeterTest {
 protected:
  static constexpr int kWide = 960, kHigh = 540;

  struct View {
    double latitude, longitude, heightM, heading, pitch;
  };
  static constexpr std::array<View, 2> kViews{
      {{36.65611269250644, 128.40201754979267, 876.12243594411802, 329.22815180380587, 1.2735107760151312},
       {36.642227040374038, 128.47531244697021, 2067.5384134701021, 249.05410464234478,
        -6.9257490388589966}}};

  FrameRequest referenceAt(const View& v) const {
    FrameRequest r = request({Degrees{v.latitude}, Degrees{v.longitude}, Metres{v.heightM}},
                             {Degrees{v.heading}, Degrees{v.pitch}, Degrees{0}});
    r.view.widthPx = kWide, r.view.heightPx = kHigh;
    return scene::referenceOf(r);
  }
  /// Pixels with a channel at 0, which neither ground nor sky has.
  std::size_t wrongPixels(const FrameRequest& r) {
    const auto pixels = picture(r);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 4)
      wrong += pixels[i] == 0 || pixels[i + 1] == 0 || pixels[i + 2] == 0;
    return wrong;
  }
};

TEST_F(Slivers, showNoWrongColourInAReference) {
  offscreen->resize(kWide, kHigh);
  use(syntheticMountains());
  for (const View& v : kViews) EXPECT_EQ(wrongPixels(referenceAt(v)), 0u) << v.heading;
}

TEST_F(Slivers, wouldShowWrongColoursOtherwise) {
  if (!report.software) GTEST_SKIP() << "GPUs interpolate by rounded vertices";
  offscreen->resize(kWide, kHigh);
  use(syntheticMountains());
  std::size_t wrong = 0;
  for (const View& v : kViews) {
    FrameRequest r = referenceAt(v);
    r.exactSlivers = false;
    wrong += wrongPixels(r);
  }
  EXPECT_GT(wrong, 0u) << "these views no longer test anything: look for others";
}

/// Low views over scenery, in every form of the terrain that its database has: one a form, and N with
/// TRIMTAB_SOAK=N in the environment. A pixel that is black, or a geometric error that no surface explains,
/// is a sliver's.
class SliversOver : public Slivers, public testing::WithParamInterface<const char*> {
 protected:
  static std::size_t blackPixels(const std::vector<std::uint8_t>& pixels) {
    std::size_t black = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 4)
      black += pixels[i] == 0 && pixels[i + 1] == 0 && pixels[i + 2] == 0;
    return black;
  }
  std::vector<TerrainForm> forms() const {
    std::vector<TerrainForm> forms{TerrainForm::tiles};
    if (database->patches()) forms.push_back(TerrainForm::patches);
    if (database->staticLod()) forms.push_back(TerrainForm::static_trees);
    return forms;
  }
  FrameRequest lowView(std::mt19937& random, TerrainForm form) const {
    std::uniform_real_distribution<double> place(0.1, 0.9), unit(0, 1);
    const double east = place(random), north = place(random), aboveM = 20 * std::pow(20.0, unit(random));
    FrameRequest r = request(over(east, north, aboveM),
                             {Degrees{360 * unit(random)}, Degrees{-12 + 14 * unit(random)}, Degrees{0}});
    r.view.widthPx = kWide, r.view.heightPx = kHigh;
    r.terrain.form = form;
    r.staticLod.error = ErrorMeasure::maximum;
    r.levers.drawn.errorPx = r.levers.drawn.treeErrorPx = 2;
    return r;
  }
  /// Whether something farther, or sky, shows beneath ground: where a package holds no scenery, or its
  /// triangles leave a gap, the eye sees far terrain from below, of which no error is promised.
  bool looksThroughAHole(const FrameRequest& r) {
    constexpr float kOverhang = 1.02f;  // a steep hillside aside of the image's middle has less
    picture(scene::referenceOf(r));
    const std::vector<float> distances = renderer.readDistances();
    for (std::size_t i = kWide; i < distances.size(); ++i)
      if (distances[i - kWide] > kOverhang * distances[i]) return true;
    return false;
  }
  void prove(const FrameRequest& r) {
    SCOPED_TRACE(testing::Message() << std::setprecision(17) << "form " << static_cast<int>(r.terrain.form)
                                    << " from " << r.eye.latitude.value() << ' ' << r.eye.longitude.value()
                                    << ' ' << r.eye.height.value() << ' ' << r.attitude.heading.value() << ' '
                                    << r.attitude.pitch.value());
    scene::ErrorPictures pictures;
    const FrameError finest = measure(scene::referenceOf(r), nullptr, &pictures);
    EXPECT_EQ(blackPixels(pictures.reference), 0u) << "in the reference";
    EXPECT_EQ(finest.geometricMaxPx, 0) << "of the reference from itself";
    const FrameError error = measure(r, nullptr, &pictures);
    EXPECT_EQ(blackPixels(pictures.ours), 0u) << "in the image";
    EXPECT_EQ(error.wronglyCulledPixels, 0u);
    EXPECT_LE(error.geometricMaxPx, geometricBoundPx(r));
  }
};

TEST_P(SliversOver, noPixelIsBlackAndNoErrorIsUnreal) {
  const std::string folder = GetParam();
  TRIMTAB_NEEDS_SHARED("data/" + folder);
  offscreen->resize(kWide, kHigh);
  measureOver(bakeShared(folder));
  ASSERT_TRUE(database);
  std::mt19937 random(17);
  int holes = 0;
  for (int i = 0; i < soak(); ++i)
    for (const TerrainForm form : forms()) {
      const FrameRequest r = lowView(random, form);
      if (form == TerrainForm::static_trees && looksThroughAHole(r))
        ++holes;
      else
        prove(r);
    }
  EXPECT_LE(holes, (soak() + 1) / 2) << "of the views of static trees";
}
INSTANTIATE_TEST_SUITE_P(Sceneries, SliversOver,
                         testing::Values("fg-debian-hawaii-bigisland", "fg-kansai-e135n35",
                                         "fg-debian-iceland-reykjanes"));

}  // namespace
}  // namespace trimtab::test
