// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/plots_panel.h"

#include <QFileDialog>
#include <QLineEdit>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>
#include <cmath>

#include "plots_panel_fixture.h"
#include "views/controls/ask_csv_file.h"
#include "views/panels/plot_values.h"

namespace trimtab::views {
namespace {

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
  const double secondsPerPixel = before.size() / plot().laneRect(0)->width();
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
    const char* signal;
    Trace trace;
    double scale, tolerance;
  } rows[] = {{"altitude membership", Trace::altitude_membership, 1, 1e-4},
              {"pitch membership", Trace::pitch_membership, 1, 1e-4},
              {"total membership", Trace::total_membership, 1, 1e-4},
              {"triangles (k)", Trace::triangles, 1e-3, 0.01},
              {"frame (ms)", Trace::frame_ms, 1, 1e-3},
              {"rate (fps)", Trace::fps, 1, 0.01},
              {"cull (ms)", Trace::cull_ms, 1, 1e-3},
              {"draw (ms)", Trace::draw_ms, 1, 1e-3},
              {"select (ms)", Trace::select_ms, 1, 1e-3},
              {"GPU (ms)", Trace::gpu_ms, 1, 1e-3},
              {"line of sight (deg/s)", Trace::line_of_sight_degps, 1, 0.1},
              {"LOD scale", Trace::lod_scale, 1, 1e-2},
              {"vertices (k)", Trace::vertices, 1e-3, 0.01}};
  for (const auto& [signal, trace, scale, tolerance] : rows) {
    const int row = rowOf(QString::fromUtf8(signal));
    const double at = buffer.value(trace, a) * scale, bt = buffer.value(trace, b) * scale;
    const auto number = [&](int column) { return QLocale().toDouble(readout(row, column)); };
    EXPECT_NEAR(number(1), at, tolerance) << signal;
    EXPECT_NEAR(number(2), bt, tolerance) << signal;
    EXPECT_NEAR(number(3), bt - at, tolerance) << signal;
  }
}

TEST(PlotLanes, readTheFormerNameOfTheLineOfSight) {
  const auto lanes = lanesOf(QStringLiteral("head_rate_degps lod_scale"));
  ASSERT_TRUE(lanes);
  EXPECT_EQ(toText(*lanes), QStringLiteral("line_of_sight_degps lod_scale"));
}

TEST_F(PlotsPanelTest, aCursorBesideTheDataKeepsItsTimeAndHasNoValue) {
  plot().setShown(newest() - 30, newest() + 30);
  panel_.setCursors(true);
  plot().moveCursor(0, newest() + 4);
  plot().moveCursor(1, newest() + 24);
  EXPECT_NEAR(QLocale().toDouble(readout(0, 3)), 20, 1e-3) << "20 s apart, not 0";
  EXPECT_EQ(readout(rowOf("frame (ms)"), 1), QStringLiteral("–"));
  EXPECT_EQ(readout(rowOf("frame (ms)"), 3), QStringLiteral("–"));
}

TEST_F(PlotsPanelTest, pausedNothingRecordedSinceIsReadDrawnOrSaved) {
  panel_.clear();
  addFrames(600);  // ten seconds: the right of the plot is empty
  ASSERT_TRUE(test::eventually([&] { return plot().frameAt(newest()).has_value(); }));
  plot().refresh(true);
  panel_.setPaused(true);
  const double held = newest();
  addFrames(1200);
  emit plot().tracked(held + 15);
  EXPECT_TRUE(panel_.trackedText().contains("no frame")) << panel_.trackedText().toStdString();
  draft_.setValue("measure.budget_ms", 8.3);  // draws again
  const auto data = plot().traces().front()->data();
  EXPECT_LE((data->constEnd() - 1)->key, held);
  EXPECT_EQ(panel_.visibleRangeCsv().count('\n'), 601);
  panel_.setPaused(false);
  EXPECT_TRUE(plot().frameAt(held + 15).has_value());
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

TEST_F(PlotsPanelTest, anAbsentValueIsOneGapAtEveryZoomAndAShortAbsenceIsNone) {
  const auto addFramesOfGpu = [&](int frames, double ms) {
    for (int i = 0; i < frames; ++i) {
      LiveFrame frame = flight_.next(draft_.active());
      frame.cost.gpu = ms;
      panel_.showFrame(frame);
    }
  };
  const auto gpu =
      std::ranges::find(plot().traces(), Trace::gpu_ms, [](const TraceGraph* t) { return t->look().trace; });
  ASSERT_NE(gpu, plot().traces().end());
  const auto gaps = [&](double spanS) {
    plot().setSpan(spanS);
    const auto data = (*gpu)->data();
    return std::count_if(data->begin(), data->end(),
                         [](const QCPGraphData& d) { return std::isnan(d.value); });
  };
  addFramesOfGpu(60 * 100, 3);
  for (const int absent : {1, 7, 30}) {
    addFramesOfGpu(absent, std::nan(""));
    addFramesOfGpu(60, 3);
  }
  for (const double spanS : {6, 10, 60}) EXPECT_EQ(gaps(spanS), 0) << spanS;
  addFramesOfGpu(60 * 3, std::nan(""));
  addFramesOfGpu(60, 3);
  for (const double spanS : {6, 10, 60}) EXPECT_EQ(gaps(spanS), 1) << spanS;
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
  const auto top = [&] { return plot().laneRect(2)->axis(QCPAxis::atLeft)->range().upper; };
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
  slow.cost.total = 45;
  panel_.showFrame(slow);
  EXPECT_TRUE(test::eventually([&] { return top() > 45; }));
  EXPECT_EQ(longest(), QString());
}

TEST_F(PlotsPanelTest, aJumpOfTheViewDoesNotFlattenTheRatesOfTheHead) {
  const auto top = [&] { return plot().laneRect(0)->axis(QCPAxis::atRight)->range().upper; };
  panel_.clear();
  LiveFrame turning = flight_.next(draft_.active());
  for (int i = 0; i < 600; ++i) {
    turning = flight_.next(draft_.active());
    turning.decision.motion.rateDegPerS = i == 300 ? 50'000 : 180;
    panel_.showFrame(turning);
  }
  plot().refresh(true);
  EXPECT_LE(top(), 700);
  plot().setRobust(false);
  EXPECT_GE(top(), 50'000) << "the whole range is a choice";
}

TEST_F(PlotsPanelTest, aJumpBesideTheFirstFewTurnsOfTheHeadDoesNotFlattenThem) {
  panel_.clear();
  for (int i = 0; i < 600; ++i) {
    LiveFrame frame = flight_.next(draft_.active());
    frame.decision.motion.rateDegPerS = i == 100 ? 50'000 : i >= 200 && i < 206 ? 180 : 0;
    panel_.showFrame(frame);
  }
  plot().refresh(true);
  EXPECT_LE(plot().laneRect(0)->axis(QCPAxis::atRight)->range().upper, 700);
}

TEST_F(PlotsPanelTest, legendsLieAboveTheirPlotsAndNoNameIsCut) {
  for (const QSize size : {QSize(1000, 240), QSize(640, 240), QSize(320, 420), QSize(640, 700)}) {
    panel_.resize(size);
    for (int round = 0; round < 3; ++round) {
      QCoreApplication::processEvents();
      plot().refresh(false);
      plot().replot(QCustomPlot::rpImmediateRefresh);
    }
    // Two columns may round up to a pixel more than there is.
    const QRect whole = plot().rect().adjusted(0, 0, 1, 1);
    std::vector<QRect> taken;
    for (std::size_t lane = 0; lane < plot().lanes().size(); ++lane)
      taken.push_back(plot().laneRect(lane)->outerRect());
    for (const auto* legend : plot().findChildren<QCPLegend*>()) {
      if (!legend->visible()) continue;
      EXPECT_TRUE(whole.contains(legend->outerRect())) << size.width();
      for (const QRect& rect : taken) EXPECT_FALSE(rect.intersects(legend->outerRect())) << size.width();
      for (int i = 0; i < legend->elementCount(); ++i) {
        const auto* item = qobject_cast<QCPAbstractLegendItem*>(legend->elementAt(i));
        if (item == nullptr) continue;
        EXPECT_GE(item->outerRect().width(), item->minimumOuterSizeHint().width()) << size.width();
        EXPECT_LE(item->outerRect().right(), whole.right()) << size.width();
      }
    }
    for (std::size_t lane = 0; lane < plot().lanes().size(); ++lane)
      EXPECT_GE(plot().laneRect(lane)->rect().height(), 40) << "room for a curve";
  }
}

TEST_F(PlotsPanelTest, theWheelScrollsLanesThatHaveNoRoom) {
  panel_.resize(320, 300);
  QCoreApplication::processEvents();
  auto* area = panel_.findChild<QScrollArea*>();
  ASSERT_GT(area->verticalScrollBar()->maximum(), 0);
  const double span = plot().shown().size();
  const auto turn = [&](Qt::KeyboardModifiers keys) {
    const QPointF at(100, 60);
    QWheelEvent wheel(at, plot().mapToGlobal(at), {}, {0, -120}, Qt::NoButton, keys, Qt::NoScrollPhase,
                      false);
    // Only what comes from outside the program goes on to the parents.
    QSpontaneKeyEvent::setSpontaneous(&wheel);
    qApp->notify(&plot(), &wheel);
  };
  turn(Qt::NoModifier);
  EXPECT_GT(area->verticalScrollBar()->value(), 0);
  EXPECT_EQ(plot().shown().size(), span);
  turn(Qt::ControlModifier);
  EXPECT_GT(plot().shown().size(), span);
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

TEST_F(PlotsPanelTest, aSignalThatIsMeasuredBelowZeroIsInTheLegend) {
  plot().setLanes({{{Trace::altitude_ft, Trace::climb_ftpmin}}});
  panel_.clear();
  for (int i = 0; i < 60; ++i) {
    LiveFrame frame = flight_.next(draft_.active());
    frame.input.signalValues[Signal::climb] = -800;
    panel_.showFrame(frame);
  }
  plot().refresh(true);
  bool named = false;
  for (const auto* legend : plot().findChildren<QCPLegend*>())
    for (int i = 0; i < legend->elementCount(); ++i)
      if (auto* item = qobject_cast<QCPPlottableLegendItem*>(legend->elementAt(i)))
        named = named || item->plottable()->name().contains("climb");
  EXPECT_TRUE(named);
}

TEST_F(PlotsPanelTest, clearEmptiesTheRangeBesideTheValues) {
  panel_.setCursors(true);
  ASSERT_NE(readout(0, PlotValues::kLeast), "–");
  panel_.clear();
  EXPECT_EQ(readout(0, PlotValues::kLeast), "–");
  EXPECT_EQ(readout(0, PlotValues::kLargest), "–");
}

}  // namespace
}  // namespace trimtab::views
