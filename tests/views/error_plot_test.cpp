// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/plots/error_plot.h"

#include <cmath>

#include "application.h"
#include "error_run_sample.h"
#include "trimtab/units/not_finite.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

class ErrorPlotTest : public testing::Test {
 protected:
  void SetUp() override {
    test::expose(plot_, {480, 320});
    plot_.show(test::sampleRun());
    settle();
  }
  void settle() { plot_.replot(QCustomPlot::rpImmediateRefresh); }
  /// How many pixels around a point have the colour.
  int coloured(QPointF at, const QColor& colour) {
    const QImage image = plot_.grab().toImage();
    int found = 0;
    for (int dx = -4; dx <= 4; ++dx)
      for (int dy = -4; dy <= 4; ++dy) {
        const QPoint p = at.toPoint() + QPoint(dx, dy);
        found += image.valid(p) && image.pixelColor(p) == colour;
      }
    return found;
  }

  ErrorPlot plot_;
};

TEST_F(ErrorPlotTest, placesEachPresetAndCaseAtItsMediansWithWhiskersByPercentile) {
  ASSERT_EQ(plot_.points().size(), 3u);
  EXPECT_TRUE(std::isnan(plot_.points()[1].msLow)) << "eleven frames have no 5th percentile";
  ErrorRun twice = test::sampleRun();
  for (ErrorRun::Series& s : twice.series) {
    s.ms += QVector<double>(s.ms);
    for (QVector<double>& errors : s.errors) errors += QVector<double>(errors);
  }
  plot_.show(twice);
  settle();
  const ErrorPlot::Point& fine = plot_.points()[1];
  EXPECT_NEAR(fine.error, 0.02, 1e-12);
  EXPECT_NEAR(fine.ms, 10, 1e-12);
  EXPECT_NEAR(fine.msLow, 9.5, 1e-12);
  EXPECT_NEAR(fine.msHigh, 10.5, 1e-12);
  EXPECT_NEAR(fine.errorLow, 0.015, 1e-12);
  EXPECT_NEAR(fine.errorHigh, 0.025, 1e-12);
  for (const ErrorPlot::Point& p : plot_.points()) {
    EXPECT_TRUE(plot_.axisRect()->rect().contains(plot_.pixelOf(p).toPoint()));
    const int preset = p.series == 2 ? 1 : 0;
    EXPECT_GT(coloured(plot_.pixelOf(p), presetColour(preset, plot_.palette())), 12) << p.series;
  }
}

TEST_F(ErrorPlotTest, theFrontHoldsWhatNothingBeatsInBoth) {
  EXPECT_FALSE(plot_.points()[0].onFront);  // as good as the next, and slower
  EXPECT_TRUE(plot_.points()[1].onFront);
  EXPECT_TRUE(plot_.points()[2].onFront);
}

TEST_F(ErrorPlotTest, noisePutsNothingOnTheFrontAndTakesNothingOffIt) {
  ErrorRun run = test::sampleRun();
  // The coarse preset again, faster in some frames and slower in others; and slower for a FLIP that is
  // smaller in one frame alone.
  ErrorRun::Series again = run.series[2], lucky = run.series[2];
  for (int i = 0; i < again.ms.size(); ++i) again.ms[i] += i % 2 ? 0.05 : -0.06;
  for (double& ms : lucky.ms) ms *= 1.5;
  lucky.errors[0][5] = 0.01;
  lucky.errors[0][6] = 0.0799;
  run.series << again << lucky;
  plot_.show(run);
  EXPECT_TRUE(plot_.points()[2].onFront);
  EXPECT_TRUE(plot_.points()[3].onFront) << "what does not differ shares the front";
  EXPECT_LT(plot_.points()[4].error, plot_.points()[2].error);
  EXPECT_FALSE(plot_.points()[4].onFront) << "two frames of eleven";
  for (ErrorRun::Series& s : run.series) {
    s.ms.resize(5);
    for (QVector<double>& errors : s.errors) errors.resize(5);
  }
  plot_.show(run);
  for (const ErrorPlot::Point& p : plot_.points()) EXPECT_FALSE(p.onFront) << "five frames tell nothing";
}

TEST_F(ErrorPlotTest, anotherErrorMovesThePointsAndLowerLeftStaysBest) {
  const QPointF before = plot_.pixelOf(plot_.points()[2]);
  const QPointF fine = plot_.pixelOf(plot_.points()[1]);
  EXPECT_GT(before.x(), fine.x());
  plot_.showError(1);
  settle();
  ASSERT_EQ(plot_.points().size(), 3u);
  EXPECT_EQ(plot_.points()[0].error, kEqualDb);  // equal pictures: infinite, and drawn all the same
  EXPECT_EQ(plot_.points()[2].error, 30);
  EXPECT_TRUE(plot_.xAxis->rangeReversed());
  EXPECT_GT(plot_.pixelOf(plot_.points()[2]).x(), plot_.pixelOf(plot_.points()[1]).x());
  EXPECT_NE(plot_.pixelOf(plot_.points()[1]), fine);
  EXPECT_TRUE(plot_.points()[0].onFront);
  plot_.select(0);
  EXPECT_TRUE(plot_.selectedText().contains("equal")) << plot_.selectedText().toStdString();
}

TEST_F(ErrorPlotTest, framesWithoutTheErrorAreLeftOutAndAUnitWithoutAnyHasNoPoint) {
  ErrorRun run = test::sampleRun();
  run.series[1].errors[0].fill(kNan);
  for (int i = 0; i < 10; ++i) run.series[2].errors[0][i] = kNan;
  plot_.show(run);
  settle();
  ASSERT_EQ(plot_.points().size(), 2u);
  EXPECT_EQ(plot_.points()[0].series, 0);
  EXPECT_EQ(plot_.points()[1].series, 2);
  EXPECT_NEAR(plot_.points()[1].error, 0.085, 1e-12);
}

TEST_F(ErrorPlotTest, theLivePointMovesAndDrawsATail) {
  plot_.showLive({8, {0.05, 40}});
  settle();
  const QPointF first = plot_.livePixel();
  EXPECT_GT(coloured(first, liveColour(plot_.palette())), 20);
  plot_.showLive({6, {0.06, 35}});
  settle();
  EXPECT_GT(plot_.livePixel().x(), first.x());
  EXPECT_GT(plot_.livePixel().y(), first.y());
  for (int i = 0; i < 60; ++i) plot_.showLive({6, {0.06, 35}});
  EXPECT_EQ(plot_.tail().size(), ErrorPlot::kTail);
  plot_.showLive({6, {kNan, kNan}});  // not measured: no point, and nothing breaks
  settle();
  EXPECT_FALSE(std::isfinite(plot_.livePixel().x()));
  plot_.clearLive();
  EXPECT_TRUE(plot_.tail().empty());
}

TEST_F(ErrorPlotTest, aLivePointOutsideWidensTheView) {
  plot_.showLive({90, {0.9, 10}});
  settle();
  EXPECT_TRUE(plot_.axisRect()->rect().contains(plot_.livePixel().toPoint()));
}

TEST_F(ErrorPlotTest, aLivePointOfAnotherSizeIsToldApartAndLeavesTheAxesToTheResults) {
  const QCPRange before = plot_.yAxis->range();
  plot_.showLive({68, {0.05, 40}, 1107, 621});
  settle();
  EXPECT_EQ(plot_.yAxis->range(), before);
  plot_.select(3);
  EXPECT_TRUE(plot_.selectedText().contains("1107 × 621 px instead of 640 × 360"))
      << plot_.selectedText().toStdString();
  const auto legendNames = [&](const QString& part) {
    for (int i = 0; i < plot_.legend->itemCount(); ++i)
      if (auto* item = qobject_cast<QCPPlottableLegendItem*>(plot_.legend->item(i)))
        if (item->plottable()->name().contains(part)) return true;
    return false;
  };
  EXPECT_TRUE(legendNames("1107 × 621"));
  plot_.showLive({68, {0.05, 40}, 640, 360});
  settle();
  EXPECT_TRUE(plot_.yAxis->range().contains(68));
  EXPECT_FALSE(legendNames("1107 × 621"));
}

TEST_F(ErrorPlotTest, keysChooseAPointAndTellItsNumbersWithUnits) {
  plot_.showLive({8, {0.05, 40}});
  plot_.setFocus();
  for (int i = 0; i < 4; ++i) {
    QTest::keyClick(&plot_, Qt::Key_Right);
    EXPECT_EQ(plot_.selected(), i);
  }
  EXPECT_TRUE(plot_.selectedText().startsWith("live"));
  QTest::keyClick(&plot_, Qt::Key_Right);
  EXPECT_EQ(plot_.selected(), 0);
  QTest::keyClick(&plot_, Qt::Key_Left);
  EXPECT_EQ(plot_.selected(), 3);
  plot_.select(2);
  for (const char* part : {"coarse", "proposed", "11 frames", "FLIP: 0.08", "4 ms"})
    EXPECT_TRUE(plot_.accessibleDescription().contains(part)) << part;
  QTest::keyClick(&plot_, Qt::Key_L);
  EXPECT_TRUE(plot_.logarithmic());
  for (const ErrorPlot::Point& p : plot_.points())
    EXPECT_TRUE(plot_.axisRect()->rect().contains(plot_.pixelOf(p).toPoint()));
}

TEST_F(ErrorPlotTest, thePointerOverAPointTellsItsNumbers) {
  // Sent directly: the platform's own cursor elsewhere would leave the widget again.
  const auto move = [&](QPointF to) {
    QMouseEvent event(QEvent::MouseMove, to, plot_.mapToGlobal(to), Qt::NoButton, Qt::NoButton,
                      Qt::NoModifier);
    QCoreApplication::sendEvent(&plot_, &event);
  };
  move(plot_.pixelOf(plot_.points()[1]));
  EXPECT_EQ(plot_.selected(), 1);
  move({2, 2});
  EXPECT_EQ(plot_.selected(), -1);
}

TEST_F(ErrorPlotTest, theBudgetIsInSight) {
  plot_.setBudget(33);
  settle();
  EXPECT_TRUE(plot_.yAxis->range().contains(33));
}

}  // namespace
}  // namespace trimtab::views
