// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/plots_panel.h"

#include <QFileDialog>
#include <QLineEdit>
#include <QTableWidget>
#include <QTimer>
#include <cmath>

#include "application.h"
#include "live_flight.h"
#include "views/controls/ask_csv_file.h"
#include "views/plots/time_plot.h"

namespace trimtab::views {
namespace {

class PlotsPanelTest : public testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 60 * 100; ++i) panel_.showFrame(flight_.next(draft_.active()));
    test::expose(panel_, {640, 640});
    ASSERT_TRUE(test::eventually([&] { return plot().shown().upper == newest(); }));
  }
  TimePlot& plot() { return panel_.plot(); }
  double newest() const { return panel_.buffer().time(panel_.buffer().end() - 1); }
  QString readout(int row, int column) { return panel_.readout().item(row, column)->text(); }

  Draft draft_;
  test::LiveFlight flight_{100};
  PlotsPanel panel_{draft_};
};

TEST_F(PlotsPanelTest, followsTheNewestFrame) {
  EXPECT_DOUBLE_EQ(plot().shown().size(), 60);
  for (int i = 0; i < 60; ++i) panel_.showFrame(flight_.next(draft_.active()));
  EXPECT_TRUE(test::eventually([&] { return plot().shown().upper == newest(); }));
}

TEST_F(PlotsPanelTest, pausedItHoldsThePictureAndRecordsOn) {
  panel_.setPaused(true);
  const QCPRange held = plot().shown();
  const auto frames = panel_.buffer().end();
  for (int i = 0; i < 120; ++i) panel_.showFrame(flight_.next(draft_.active()));
  QTest::qWait(200);
  EXPECT_EQ(plot().shown(), held);
  EXPECT_EQ(panel_.buffer().end(), frames + 120);
  QTest::keyClick(&plot(), Qt::Key_Space);
  EXPECT_FALSE(panel_.isPaused());
  EXPECT_TRUE(test::eventually([&] { return plot().shown().upper == newest(); }));
}

TEST_F(PlotsPanelTest, panningStopsFollowingAndMovesByTheDrag) {
  const QCPRange before = plot().shown();
  const QPointF from = plot().pixelOfTime(before.center());
  test::drag(plot(), from, from + QPointF(80, 0));
  const double secondsPerPixel = before.size() / plot().axisRect(0)->width();
  EXPECT_NEAR(before.lower - plot().shown().lower, 80 * secondsPerPixel, 2 * secondsPerPixel);
  const QCPRange held = plot().shown();
  for (int i = 0; i < 60; ++i) panel_.showFrame(flight_.next(draft_.active()));
  QTest::qWait(200);
  EXPECT_EQ(plot().shown(), held);
  QTest::keyClick(&plot(), Qt::Key_F);
  EXPECT_TRUE(test::eventually([&] { return plot().shown().upper == newest(); }));
}

TEST_F(PlotsPanelTest, zoomingWhileFollowingKeepsTheNewestFrameAtTheEdge) {
  QTest::keyClick(&plot(), Qt::Key_Plus);
  EXPECT_NEAR(plot().shown().size(), 48, 1e-9);
  EXPECT_DOUBLE_EQ(plot().shown().upper, newest());
}

TEST_F(PlotsPanelTest, csvIsTheShownRangeFrameByFrame) {
  plot().setShown(120, 121.5);
  const QStringList lines = panel_.visibleRangeCsv().split('\n', Qt::SkipEmptyParts);
  int expected = 0;
  for (std::uint64_t f = panel_.buffer().begin(); f < panel_.buffer().end(); ++f)
    if (panel_.buffer().time(f) >= 120 && panel_.buffer().time(f) <= 121.5) ++expected;
  ASSERT_EQ(lines.size() - 1, expected);
  EXPECT_EQ(expected, 91);
  EXPECT_GE(lines[1].section(',', 0, 0).toDouble(), 120);
  EXPECT_LE(lines.last().section(',', 0, 0).toDouble(), 121.5);
}

TEST_F(PlotsPanelTest, cursorsReadFramesAndTheirDifference) {
  plot().setShown(130, 150);
  panel_.setCursors(true);
  ASSERT_TRUE(panel_.readout().isVisible());
  test::drag(plot(), plot().pixelOfTime(plot().cursor(0)), plot().pixelOfTime(133));
  EXPECT_NEAR(plot().cursor(0), 133, 0.05);
  plot().moveCursor(1, 147.5);
  const TraceBuffer& buffer = panel_.buffer();
  const std::uint64_t a = buffer.nearest(plot().cursor(0)), b = buffer.nearest(147.5);
  EXPECT_NEAR(readout(0, 3).toDouble(), buffer.time(b) - buffer.time(a), 1e-3);
  const struct {
    int row;
    Trace trace;
    double scale, tolerance;
  } rows[] = {{1, Trace::altitude_membership, 1, 1e-4},
              {2, Trace::pitch_membership, 1, 1e-4},
              {3, Trace::total_membership, 1, 1e-4},
              {4, Trace::triangles, 1e-3, 0.01},
              {5, Trace::frame_ms, 1, 1e-3},
              {6, Trace::fps, 1, 0.01},
              {7, Trace::draw_ms, 1, 1e-3},
              {8, Trace::cull_ms, 1, 1e-3},
              {11, Trace::select_ms, 1, 1e-3},
              {12, Trace::gpu_ms, 1, 1e-3},
              {16, Trace::head_rate_degps, 1, 0.1},
              {17, Trace::lod_scale, 1, 1e-2},
              {18, Trace::vertices, 1e-3, 0.01}};
  for (const auto& [row, trace, scale, tolerance] : rows) {
    const double at = buffer.value(trace, a) * scale, bt = buffer.value(trace, b) * scale;
    const auto number = [&](int column) { return QLocale().toDouble(readout(row, column)); };
    EXPECT_NEAR(number(1), at, tolerance) << row;
    EXPECT_NEAR(number(2), bt, tolerance) << row;
    EXPECT_NEAR(number(3), bt - at, tolerance) << row;
  }
}

TEST_F(PlotsPanelTest, arrowKeysMoveTheChosenCursor) {
  panel_.setCursors(true);
  const double a = plot().cursor(0), b = plot().cursor(1);
  QTest::keyClick(&plot(), Qt::Key_Right);
  EXPECT_GT(plot().cursor(0), a);
  QTest::keyClick(&plot(), Qt::Key_B);
  QTest::keyClick(&plot(), Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_LT(plot().cursor(1), b);
}

TEST_F(PlotsPanelTest, drawsNoMorePointsThanTheScreenNeeds) {
  for (int i = 0; i < 60 * 1800; ++i) panel_.showFrame(flight_.next(draft_.active()));
  plot().setSpan(1800);
  for (const TraceGraph* trace : plot().traces())
    EXPECT_LE(trace->data()->size(), 4 * plot().width()) << trace->name().toStdString();
}

TEST_F(PlotsPanelTest, drawsNoLineAcrossAStretchWithoutFrames) {
  LiveFrame frame;
  frame.time = newest() + 20;
  panel_.showFrame(frame);
  plot().setSpan(60);
  const auto data = plot().traces().front()->data();
  EXPECT_EQ(
      std::count_if(data->begin(), data->end(), [](const QCPGraphData& d) { return std::isnan(d.value); }),
      1);
}

TEST_F(PlotsPanelTest, aWideAndLowDockHasItsLanesTwoByTwo) {
  EXPECT_EQ(plot().plotLayout()->columnCount(), 1);
  panel_.resize(900, 280);
  EXPECT_TRUE(test::eventually([&] { return plot().plotLayout()->columnCount() == 2; }));
  EXPECT_EQ(plot().plotLayout()->rowCount(), 2);
  panel_.resize(640, 640);
  EXPECT_TRUE(test::eventually([&] { return plot().plotLayout()->columnCount() == 1; }));
  EXPECT_EQ(plot().plotLayout()->rowCount(), 4);
}

TEST_F(PlotsPanelTest, aFrameThatTookSecondsIsNamedAndDoesNotFlattenTheOthers) {
  const auto longest = [&] {
    for (int i = 0; i < plot().itemCount(); ++i)
      if (const auto* text = qobject_cast<QCPItemText*>(plot().item(i)))
        if (text->visible() && text->text().contains(QStringLiteral("longest"))) return text->text();
    return QString();
  };
  const auto top = [&] { return plot().axisRect(2)->axis(QCPAxis::atLeft)->range().upper; };
  const double before = top();
  EXPECT_EQ(longest(), QString());
  LiveFrame slow = flight_.next(draft_.active());
  slow.cost.total = 3020;
  panel_.showFrame(slow);
  EXPECT_TRUE(test::eventually([&] { return longest().contains(QStringLiteral("3,020 ms")); }));
  EXPECT_LE(top(), 4 * before);
  // One that is longer by little is shown whole.
  panel_.clear();
  for (int i = 0; i < 600; ++i) panel_.showFrame(flight_.next(draft_.active()));
  slow = flight_.next(draft_.active());
  slow.cost.total = 55;
  panel_.showFrame(slow);
  EXPECT_TRUE(test::eventually([&] { return top() > 55; }));
  EXPECT_EQ(longest(), QString());
}

TEST_F(PlotsPanelTest, theBudgetLineFollowsTheActivePreset) {
  draft_.setValue("measure.budget_ms", 8.3);
  bool found = false;
  for (int i = 0; i < plot().itemCount(); ++i)
    if (const auto* line = qobject_cast<QCPItemStraightLine*>(plot().item(i)))
      found = found || line->point1->value() == 8.3;
  EXPECT_TRUE(found);
}

TEST_F(PlotsPanelTest, clearForgetsEverything) {
  panel_.setCursors(true);
  panel_.clear();
  EXPECT_TRUE(panel_.buffer().empty());
  EXPECT_EQ(panel_.visibleRangeCsv().count('\n'), 1);
  for (int i = 0; i < 10; ++i) panel_.showFrame(flight_.next(draft_.active()));
  QTest::qWait(150);
  EXPECT_EQ(panel_.buffer().end(), 10u);
}

TEST(AskCsvFile, aNameWithoutAnEndingGetsOne) {
  QWidget parent;
  QTimer::singleShot(0, &parent, [] {
    auto* dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
    ASSERT_NE(dialog, nullptr);
    dialog->findChild<QLineEdit*>()->setText(QDir::tempPath() + "/no-such-trimtab-table");
    static_cast<QDialog*>(dialog)->accept();
  });
  EXPECT_EQ(askCsvFile(&parent, "Save", "frames.csv"), QDir::tempPath() + "/no-such-trimtab-table.csv");
}

}  // namespace
}  // namespace trimtab::views
