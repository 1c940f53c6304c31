// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/editors/membership_editor.h"

#include <QContextMenuEvent>
#include <QSignalSpy>
#include <QTableView>
#include <QTimer>
#include <cmath>

#include "application.h"
#include "live_flight.h"
#include "views/editors/curve_plot.h"
#include "views/model/keys.h"

namespace trimtab::views {
namespace {

using test::curveOf;
using test::drag;

class MembershipEditorTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(editor_, {640, 640}); }

  CurvePlot& plot() { return editor_.altitude().plot(); }
  CurvePoints curve() const { return curveOf(draft_, key::kAltitudeCurve); }
  QPointF pixel(std::size_t point) { return plot().pixelOf(curve().point[point]); }
  bool type(int row, int column, const QString& text) {
    QAbstractItemModel* model = editor_.altitude().table().model();
    return model->setData(model->index(row, column), text, Qt::EditRole);
  }

  Draft draft_;
  MembershipEditor editor_{draft_};
};

TEST_F(MembershipEditorTest, dragMovesTheBreakpointInOneStepAndUndoRestoresIt) {
  const CurvePoints before = curve();
  drag(plot(), pixel(1), pixel(1) + QPointF(20, -40));
  const CurvePoints after = curve();
  EXPECT_GT(after.point[1].x, before.point[1].x);
  EXPECT_GT(after.point[1].y, before.point[1].y);
  const double unitsPerPixel = plot().xAxis->range().size() / plot().axisRect()->width();
  EXPECT_NEAR(after.point[1].x - before.point[1].x, 20 * unitsPerPixel, 2 * unitsPerPixel);
  EXPECT_EQ(draft_.undoStack().count(), 1);
  EXPECT_EQ(draft_.active()->altitude.curve.point[1], after.point[1]) << "what runs follows the drag";
  draft_.undoStack().undo();
  EXPECT_EQ(curve(), before);
}

TEST_F(MembershipEditorTest, grabbingWithoutMovingChangesNothing) {
  drag(plot(), pixel(1) + QPointF(3, 3), pixel(1) + QPointF(3, 3), true, 1);
  EXPECT_EQ(draft_.undoStack().count(), 0);
  EXPECT_EQ(plot().selected(), 1);
}

TEST_F(MembershipEditorTest, neighboursAndTheScaleStopADrag) {
  drag(plot(), pixel(1), pixel(3) + QPointF(30, 400));
  EXPECT_LT(curve().point[1].x, curve().point[2].x);
  EXPECT_EQ(curve().point[1].x, 5999);
  EXPECT_EQ(curve().point[1].y, 0);
  drag(plot(), pixel(1), QPointF(0, -200));
  EXPECT_EQ(curve().point[1].x, 4001);
  EXPECT_EQ(curve().point[1].y, 1);
  EXPECT_FALSE(draft_.isBroken());
}

TEST_F(MembershipEditorTest, escapeCancelsADragWithoutAStep) {
  const CurvePoints before = curve();
  drag(plot(), pixel(2), pixel(2) + QPointF(15, 30), false);
  EXPECT_NE(curve(), before);
  QTest::keyClick(&plot(), Qt::Key_Escape);
  EXPECT_EQ(curve(), before);
  EXPECT_EQ(draft_.undoStack().count(), 0);
  QTest::mouseMove(&plot(), (pixel(2) + QPointF(30, 30)).toPoint());
  EXPECT_EQ(curve(), before) << "the drag is over though the button is still down";
}

TEST_F(MembershipEditorTest, doubleClickAddsAndDeleteRemovesAPoint) {
  const QPoint at = plot().pixelOf({5500, 0.8}).toPoint();
  QTest::mouseDClick(&plot(), Qt::LeftButton, Qt::NoModifier, at);
  ASSERT_EQ(curve().size, 6u);
  EXPECT_NEAR(curve().point[2].x, 5500, 30);
  EXPECT_NEAR(curve().point[2].y, 0.8, 0.02);
  EXPECT_EQ(plot().selected(), 2);
  QTest::keyClick(&plot(), Qt::Key_Delete);
  EXPECT_EQ(curve().size, 5u);
  QTest::keyClick(&plot(), Qt::Key_Home);
  QTest::keyClick(&plot(), Qt::Key_Insert);
  ASSERT_EQ(curve().size, 6u);
  EXPECT_EQ(curve().point[1], (CurvePoint{4500, 0.8}));
}

TEST_F(MembershipEditorTest, twoPointsStay) {
  plot().select(0);
  QSignalSpy refused(&plot(), &CurvePlot::refused);
  for (int i = 0; i < 10; ++i) QTest::keyClick(&plot(), Qt::Key_Delete);
  EXPECT_EQ(curve().size, 2u);
  EXPECT_EQ(refused.count(), 7);
}

TEST_F(MembershipEditorTest, aFullCurveTakesNoMorePoints) {
  QSignalSpy refused(&plot(), &CurvePlot::refused);
  for (int i = 0; i < 40; ++i) plot().addPoint({8100.0 + 100 * i, 0});
  EXPECT_EQ(curve().size, CurvePoints::kCapacity);
  EXPECT_EQ(refused.count(), 40 - static_cast<int>(CurvePoints::kCapacity - 5));
  EXPECT_FALSE(draft_.isBroken());
}

TEST_F(MembershipEditorTest, arrowKeysNudgeByTheRowsStep) {
  plot().setFocus();
  plot().select(1);
  QTest::keyClick(&plot(), Qt::Key_Right);
  EXPECT_EQ(curve().point[1].x, 5000 + findRow(key::kAltitudeCurve)->step);
  QTest::keyClick(&plot(), Qt::Key_Up);
  EXPECT_DOUBLE_EQ(curve().point[1].y, 0.61);
  QTest::keyClick(&plot(), Qt::Key_Down, Qt::ShiftModifier);
  EXPECT_DOUBLE_EQ(curve().point[1].y, 0.51);
  EXPECT_EQ(draft_.undoStack().count(), 3);
  QTest::keyPress(&plot(), Qt::Key_Left);
  QTest::keyPress(&plot(), Qt::Key_Left);
  QTest::keyPress(&plot(), Qt::Key_Left);
  QTest::keyRelease(&plot(), Qt::Key_Left);
  EXPECT_EQ(draft_.undoStack().count(), 4) << "a key held down is one step";
}

TEST_F(MembershipEditorTest, tabWalksThroughThePointsAndOn) {
  editor_.activateWindow();
  plot().setFocus(Qt::TabFocusReason);
  ASSERT_EQ(plot().selected(), 0);
  for (int i = 1; i < 5; ++i) {
    QTest::keyClick(&plot(), Qt::Key_Tab);
    EXPECT_EQ(plot().selected(), i);
  }
  QTest::keyClick(&plot(), Qt::Key_Tab);
  EXPECT_FALSE(plot().hasFocus());
}

TEST_F(MembershipEditorTest, typedValuesAreTakenOrRefusedWithAReason) {
  EXPECT_TRUE(type(1, 0, "5,250 ft"));
  EXPECT_EQ(curve().point[1].x, 5250);
  EXPECT_TRUE(type(1, 1, "0.55"));
  EXPECT_EQ(curve().point[1].y, 0.55);
  QSignalSpy refused(editor_.altitude().table().model(), SIGNAL(refused(QString)));
  const char* const bad[] = {"", "high", "6001", "3999", "nan", "inf", "5250 m", "1e400"};
  for (const char* text : bad) EXPECT_FALSE(type(1, 0, text)) << text;
  const char* const badMemberships[] = {"", "1.0001", "-0.1", "nan", "half"};
  for (const char* text : badMemberships) EXPECT_FALSE(type(1, 1, text)) << text;
  EXPECT_EQ(refused.count(), 13);
  EXPECT_TRUE(refused.at(2).at(0).toString().contains("neighbours"));
  EXPECT_EQ(curve().point[1], (CurvePoint{5250, 0.55}));
  EXPECT_EQ(draft_.undoStack().count(), 2);
}

TEST_F(MembershipEditorTest, twoPointsTypedAtOneXAreAStepAndAThirdIsRefused) {
  EXPECT_TRUE(type(1, 0, "6000"));
  EXPECT_EQ(curve().point[1].x, curve().point[2].x);
  EXPECT_FALSE(draft_.isBroken());
  EXPECT_FALSE(type(3, 0, "6000")) << "a third point at one x means nothing";
  EXPECT_FALSE(draft_.isBroken());
}

TEST_F(MembershipEditorTest, enterTypesTheSelectedPoint) {
  editor_.activateWindow();
  plot().setFocus();
  plot().select(1);
  QTest::keyClick(&plot(), Qt::Key_Return);
  QWidget* cell = QApplication::focusWidget();
  ASSERT_NE(cell, &plot());
  QTest::keyClicks(cell, "5300");
  QTest::keyClick(cell, Qt::Key_Return);
  QCoreApplication::processEvents();
  EXPECT_EQ(curve().point[1].x, 5300);
  EXPECT_TRUE(plot().accessibleDescription().startsWith("Breakpoint 2 of 5: 5,300 ft"));
}

TEST_F(MembershipEditorTest, whatTheReadingComputesIsDrawn) {
  draft_.setValue(key::kAltitudeReading, ChoiceIndex{1});
  // equation_a jumps from 0.7 to 0.6 at 5000 ft (document A, Eq. 1 against Table 1).
  const QCPGraph* effective = plot().graph(3);
  double below = 0, at = 0;
  for (const QCPGraphData& d : *effective->data()) {
    if (d.key < 5000) below = d.value;
    if (d.key == 5000) at = d.value;
  }
  EXPECT_NEAR(below, 0.7, 1e-3);
  EXPECT_NEAR(at, 0.6, 1e-3);
  EXPECT_TRUE(plot().graph(2)->visible()) << "the straight lines differ, so they are drawn too";
  draft_.setValue(key::kAltitudeReading, ChoiceIndex{0});
  EXPECT_FALSE(plot().graph(2)->visible());
}

TEST_F(MembershipEditorTest, pointsThatTheReadingIgnoresAreNotEdited) {
  draft_.setValue(key::kPitchReading, ChoiceIndex{1});
  CurvePlot& pitch = editor_.pitch().plot();
  const CurvePoints before = curveOf(draft_, key::kPitchCurve);
  drag(pitch, pitch.pixelOf(before.point[0]), pitch.pixelOf({0, 0.5}));
  pitch.addPoint({0, 0.5});
  EXPECT_EQ(curveOf(draft_, key::kPitchCurve), before);
}

TEST_F(MembershipEditorTest, theOperatingPointIsTheDecisions) {
  LiveFrame frame;
  DecisionMemory memory;
  frame.decision = decide(test::inputAt(6500, 5), draft_.active(), memory);
  editor_.showFrame(frame);
  const auto data = plot().graph(4)->data();
  ASSERT_TRUE(test::eventually([&] { return data->size() == 1; }));
  EXPECT_NEAR(data->begin()->key, 6500, 1e-9);
  EXPECT_NEAR(data->begin()->value, 0.2, 1e-12);
}

TEST(Throttle, refreshesAtMostOnceAPeriodAndNotWhileHidden) {
  QWidget probe;
  int refreshes = 0;
  constexpr int kPeriodMs = 66;
  Throttle counted(
      &probe, [&] { ++refreshes; }, kPeriodMs);
  for (int i = 0; i < 100; ++i) counted.request();
  QTest::qWait(100);
  EXPECT_EQ(refreshes, 0) << "hidden";
  test::expose(probe, {100, 100});
  EXPECT_TRUE(test::eventually([&] { return refreshes == 1; })) << "what was asked for while hidden";
  QElapsedTimer timer;
  timer.start();
  while (timer.elapsed() < 300) {
    counted.request();
    QCoreApplication::processEvents();
  }
  EXPECT_LE(refreshes, 2 + static_cast<int>(timer.elapsed() / kPeriodMs));
  const int now = refreshes;
  QTest::qWait(100);
  EXPECT_LE(refreshes, now + 1) << "idle";
}

TEST_F(MembershipEditorTest, theFilesCurveAndAPinnedOneStayBehindWhatIsDragged) {
  EXPECT_FALSE(plot().ghosts().isShown(Reference::file)) << "nothing was changed";
  drag(plot(), pixel(1), pixel(1) + QPointF(20, -40));
  EXPECT_TRUE(plot().ghosts().isShown(Reference::file));
  EXPECT_FALSE(plot().ghosts().isShown(Reference::pinned));
  draft_.pin("snapshot A", draft_.parameters());
  EXPECT_FALSE(plot().ghosts().isShown(Reference::pinned)) << "it is the same curve";
  drag(plot(), pixel(2), pixel(2) + QPointF(0, -40));
  EXPECT_TRUE(plot().ghosts().isShown(Reference::pinned));
  EXPECT_FALSE(editor_.pitch().plot().ghosts().isShown(Reference::file)) << "only where it differs";
  draft_.resetAll();
  EXPECT_FALSE(plot().ghosts().isShown(Reference::file));
}

TEST_F(MembershipEditorTest, severalPointsAreMovedNudgedAndRemovedTogether) {
  const CurvePoints before = curve();
  plot().select(1);
  QTest::mouseClick(&plot(), Qt::LeftButton, Qt::ControlModifier, pixel(2).toPoint());
  EXPECT_EQ(plot().group(), (std::vector<std::size_t>{1, 2}));
  drag(plot(), pixel(1), pixel(1) + QPointF(8, 0));
  const double by = curve().point[1].x - before.point[1].x;
  EXPECT_GT(by, 0);
  EXPECT_NEAR(curve().point[2].x - before.point[2].x, by, 1e-9);
  EXPECT_EQ(curve().point[0], before.point[0]);
  EXPECT_EQ(draft_.undoStack().count(), 1);
  plot().setFocus();
  QTest::keyClick(&plot(), Qt::Key_Left);
  EXPECT_LT(curve().point[2].x - before.point[2].x, by);
  drag(plot(), pixel(2), pixel(2) + QPointF(2000, 0));
  EXPECT_LT(curve().point[2].x, curve().point[3].x) << "the others stop the group";
  EXPECT_NEAR(curve().point[2].x - curve().point[1].x, before.point[2].x - before.point[1].x, 1e-9);
  QTest::keyClick(&plot(), Qt::Key_Delete);
  EXPECT_EQ(curve().size, before.size - 2);
  QTest::keyClick(&plot(), Qt::Key_A, Qt::ControlModifier);
  EXPECT_EQ(plot().group().size(), curve().size);
  QTest::keyClick(&plot(), Qt::Key_Delete);
  EXPECT_EQ(curve().size, before.size - 2) << "two points stay";
}

TEST_F(MembershipEditorTest, aRectangleDrawnOverEmptySpaceSelectsThePointsWithinToMoveThemTogether) {
  const CurvePoints before = curve();
  ASSERT_GE(before.size, 4u);
  const auto around = [&](std::size_t first, std::size_t last) {
    const QPointF a = pixel(first), b = pixel(last);
    return std::pair{QPointF(std::min(a.x(), b.x()) - 14, std::min(a.y(), b.y()) - 14),
                     QPointF(std::max(a.x(), b.x()) + 14, std::max(a.y(), b.y()) + 14)};
  };
  plot().select(0);
  const auto [from, to] = around(1, 2);
  drag(plot(), from, to);
  EXPECT_EQ(plot().group(), (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(curve(), before) << "selecting moves nothing";
  EXPECT_EQ(draft_.undoStack().count(), 0);
  drag(plot(), pixel(2), pixel(2) + QPointF(8, 0));
  EXPECT_GT(curve().point[1].x, before.point[1].x);
  EXPECT_GT(curve().point[2].x, before.point[2].x);
  EXPECT_EQ(draft_.undoStack().count(), 1) << "they move in one step";
  draft_.undoStack().undo();
  EXPECT_EQ(curve(), before);

  const auto [third, end] = around(3, 3);
  QTest::mousePress(&plot(), Qt::LeftButton, Qt::ControlModifier, third.toPoint());
  QTest::mouseMove(&plot(), end.toPoint());
  QTest::mouseRelease(&plot(), Qt::LeftButton, Qt::ControlModifier, end.toPoint());
  EXPECT_EQ(plot().group(), (std::vector<std::size_t>{1, 2, 3})) << "Ctrl adds to what is selected";
  QTest::mousePress(&plot(), Qt::LeftButton, Qt::NoModifier, from.toPoint());
  QTest::mouseMove(&plot(), to.toPoint());
  QTest::keyClick(&plot(), Qt::Key_Escape);
  QTest::mouseRelease(&plot(), Qt::LeftButton, Qt::NoModifier, to.toPoint());
  EXPECT_TRUE(plot().group().empty()) << "Escape gives up the rectangle";
}

TEST_F(MembershipEditorTest, theMenuOfOneOfSeveralPointsKeepsThem) {
  plot().select(1);
  plot().toggle(2);
  const auto openAt = [&](std::size_t point) {
    QTimer::singleShot(0, &plot(), [] {
      if (QWidget* menu = QApplication::activePopupWidget()) menu->close();
    });
    const QPoint at = pixel(point).toPoint();
    QContextMenuEvent event(QContextMenuEvent::Mouse, at, plot().mapToGlobal(at));
    QApplication::sendEvent(&plot(), &event);
  };
  openAt(2);
  EXPECT_EQ(plot().group(), (std::vector<std::size_t>{1, 2}));
  openAt(0);
  EXPECT_EQ(plot().group(), std::vector<std::size_t>{0}) << "another point is selected alone";
}

TEST(Throttle, whatIsAskedForWhileTheWindowIsMinimisedFollowsWhenItIsBack) {
  QWidget window, *probe = new QWidget(&window);
  int refreshes = 0;
  auto* counted = new Throttle(probe, [&] { ++refreshes; });
  test::expose(window, {100, 100});
  window.setWindowState(Qt::WindowMinimized);
  counted->request();
  QTest::qWait(100);
  EXPECT_EQ(refreshes, 0);
  window.setWindowState(Qt::WindowNoState);
  EXPECT_TRUE(test::eventually([&] { return refreshes == 1; }));
}

}  // namespace
}  // namespace trimtab::views
