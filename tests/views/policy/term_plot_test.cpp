// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/policy/term_plot.h"

#include <QApplication>
#include <QCheckBox>
#include <QClipboard>
#include <QLineEdit>
#include <QSignalSpy>
#include <QTableView>
#include <cmath>

#include "policy_flight.h"
#include "tests/views/application.h"
#include "views/controls/parameter_of.h"
#include "views/panels/symbology_panel.h"
#include "views/policy/policy_live.h"
#include "views/policy/policy_panel.h"
#include "views/policy/signals_list.h"
#include "views/policy/terms_model.h"
#include "views/policy/terms_page.h"

namespace trimtab::views {
namespace {

using test::drag;

class TermPlotTest : public testing::Test {
 protected:
  void SetUp() override {
    test::setSmallPolicy(draft_);
    draft_.undoStack().clear();
    test::expose(panel_, {640, 760});
    panel_.parts().signalsList->choose(Signal::above_ground);
    QCoreApplication::processEvents();
  }
  TermPlot& plot() { return *panel_.parts().plot; }
  TermsPage& page() { return *panel_.parts().terms; }
  QPointF pixel(std::size_t handle) {
    const EditPoint at = plot().points().at(handle);
    return plot().pixelOf(at.x, at.y);
  }
  std::string line(std::size_t i) { return draft_.parameters().policy.terms.line.at(i); }
  void press(QWidget& widget, Qt::Key key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QTest::keyClick(&widget, key, modifiers);
  }

  Draft draft_;
  PolicyPanel panel_{draft_};
};

TEST_F(TermPlotTest, everyPointOfEveryShapeIsDraggedInOneStepAndUndone) {
  for (const char* shape :
       {"points 500 0 1500 1 2500 0", "triangle 500 1500 2500", "trapezoid 500 1200 1800 2500",
        "ramp 1000 2000", "gaussian 1500 400", "bell 1500 400 2", "sigmoid 1500 0.004"}) {
    draft_.setValue("policy.terms",
                    TextLines{{std::string("above_ground low = ") + shape,
                               "above_ground high = ramp 3000 3500", "speed fast = ramp 200 400"}});
    plot().selectTerm(0);
    for (std::size_t i = 0; i < plot().points().size(); ++i) {
      const std::string before = line(0);
      const int steps = draft_.undoStack().index();
      const EditPoint from = plot().points()[i];
      drag(plot(), pixel(i), pixel(i) + QPointF(-23, from.movesY ? 30 : 0));
      EXPECT_NE(line(0), before) << shape << ", " << from.name.toStdString();
      EXPECT_EQ(draft_.undoStack().index(), steps + 1) << shape << ", one drag is one step";
      const double perPixel = plot().xAxis->range().size() / plot().axisRect()->width();
      if (from.movesX) {
        EXPECT_NEAR(plot().points()[i].x - from.x, -23 * perPixel, 6 * perPixel) << shape;
      }
      EXPECT_FALSE(draft_.isBroken());
      EXPECT_EQ(draft_.active()->policy.terms.line[0], line(0)) << "what runs follows the drag";
      draft_.undoStack().undo();
      EXPECT_EQ(line(0), before);
      // Undone steps are pushed off by the next drag.
    }
  }
}

TEST_F(TermPlotTest, escapeCancelsADragWithoutAStep) {
  plot().selectTerm(0);
  const std::string before = line(0);
  drag(plot(), pixel(0), pixel(0) + QPointF(30, 0), false);
  EXPECT_NE(line(0), before);
  press(plot(), Qt::Key_Escape);
  EXPECT_EQ(line(0), before);
  EXPECT_EQ(draft_.undoStack().count(), 0);
  QTest::mouseRelease(&plot(), Qt::LeftButton);
}

TEST_F(TermPlotTest, aPointSnapsToThoseOfOtherTermsUnlessAltIsHeld) {
  plot().selectTerm(0, 0);  // low's foot at 2000; high's top is there too
  drag(plot(), pixel(0), pixel(0) + QPointF(40, 0));
  EXPECT_NE(line(0), "above_ground low = ramp 2000 1000");
  const QPointF back = plot().pixelOf(2000, 0) + QPointF(4, 0);
  drag(plot(), pixel(0), back);
  EXPECT_EQ(line(0), "above_ground low = ramp 2000 1000");
  const QPointF from = pixel(0);
  QTest::mousePress(&plot(), Qt::LeftButton, Qt::NoModifier, from.toPoint());
  for (int i = 1; i <= 4; ++i) {
    QMouseEvent move(QEvent::MouseMove, from + QPointF(i, 0), plot().mapToGlobal(from + QPointF(i, 0)),
                     Qt::NoButton, Qt::LeftButton, Qt::AltModifier);
    QApplication::sendEvent(&plot(), &move);
  }
  QTest::mouseRelease(&plot(), Qt::LeftButton, Qt::NoModifier, (from + QPointF(4, 0)).toPoint());
  EXPECT_NE(line(0), "above_ground low = ramp 2000 1000");
}

TEST_F(TermPlotTest, theKeyboardSelectsNudgesAddsAndRemoves) {
  plot().setFocus();
  press(plot(), Qt::Key_PageDown);
  EXPECT_EQ(plot().term(), 1);
  press(plot(), Qt::Key_PageDown);
  EXPECT_EQ(plot().term(), 0) << "around";
  EXPECT_EQ(plot().selected(), 0);
  press(plot(), Qt::Key_Tab);
  EXPECT_EQ(plot().selected(), 1);
  const double before = plot().points()[1].x;
  press(plot(), Qt::Key_Left);
  const double step = before - plot().points()[1].x;
  EXPECT_GT(step, 0);
  press(plot(), Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_NEAR(before - plot().points()[1].x, 11 * step, step / 10);
  EXPECT_EQ(draft_.undoStack().count(), 2);
  press(plot(), Qt::Key_Tab);
  EXPECT_EQ(plot().selected(), 1) << "Tab leaves behind the last point";
  QSignalSpy refused(&plot(), &TermPlot::refused);
  press(plot(), Qt::Key_Delete);
  EXPECT_EQ(refused.count(), 1) << "a ramp keeps its points";
  EXPECT_NE(page().note(), QString());

  draft_.setValue("policy.terms",
                  TextLines{{"above_ground low = points 0 1 1000 0", "speed fast = ramp 200 400"}});
  plot().selectTerm(0, 0);
  press(plot(), Qt::Key_Insert);
  EXPECT_EQ(line(0), "above_ground low = points 0 1 500 0.5 1000 0");
  press(plot(), Qt::Key_Up);
  EXPECT_EQ(line(0), "above_ground low = points 0 1 500 0.51 1000 0");
  press(plot(), Qt::Key_Delete);
  EXPECT_EQ(line(0), "above_ground low = points 0 1 1000 0");
}

TEST_F(TermPlotTest, severalPointsMoveAndGoTogether) {
  draft_.setValue("policy.terms", TextLines{{"above_ground low = points 0 1 500 0.5 1000 0.25 2000 0",
                                             "speed fast = ramp 200 400"}});
  const std::string before = line(0);
  plot().selectTerm(0, 1);
  draft_.undoStack().clear();
  using Group = std::vector<std::size_t>;
  QTest::mouseClick(&plot(), Qt::LeftButton, Qt::ControlModifier, pixel(2).toPoint());
  EXPECT_EQ(plot().group(), (Group{1, 2}));
  EXPECT_EQ(plot().selected(), 2) << "the last one that was clicked is followed";
  EXPECT_TRUE(plot().accessibleDescription().contains("2 points are selected"));
  const std::vector<EditPoint> from = plot().points();
  drag(plot(), pixel(1), pixel(1) + QPointF(30, 0));
  const std::vector<EditPoint> to = plot().points();
  EXPECT_GT(to[1].x, from[1].x);
  EXPECT_DOUBLE_EQ(to[2].x - to[1].x, 500);
  EXPECT_EQ(to[0].x, 0);
  EXPECT_EQ(to[3].x, 2000);
  EXPECT_EQ(draft_.undoStack().index(), 1) << "one drag is one step";
  draft_.undoStack().undo();
  EXPECT_EQ(line(0), before);

  plot().setFocus();
  press(plot(), Qt::Key_Down);
  EXPECT_EQ(line(0), "above_ground low = points 0 1 500 0.49 1000 0.24 2000 0");
  QTest::mouseClick(&plot(), Qt::LeftButton, Qt::ControlModifier, pixel(1).toPoint());
  EXPECT_EQ(plot().group(), Group{2}) << "a second click takes it out";

  // A rectangle from between the curve and the axis takes the first two points.
  drag(plot(), plot().pixelOf(600, 0.02), plot().pixelOf(-100, 1.05));
  EXPECT_EQ(plot().group(), (Group{0, 1}));
  press(plot(), Qt::Key_Delete);
  EXPECT_EQ(line(0), "above_ground low = points 1000 0.24 2000 0");
  press(plot(), Qt::Key_A, Qt::ControlModifier);
  EXPECT_EQ(plot().group(), (Group{0, 1}));
  QSignalSpy refused(&plot(), &TermPlot::refused);
  press(plot(), Qt::Key_Delete);
  EXPECT_EQ(refused.count(), 1) << "two points stay";
  press(plot(), Qt::Key_Right);
  EXPECT_NEAR(plot().points()[1].x - plot().points()[0].x, 1000, 1e-9);
  QTest::mouseClick(&plot(), Qt::LeftButton, Qt::NoModifier, plot().pixelOf(600, 0.6).toPoint());
  EXPECT_EQ(plot().group(), Group{});
}

TEST_F(TermPlotTest, aShapeIsCopiedToAnotherTerm) {
  plot().setFocus();
  plot().selectTerm(1);
  press(plot(), Qt::Key_C, Qt::ControlModifier);
  plot().selectTerm(0);
  press(plot(), Qt::Key_V, Qt::ControlModifier);
  EXPECT_EQ(line(0), "above_ground low = ramp 1000 2000");
  QApplication::clipboard()->setText(QStringLiteral("triangle 5 4 3"));
  press(plot(), Qt::Key_V, Qt::ControlModifier);
  EXPECT_EQ(line(0), "above_ground low = ramp 1000 2000") << "a shape that does not compile";
  EXPECT_NE(page().note(), QString());
  QApplication::clipboard()->setText(QStringLiteral("nonsense"));
  press(plot(), Qt::Key_V, Qt::ControlModifier);
  EXPECT_EQ(draft_.undoStack().count(), 1);
}

TEST_F(TermPlotTest, termsAreTypedAddedDuplicatedRenamedAndRemoved) {
  QAbstractItemModel& model = *page().table().model();
  const auto type = [&](int row, int column, const char* text) {
    return model.setData(model.index(row, column), QString::fromLatin1(text), Qt::EditRole);
  };
  EXPECT_TRUE(type(0, TermsModel::kNumbers, "1800 900"));
  EXPECT_EQ(line(0), "above_ground low = ramp 1800 900");
  EXPECT_TRUE(type(0, TermsModel::kNumbers, "triangle 0 500 900"));
  EXPECT_EQ(line(0), "above_ground low = triangle 0 500 900");
  EXPECT_TRUE(type(0, TermsModel::kShape, "gaussian"));
  EXPECT_TRUE(line(0).starts_with("above_ground low = gaussian")) << line(0);
  for (const char* bad : {"5", "1 2 3", "x", "1 0", ""})
    EXPECT_FALSE(type(0, TermsModel::kNumbers, bad)) << bad;
  for (const char* bad : {"", "high", "very", "two words", "1st"})
    EXPECT_FALSE(type(0, TermsModel::kName, bad)) << bad;
  EXPECT_TRUE(type(0, TermsModel::kName, "near"));
  EXPECT_EQ(draft_.parameters().policy.rules.line[0].substr(0, 44),
            "if above_ground is near and speed is fast th");
  EXPECT_FALSE(draft_.isBroken()) << "the rules follow";
  draft_.undoStack().undo();
  EXPECT_TRUE(line(0).starts_with("above_ground low")) << "one step for terms and rules";

  page().table().setFocus();
  page().table().setCurrentIndex(model.index(0, 0));
  press(page().table(), Qt::Key_D, Qt::ControlModifier);
  EXPECT_TRUE(line(1).starts_with("above_ground low_2 = gaussian")) << line(1);
  press(page().table(), Qt::Key_Delete);
  EXPECT_TRUE(line(1).starts_with("above_ground high")) << line(1);
  press(page().table(), Qt::Key_Insert);
  EXPECT_TRUE(line(3).starts_with("above_ground term = triangle")) << line(3);
  EXPECT_FALSE(draft_.isBroken());
  page().table().setCurrentIndex(model.index(0, 0));
  const ValidatedParameters running = draft_.active();
  press(page().table(), Qt::Key_Delete);
  EXPECT_TRUE(draft_.isBroken()) << "a rule asks for it";
  EXPECT_EQ(draft_.active()->policy, running->policy) << "the last valid policy keeps running";
  draft_.undoStack().undo();
  EXPECT_FALSE(draft_.isBroken());
}

TEST_F(TermPlotTest, aRefusedTextStaysInTheEditorForCorrection) {
  QTableView& table = page().table();
  table.setFocus();
  table.setCurrentIndex(table.model()->index(0, TermsModel::kNumbers));
  press(table, Qt::Key_F2);
  auto* edit = table.viewport()->findChild<QLineEdit*>();
  ASSERT_NE(edit, nullptr);
  edit->selectAll();
  QTest::keyClicks(edit, QStringLiteral("2000"));
  QTest::keyClick(edit, Qt::Key_Return);
  EXPECT_EQ(edit->text(), QStringLiteral("2000")) << "it stays open";
  EXPECT_TRUE(page().note().contains(QStringLiteral("two numbers"))) << page().note().toStdString();
  EXPECT_EQ(draft_.undoStack().count(), 0);
  QTest::keyClicks(edit, QStringLiteral(" 800"));
  QTest::keyClick(edit, Qt::Key_Return);
  EXPECT_TRUE(test::eventually([&] { return line(0) == "above_ground low = ramp 2000 800"; })) << line(0);
  EXPECT_EQ(page().note(), QString());
}

TEST_F(TermPlotTest, theOperatingPointAndItsTrailFollowTheFlight) {
  test::PolicyFlight flight;
  for (int i = 0; i < 60; ++i) panel_.showFrame(flight.next(draft_.active()));
  QAbstractItemModel& model = *page().table().model();
  const auto now = [&] { return model.index(0, TermsModel::kNow).data().toString(); };
  EXPECT_TRUE(test::eventually([&] { return now() == QStringLiteral("1.00"); })) << now().toStdString();
  QModelIndex value =
      panel_.parts().signalsList->model()->index(SignalsModel::rowOfSignal(Signal::above_ground), 1);
  EXPECT_TRUE(value.data().toString().endsWith(QStringLiteral(" ft")))
      << value.data().toString().toStdString();
  value = panel_.parts().signalsList->model()->index(SignalsModel::rowOfSignal(Signal::head_rate), 1);
  EXPECT_EQ(value.data().toString(), QStringLiteral("unknown"));
  EXPECT_TRUE(value.data(Qt::ToolTipRole).toString().contains(QStringLiteral("there is no head")));
}

TEST_F(TermPlotTest, theFilesTermStaysBehindTheOneThatIsDragged) {
  draft_.markSaved();
  EXPECT_FALSE(plot().ghosts().isShown(Reference::file));
  drag(plot(), pixel(0), pixel(0) + QPointF(25, 0));
  EXPECT_TRUE(plot().ghosts().isShown(Reference::file));
  draft_.pin("snapshot A", draft_.parameters());
  EXPECT_FALSE(plot().ghosts().isShown(Reference::pinned)) << "it has the same term";
  draft_.undoStack().undo();
  EXPECT_FALSE(plot().ghosts().isShown(Reference::file));
  EXPECT_TRUE(plot().ghosts().isShown(Reference::pinned));
}

TEST_F(TermPlotTest, escapeAfterTheDraggedTermWasRemovedChangesNothing) {
  draft_.setValue("policy.terms", TextLines{{"above_ground low = triangle 500 1500 2500"}});
  plot().selectTerm(0);
  drag(plot(), pixel(1), pixel(1) + QPointF(20, 0), false);
  press(plot(), Qt::Key_Delete, Qt::ControlModifier);
  ASSERT_TRUE(draft_.parameters().policy.terms.line.empty());
  press(plot(), Qt::Key_Escape);
  EXPECT_TRUE(draft_.parameters().policy.terms.line.empty());
}

TEST(PolicyTrack, aClearedTrackIsDrawnAgain) {
  PolicyTrack track;
  track.push(1, {});
  const std::uint64_t drawn = track.revision();
  track.clear();
  EXPECT_NE(track.revision(), drawn);
}

TEST(SymbologyPanel, helpFindsTheParameterOfACheckBox) {
  Draft draft;
  SymbologyPanel panel(draft);
  EXPECT_EQ(parameterOf(&panel.showBox(0)), "symbology.pitch_ladder.show");
}

}  // namespace
}  // namespace trimtab::views
