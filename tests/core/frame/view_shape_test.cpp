#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "trimtab/frame/frame.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

double tanDeg(double degrees) {
  return std::tan(degrees * std::numbers::pi / 180);
}

ViewParameters fromHost() {
  ViewParameters p;
  p.source = ViewSource::host;
  return p;
}
HostView half(double left, double right, double bottom, double top) {
  return {std::nullopt, Degrees{left}, Degrees{right}, Degrees{bottom}, Degrees{top}};
}

TEST(ViewShape, takesFieldOfViewAndNearPlaneFromTheParameters) {
  ViewParameters p;
  p.horizontalFov = Degrees{90};
  p.verticalFov = Degrees{40};
  p.nearDistance = Metres{0.5};
  const ViewShape shape = viewShape(p, 640, 480, std::nullopt);
  EXPECT_NEAR(shape.right, 1, 1e-15);
  EXPECT_NEAR(shape.left, -1, 1e-15);
  EXPECT_NEAR(shape.top, tanDeg(20), 1e-15);
  EXPECT_NEAR(shape.bottom, -tanDeg(20), 1e-15);
  EXPECT_EQ(shape.nearM, 0.5);
  EXPECT_EQ(shape.widthPx, 640);
  EXPECT_EQ(shape.heightPx, 480);
}

TEST(ViewShape, isAsLargeAsTheWindowOrAsTheParametersSay) {
  ViewParameters p;
  EXPECT_EQ(viewShape(p, 0, -3, std::nullopt).widthPx, 1) << "a minimised window";
  EXPECT_EQ(viewShape(p, 0, -3, std::nullopt).heightPx, 1);
  p.renderSize = RenderSize::fixed;
  p.width = Pixels{1920};
  p.height = Pixels{1080};
  EXPECT_EQ(viewShape(p, 640, 480, std::nullopt).widthPx, 1920);
  EXPECT_EQ(viewShape(p, 640, 480, std::nullopt).heightPx, 1080);
}

TEST(ViewShape, followsTheHostOnlyWhereThePresetSaysSo) {
  const HostView asked = half(-10, 20, -5, 15);
  EXPECT_EQ(viewShape(ViewParameters{}, 640, 480, asked),
            viewShape(ViewParameters{}, 640, 480, std::nullopt));
  const ViewShape shape = viewShape(fromHost(), 640, 480, asked);
  EXPECT_NEAR(shape.left, -tanDeg(10), 1e-15);
  EXPECT_NEAR(shape.right, tanDeg(20), 1e-15);
  EXPECT_NEAR(shape.bottom, -tanDeg(5), 1e-15);
  EXPECT_NEAR(shape.top, tanDeg(15), 1e-15);
  EXPECT_EQ(viewShape(fromHost(), 640, 480, std::nullopt),
            viewShape(ViewParameters{}, 640, 480, std::nullopt));
}

TEST(ViewShape, growsAtTwoSidesToFillAWindow) {
  const ViewShape square{.widthPx = 600, .heightPx = 600, .left = -0.5, .right = 1, .bottom = -1, .top = 0.5};
  EXPECT_EQ(filledShape(square), square) << "it fills already";
  ViewShape wide = square, high = square;
  wide.widthPx = 1800;
  high.heightPx = 1200;
  ViewShape wider = wide, higher = high;
  wider.left = -1.5, wider.right = 3;
  higher.bottom = -2, higher.top = 1;
  EXPECT_EQ(filledShape(wide), wider);
  EXPECT_EQ(filledShape(high), higher);
  // Nothing fits these, so they stay.
  for (const auto& [left, right] : {std::pair{0.5, 0.5}, {1.0, -1.0}, {std::nan(""), 1.0}}) {
    ViewShape odd = square;
    odd.left = left;
    odd.right = right;
    const ViewShape same = filledShape(odd);
    EXPECT_EQ(same.right, odd.right);
    EXPECT_EQ(same.top, odd.top);
  }
}

TEST(ViewShape, completesWhatTheHostLeavesOut) {
  HostView asked;
  asked.right = Degrees{45};
  const ViewShape shape = viewShape(fromHost(), 640, 480, asked);
  EXPECT_NEAR(shape.right, 1, 1e-15);
  EXPECT_NEAR(shape.left, -tanDeg(30), 1e-15);
  EXPECT_NEAR(shape.top, tanDeg(18), 1e-15);
}

TEST(ViewShape, allowsAViewThatLooksAside) {
  const ViewShape shape = viewShape(fromHost(), 640, 480, half(10, 50, -60, -20));
  EXPECT_NEAR(shape.left, tanDeg(10), 1e-15);
  EXPECT_NEAR(shape.top, -tanDeg(20), 1e-15);
}

TEST(ViewShape, ignoresHalfAnglesThatMakeNoView) {
  const ViewShape preset = viewShape(fromHost(), 640, 480, std::nullopt);
  for (const HostView& bad :
       {half(20, -20, -10, 10), half(0, 0, -10, 10), half(-90, 20, -10, 10), half(-20, 120, -10, 10),
        half(kNan, 20, -10, 10), half(-20, kInfinity, -10, 10), half(-kInfinity, 20, -10, 10)}) {
    const ViewShape shape = viewShape(fromHost(), 640, 480, bad);
    EXPECT_EQ(shape.left, preset.left);
    EXPECT_EQ(shape.right, preset.right);
    EXPECT_NEAR(shape.top, tanDeg(10), 1e-15) << "the other axis holds";
  }
  const ViewShape upsideDown = viewShape(fromHost(), 640, 480, half(-10, 10, 5, -5));
  EXPECT_EQ(upsideDown.bottom, preset.bottom);
  EXPECT_EQ(upsideDown.top, preset.top);
}

TEST(ViewShape, ignoresANearPlaneThatIsNone) {
  for (const double bad : {0.0, -1.0, kNan, kInfinity, -kInfinity}) {
    HostView asked;
    asked.nearDistance = Metres{bad};
    EXPECT_EQ(viewShape(fromHost(), 640, 480, asked).nearM, 1);
  }
  HostView asked;
  asked.nearDistance = Metres{2.5};
  EXPECT_EQ(viewShape(fromHost(), 640, 480, asked).nearM, 2.5);
}

}  // namespace
}  // namespace trimtab
