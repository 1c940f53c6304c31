#include <gmock/gmock.h>

#include <cmath>

#include "tests/core/rig/profiles.h"
#include "trimtab/preset/preset.h"
#include "trimtab/rig/fit_flight.h"
#include "trimtab/rig/fitted_preset.h"
#include "trimtab/session/session.h"

namespace trimtab {
namespace {

using test::viewer;

constexpr int kWidth = 160, kHeight = 96;

/// An image generator whose images are known: the load falls by 0.6 an octave of LOD scale and a fifth of it
/// goes with half the far distance; an image shows the same pattern, moved by so many pixels an octave.
class Planted {
 public:
  FrameRequest request() const {
    FrameRequest r;
    r.view.widthPx = kWidth, r.view.heightPx = kHeight;
    r.eye = {Degrees{36}, Degrees{128}, Metres{1000}};
    return r;
  }
  static double load(const FrameLevers& drawn, double view) {
    const double nearer = drawn.farM < 80000 ? 0.8 : 1;
    return (10000 + 100 * view) * std::pow(0.6, std::log2(drawn.lodScale)) * nearer;
  }
  static double ms(double load) { return 4 + load / 2000; }
  static std::vector<std::uint8_t> image(double movedPx) {
    std::vector<std::uint8_t> rgba(std::size_t{4} * kWidth * kHeight, 255);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const double u = x - movedPx;
        double value = 128;
        for (int wave = 1; wave <= 8; ++wave)
          value += 14 * std::sin((0.1 + 0.07 * wave) * (u * std::cos(2.4 * wave) + y * std::sin(2.4 * wave)));
        for (int c = 0; c < 3; ++c)
          rgba[4 * static_cast<std::size_t>(y * kWidth + x) + static_cast<std::size_t>(c)] =
              static_cast<std::uint8_t>(std::lround(value));
      }
    return rgba;
  }

  /// Draws views until `views` are complete, as a program does that knows nothing of the fit.
  void fly(FitFlight& fit, std::size_t views, bool pictures) {
    while (fit.views() < views) {
      FrameRequest r = request();
      fit.setLevers(r);
      const FrameLevers& drawn = r.levers.drawn;
      const double l = load(drawn, static_cast<double>(fit.views()));
      FrameCost cost;
      cost.total = ms(l) * (++images_ % 7 == 0 ? 3 : 1);  // another program runs now and then
      if (pictures) fit.picture(image(0.75 * (drawn.lodScale - 1)), kWidth, kHeight);
      fit.finished(r, cost, l);
    }
  }

 private:
  int images_ = 0;
};

IgFit flown(bool pictures) {
  FitFlight flight(viewer());
  Planted().fly(flight, 30, pictures);
  const Result<IgFit> fit = flight.result();
  EXPECT_TRUE(fit.ok()) << toString(fit.findings());
  return *fit;
}

const LeverPoint& pointAt(const IgFit& fit, std::string_view lever, double value) {
  for (const LeverPoint& p : fit.points)
    if (kFrameLeverRows[p.row].key == lever && std::abs(p.value - value) < 1e-6 * value) return p;
  ADD_FAILURE() << "no point of " << lever << " at " << value;
  return fit.points.front();
}

TEST(FitFlight, movesOneLeverAtATimeOverEachView) {
  FitFlight flight(viewer());
  const std::size_t perView = flight.imagesPerView();
  EXPECT_EQ(perView, 2 * (1 + 3 + 4)) << "neutral, LOD scale 2, 4, 8, far distance 40, 20, 10 and 5 km";
}

TEST(FitFlight, findsWhatWasPlanted) {
  const IgFit fit = flown(false);
  EXPECT_EQ(fit.views, 30u);
  EXPECT_NEAR(fit.timeMs, Planted::ms(Planted::load({}, 14.5)), 0.1);
  EXPECT_NEAR(fit.loadLow, 10100, 60);
  EXPECT_NEAR(fit.loadHigh, 12800, 60);
  for (const auto& [scale, share] : {std::pair{2.0, 0.6}, {4.0, 0.36}, {8.0, 0.216}}) {
    const LeverPoint& p = pointAt(fit, "lod_scale", scale);
    EXPECT_NEAR(p.load.median, share, 1e-9);
    EXPECT_LE(p.time.low, p.time.median);
    EXPECT_NEAR(p.time.median, Planted::ms(11450 * share) / Planted::ms(11450), 0.02);
    EXPECT_TRUE(std::isnan(p.flip)) << "no image was given";
  }
  EXPECT_NEAR(pointAt(fit, "far_distance", 20000).load.median, 0.8, 1e-9);
  const LoadShape shape{1, 0.6, 0.36, 0.216, 0.216};
  for (std::size_t k = 0; k < shape.size(); ++k) EXPECT_NEAR(fit.shape[k], shape[k], 1e-9) << k;
  CostModel model;
  model.restore(fit.cost);
  const FrameLoad load{11000, 0, 1e-6 * kWidth * kHeight, 0, false};
  EXPECT_NEAR(predict(model.coefficients(load), load).total(), Planted::ms(11000), 1);
}

TEST(FitFlight, knowsWhatARangeWithoutOctavesLeaves) {
  IgProfile narrow = viewer();
  narrow.levers[0].own = {1, 1.5};
  FitFlight flight(narrow);
  Planted().fly(flight, 20, false);
  const LoadShape shape = flight.result()->shape;
  EXPECT_EQ(shape[0], 1);
  for (std::size_t k = 1; k < shape.size(); ++k)
    EXPECT_NEAR(shape[k], std::pow(0.6, std::log2(1.5)), 1e-9) << "the end of the range leaves so much";
  narrow.levers[0].own = {1, 3};
  FitFlight wider(narrow);
  Planted().fly(wider, 20, false);
  EXPECT_NEAR(wider.result()->shape[1], 0.6, 1e-9);
  EXPECT_NEAR(wider.result()->shape[2], std::pow(0.6, std::log2(3)), 1e-9);
}

TEST(FitFlight, readsPixelsFromImages) {
  const IgFit fit = flown(true);
  EXPECT_NEAR(fit.neutralPx, 0.75, 0.1);
  EXPECT_NEAR(pointAt(fit, "lod_scale", 4).shiftPx, 2.25, 0.15);
  EXPECT_GT(pointAt(fit, "lod_scale", 4).flip, pointAt(fit, "lod_scale", 2).flip);
  EXPECT_EQ(pointAt(fit, "far_distance", 20000).flip, 0) << "the planted image does not show it";
}

TEST(FitFlight, readsNoPixelsWhereNothingMovesOrMostChangesItsColours) {
  // Images show the pattern at rest; where the LOD scale is large, a part of them in other colours.
  for (const double changed : {0.0, 0.7}) {
    FitFlight flight(viewer());
    while (flight.views() < kFewestFitViews) {
      FrameRequest r = Planted().request();
      flight.setLevers(r);
      std::vector<std::uint8_t> image = Planted::image(r.levers.drawn.lodScale > 1 && changed > 0 ? 3 : 0);
      const auto from = static_cast<std::size_t>((1 - changed) * static_cast<double>(image.size()));
      if (r.levers.drawn.lodScale > 1)
        for (std::size_t i = from; i < image.size(); ++i)
          image[i] = static_cast<std::uint8_t>(255 - image[i]);
      flight.picture(image, kWidth, kHeight);
      FrameCost cost;
      cost.total = 10;
      flight.finished(r, cost, 1000);
    }
    EXPECT_TRUE(std::isnan(flight.result()->neutralPx)) << changed;
  }
}

TEST(FitFlight, refusesWhatSaysNothing) {
  FitFlight few(viewer());
  Planted().fly(few, kFewestFitViews - 1, false);
  const Result<IgFit> part = few.result();
  ASSERT_TRUE(part) << "what is known so far is worth a look";
  EXPECT_EQ(fittedTo(viewer(), *part, {}, "p").findings().front().key, "views");
  EXPECT_EQ(FitFlight(viewer()).result().findings().front().key, "views");
  FitFlight unmeasured(viewer());
  while (unmeasured.views() < kFewestFitViews) {
    FrameRequest r = Planted().request();
    unmeasured.setLevers(r);
    unmeasured.finished(r, {}, 0);
  }
  EXPECT_EQ(unmeasured.result().findings().front().key, "total_ms");
}

TEST(IgFit, readsBackAsItWasWritten) {
  for (const bool pictures : {false, true}) {
    const IgFit fit = flown(pictures);
    const Result<IgFit> read = parseIgFit(fitText(fit), "fit.json");
    ASSERT_TRUE(read.ok()) << toString(read.findings());
    EXPECT_EQ(fitText(*read), fitText(fit));
    EXPECT_THAT(report(*read, viewer()), testing::HasSubstr("LODScale 4: time "));
  }
}

TEST(IgFit, ofDamageIsRefusedByKey) {
  const std::string good = fitText(flown(false));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return parseIgFit(text, "fit.json");
  };
  EXPECT_EQ(with("\"shape\": [1,", "\"shape\": [0,").findings().front().key, "shape");
  EXPECT_EQ(with("\"load_low\": ", "\"load_low\": -").findings().front().key, "load_low");
  EXPECT_EQ(with("\"load_low\": ", "\"load_low\": 1").findings().front().key, "load_high");
  EXPECT_EQ(with("\"lever\": \"lod_scale\"", "\"lever\": \"lod\"").findings().front().key, "points");
  EXPECT_EQ(with("processor.band", "processor.bind").findings().front().key, "cost.processor.band");
  EXPECT_FALSE(parseIgFit(good.substr(0, good.size() / 2), "fit.json").ok());
  EXPECT_FALSE(parseIgFit(test::kViewer, "fit.json").ok());
}

/// The allowed error that `low-level` decides after an image of so many triangles.
double errorAfter(const TuningParameters& preset, std::uint64_t triangles) {
  const auto valid = validate(preset);
  EXPECT_TRUE(valid.ok()) << toString(valid.findings());
  Session session(*valid);
  AircraftState state;
  state.position = {Degrees{36}, Degrees{128}, Metres{1000}};
  double errorPx = 0;
  for (int i = 0; i < 120; ++i) {
    state.time = i / 60.0;
    session.fly(state);
    FrameResult drawn;
    drawn.visible.triangles = triangles;
    drawn.cost.total = 10;
    errorPx = session.request(state.time, kWidth, kHeight)->levers.drawn.errorPx;
    session.finished(drawn, state.time);
  }
  return errorPx;
}

TEST(FittedPreset, makesAPolicyWorkThatDidNothing) {
  const TuningParameters shipped = loadPreset("low-level")->parameters;
  IgFit fit = flown(false);
  fit.loadLow = 4000, fit.loadHigh = 18000;
  const Result<TuningParameters> fitted = fittedTo(viewer(), fit, shipped, "low-level");
  ASSERT_TRUE(fitted.ok()) << toString(fitted.findings());
  EXPECT_EQ(fitted->policy.terms.line.front(), "triangles many = ramp 4000 18000");
  EXPECT_NEAR(errorAfter(shipped, 4000), 1, 0.1);
  EXPECT_NEAR(errorAfter(shipped, 18000), 1, 0.1) << "the shipped policy begins at 50,000";
  EXPECT_NEAR(errorAfter(*fitted, 4000), 2, 0.1) << "the image generator draws nothing finer than neutral";
  EXPECT_NEAR(errorAfter(*fitted, 18000), 5.6, 0.3);
}

TEST(FittedPreset, movesTermsOfEveryShape) {
  TuningParameters p;
  p.policy.terms.line = {"triangles a = ramp 0 1000",      "triangles b = points 0 1 500 0.5 1000 0",
                         "triangles c = gaussian 500 100", "triangles d = bell 500 100 2",
                         "triangles e = sigmoid 500 0.01", "triangles f = trapezoid -inf 0 200 400",
                         "altitude low = ramp 5000 1000"};
  IgFit fit = flown(false);
  fit.loadLow = 100, fit.loadHigh = 200;
  const Result<TuningParameters> fitted = fittedTo(viewer(), fit, p, "p");
  ASSERT_TRUE(fitted.ok());
  EXPECT_THAT(
      fitted->policy.terms.line,
      testing::ElementsAre("triangles a = ramp 100 200", "triangles b = points 100 1 150 0.5 200 0",
                           "triangles c = gaussian 150 10", "triangles d = bell 150 10 2",
                           "triangles e = sigmoid 150 0.1", "triangles f = trapezoid -inf 100 120 140",
                           "altitude low = ramp 5000 1000"));
}

TEST(FittedPreset, keepsTermsApartThatLieClose) {
  TuningParameters p;
  p.policy.terms.line = {"triangles a = ramp 0 1000000", "triangles b = ramp 500000 500100"};
  IgFit fit = flown(false);
  fit.loadLow = 123441, fit.loadHigh = 123449;
  const Result<TuningParameters> fitted = fittedTo(viewer(), fit, p, "p");
  ASSERT_TRUE(fitted.ok());
  EXPECT_TRUE(validate(*fitted).ok()) << toString(validate(*fitted).findings());
}

TEST(FittedPreset, takesPixelsAndLossesFromImages) {
  TuningParameters p;
  const IgFit fit = flown(true);
  const Result<TuningParameters> fitted = fittedTo(viewer(), fit, p, "p");
  EXPECT_NEAR(fitted->lod.screenSpaceError.value(), 0.75, 0.1);
  EXPECT_NEAR(fitted->hold.errorMaximum.value(), 8 * fitted->lod.screenSpaceError.value(), 0.05);
  EXPECT_NE(fitted->hold.lossError, p.hold.lossError);
  EXPECT_EQ(fitted->hold.lossRenderScale, p.hold.lossRenderScale)
      << "the image generator has no render scale";
}

TEST(FittedPreset, refusesAFitOfAnother) {
  IgFit fit = flown(false);
  fit.ig = "another";
  EXPECT_EQ(fittedTo(viewer(), fit, {}, "p").findings().front().key, "ig");
}

}  // namespace
}  // namespace trimtab
