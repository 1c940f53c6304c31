// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/plots/surface_plot.h"

#include <cmath>

#include "application.h"
#include "live_flight.h"
#include "views/plots/contour.h"

namespace trimtab::views {
namespace {

class SurfacePlotTest : public testing::Test {
 protected:
  void SetUp() override {
    test::expose(plot_, {560, 420});
    ASSERT_TRUE(test::eventually([&] { return plot_.computed() > 0; }));
  }
  /// What the running program decides there, without a history.
  double decided(double altitude, double pitch) {
    DecisionMemory memory;
    return decide(test::inputAt(altitude, pitch), draft_.active(), memory).totalMembership;
  }
  const QCPColorMap& map() { return *qobject_cast<QCPColorMap*>(plot_.plottable(0)); }
  void settleAfter(int computed) {
    ASSERT_TRUE(test::eventually([&] { return plot_.computed() > computed; }));
  }

  Draft draft_;
  SurfacePlot plot_{draft_};
};

TEST_F(SurfacePlotTest, drawsTheTotalOfEveryCombinationAndReading) {
  for (std::size_t combination = 0; combination < 2; ++combination)
    for (std::size_t reading = 0; reading < 2; ++reading) {
      const int before = plot_.computed();
      draft_.setValue("fuzzy.altitude.reading", ChoiceIndex{reading});
      draft_.setValue("fuzzy.pitch.reading", ChoiceIndex{reading});
      if (combination > 0) draft_.setValue("fuzzy.combination", ChoiceIndex{combination});
      if (combination + reading > 0) settleAfter(before);
      QCPColorMapData& cells = *map().data();
      for (int x = 0; x < cells.keySize(); x += 24)
        for (int y = 0; y < cells.valueSize(); y += 16) {
          double altitude = 0, pitch = 0;
          cells.cellToCoord(x, y, &altitude, &pitch);
          // decide() takes metres: their feet are off by an ulp, which counts where a reading jumps.
          EXPECT_NEAR(cells.cell(x, y), decided(altitude, pitch), reading == 0 ? 1e-9 : 0.11)
              << altitude << " ft, " << pitch << " deg";
        }
      EXPECT_EQ(map().dataRange().lower, 0);
      EXPECT_EQ(map().dataRange().upper, 2);
    }
}

TEST_F(SurfacePlotTest, linesLieOnTheEdgesOfTheBands) {
  std::size_t points = 0;
  for (const QCPCurveData& point : *plot_.edges().data()) {
    if (std::isnan(point.key)) continue;
    const double total = decided(point.key, point.value);
    double nearest = 2;
    for (const Band& band : draft_.active()->scheme.bands.span())
      nearest = std::min(nearest, std::abs(total - band.low));
    EXPECT_LT(nearest, 0.01) << point.key << " ft, " << point.value << " deg";
    ++points;
  }
  EXPECT_GT(points, 500u);
}

TEST_F(SurfacePlotTest, isComputedAnewOnlyWhenTheDecisionOrTheViewChanges) {
  const int before = plot_.computed();
  draft_.setValue("lod.scale", 3.0);
  test::LiveFlight flight;
  for (int i = 0; i < 600; ++i) plot_.showFrame(flight.next(draft_.active()));
  QTest::qWait(250);
  EXPECT_EQ(plot_.computed(), before);
  draft_.setValue("fuzzy.bands_px", BandList{{0.4, 64, 64}});
  settleAfter(before);
  const int after = plot_.computed();
  plot_.xAxis->setRange(4000, 6000);
  settleAfter(after);
  plot_.fitView();
  EXPECT_LT(plot_.xAxis->range().lower, 4000);
  EXPECT_GT(plot_.xAxis->range().upper, 8000);
}

TEST_F(SurfacePlotTest, aBrokenDraftLeavesTheActiveSurface) {
  const int before = plot_.computed();
  draft_.setValue("fuzzy.hysteresis", 0.4);
  ASSERT_TRUE(draft_.isBroken());
  QTest::qWait(200);
  EXPECT_EQ(plot_.computed(), before);
}

TEST_F(SurfacePlotTest, theTrackIsThePlacesThatWereDecidedAndStaysShort) {
  test::LiveFlight flight;
  for (int i = 0; i < 60 * 600; ++i) {
    const LiveFrame frame = flight.next(draft_.active());
    plot_.showFrame(frame);
    ASSERT_NEAR(plot_.track().back().x, frame.decision.altitudeFt, 15.01);
    ASSERT_NEAR(plot_.track().back().y, frame.decision.pitchDeg, 0.1501);
  }
  EXPECT_GT(plot_.track().size(), 500u);
  EXPECT_LE(plot_.track().size(), 4000u);
  const std::size_t size = plot_.track().size();
  LiveFrame nowhere;
  nowhere.decision.reason = SchemeReason::invalid_input;
  plot_.showFrame(nowhere);
  EXPECT_EQ(plot_.track().size(), size);
  plot_.clearTrack();
  EXPECT_TRUE(plot_.track().empty());
}

TEST_F(SurfacePlotTest, saysTheTotalAndDepthMapUnderTheMouse) {
  const QPoint at(static_cast<int>(plot_.xAxis->coordToPixel(4000)),
                  static_cast<int>(plot_.yAxis->coordToPixel(-15)));
  QTest::mouseMove(&plot_, at);
  EXPECT_TRUE(test::eventually([&] { return plot_.hoverText().contains(QStringLiteral("800 × 600")); }))
      << qPrintable(plot_.hoverText());
  EXPECT_TRUE(std::isnan(plot_.totalAt(-50000, 0)));
  EXPECT_NEAR(plot_.totalAt(4000, -15), 1.75, 1e-12);
}

TEST(Contour, isWhereAPlaneHasTheLevel) {
  std::vector<double> values;
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 13; ++x) values.push_back(0.3 * x + 0.7 * y);
  const auto pieces = contour({13, 9, values}, 3.1);
  ASSERT_GT(pieces.size(), 8u);
  double length = 0;
  for (const auto& [from, to] : pieces) {
    EXPECT_NEAR(0.3 * from.x + 0.7 * from.y, 3.1, 1e-12);
    EXPECT_NEAR(0.3 * to.x + 0.7 * to.y, 3.1, 1e-12);
    length += std::hypot(to.x - from.x, to.y - from.y);
  }
  // From (10.33, 0) to (0, 4.43), by hand.
  EXPECT_NEAR(length, std::hypot(3.1 / 0.3, 3.1 / 0.7), 1e-9);
}

TEST(Contour, ofASaddleFollowsItsMean) {
  const auto pieces = contour({2, 2, std::vector<double>{1, 0, 0, 1}}, 0.4);
  ASSERT_EQ(pieces.size(), 2u) << "the middle, 0.5, is above: the corners at 0 are cut off";
  for (const auto& [from, to] : pieces) {
    const bool lowerRight = from.x > 0.5 || from.y < 0.5;
    const double cornerX = lowerRight ? 1 : 0, cornerY = lowerRight ? 0 : 1;
    for (const ContourPoint& p : {from, to})
      EXPECT_NEAR(std::hypot(p.x - cornerX, p.y - cornerY), 0.4, 1e-12);
  }
}

TEST(Contour, ofAFlatSurfaceOrNoneIsEmpty) {
  EXPECT_TRUE(contour({3, 3, std::vector<double>(9, 1.0)}, 1.0).empty());
  EXPECT_TRUE(contour({3, 3, std::vector<double>(9, 1.0)}, 0.5).empty());
  EXPECT_TRUE(contour({1, 3, std::vector<double>(3, 1.0)}, 0.5).empty());
  EXPECT_TRUE(contour({0, 0, {}}, 0.5).empty());
}

}  // namespace
}  // namespace trimtab::views
