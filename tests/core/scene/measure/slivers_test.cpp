#include <array>

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

}  // namespace
}  // namespace trimtab::test
