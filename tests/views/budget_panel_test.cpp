// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/budget_panel.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QListWidget>
#include <QPushButton>
#include <QTableWidget>
#include <QTest>

#include "trimtab/hold/arbiter.h"
#include "views/plots/budget_plot.h"

namespace trimtab::views {
namespace {

LiveFrame frameAt(double time, HoldReason reason, double heldPx) {
  LiveFrame frame;
  frame.time = time;
  frame.newImage = true;
  frame.cost.total = 15;
  frame.cost.gpu = FrameCost::kNotMeasured;
  frame.hold.reason = reason;
  frame.hold.asked = {1, 1, 1, 1};
  frame.hold.held = {heldPx, 0.8, 1, 1};
  frame.hold.heldMs = {12, 2, 0, 0.5};
  frame.hold.askedMs = {20, 4, 0, 0.5};
  frame.hold.limitMs = 15.4;
  frame.hold.bandMs = 1.5;
  frame.holdOutcome = HoldOutcome{3, 110, 100, 14, 1.5, 15};
  return frame;
}

/// Waits longer than a panel lets pass between two refreshes.
void settle() {
  QTest::qWait(150);
}

class BudgetPanelTest : public testing::Test {
 protected:
  Draft draft;
  BudgetPanel panel{draft};
};

TEST_F(BudgetPanelTest, saysThatNothingIsHeldUntilItIs) {
  LiveFrame frame;
  frame.newImage = true;
  panel.showFrame(frame);
  settle();
  EXPECT_TRUE(panel.stateText().contains("not held"));
  EXPECT_EQ(panel.reasons().count(), 0);
}

TEST_F(BudgetPanelTest, showsWhatEachLeverGives) {
  panel.showFrame(frameAt(1, HoldReason::lowered, 4));
  panel.show();
  settle();
  EXPECT_EQ(panel.levers().item(0, 0)->text(), "1");
  EXPECT_EQ(panel.levers().item(0, 1)->text(), "4");
  EXPECT_EQ(panel.levers().item(1, 1)->text(), "0.8");
  EXPECT_EQ(panel.levers().item(2, 2)->text(), "nothing");
  EXPECT_TRUE(panel.stateText().startsWith("Lowered")) << panel.stateText().toStdString();
}

TEST_F(BudgetPanelTest, showsTheNamesOfItsCurvesWholeInANarrowDock) {
  for (const int widthPx : {900, 540, 320}) {
    BudgetPlot plot;
    plot.resize(widthPx, 300);
    plot.show();
    settle();
    plot.replot();
    int names = 0;
    for (int i = 0; i < plot.legend->elementCount(); ++i) {
      auto* item = qobject_cast<QCPPlottableLegendItem*>(plot.legend->elementAt(i));
      if (item == nullptr) continue;  // the last row of a grid may have empty places
      ++names;
      const QString name = item->plottable()->name();
      const int needed = QFontMetrics(item->font()).horizontalAdvance(name) + plot.legend->iconSize().width();
      EXPECT_GE(item->rect().width(), needed) << widthPx << ' ' << name.toStdString();
      EXPECT_TRUE(plot.rect().contains(item->rect())) << widthPx << ' ' << name.toStdString();
    }
    EXPECT_EQ(names, 9);
  }
}

TEST_F(BudgetPanelTest, listsAChangeOnceWhileItLasts) {
  panel.showFrame(frameAt(1, HoldReason::lowered, 4));
  for (int i = 0; i < 10; ++i) panel.showFrame(frameAt(2 + i, HoldReason::held, 4));
  for (int i = 0; i < 5; ++i) panel.showFrame(frameAt(20 + i, HoldReason::restored, 4));
  EXPECT_EQ(panel.reasons().count(), 2);
}

TEST_F(BudgetPanelTest, saysHowItsPredictionsComeOut) {
  for (int i = 0; i < 20; ++i) panel.showFrame(frameAt(i, HoldReason::held, 4));
  panel.show();
  settle();
  const QString text = panel.residualsText();
  EXPECT_TRUE(text.contains("triangles off by 10 %")) << text.toStdString();
  EXPECT_TRUE(text.contains("100 % within")) << text.toStdString();
}

TEST_F(BudgetPanelTest, countsAnImageOnceThoughItsDecisionIsShownAgain) {
  LiveFrame between = frameAt(1, HoldReason::lowered, 4);
  between.newImage = false;
  for (int i = 0; i < 5; ++i) panel.showFrame(between);
  EXPECT_EQ(panel.reasons().count(), 0);
}

TEST_F(BudgetPanelTest, recordsARunAndComparesItWithTheSameFlownAgain) {
  std::vector<AircraftState> asked;
  QObject::connect(&panel, &BudgetPanel::replayAsked, &panel,
                   [&asked](const std::vector<AircraftState>& states) { asked = states; });
  const auto fly = [&](double from, double ms, int images) {
    for (int i = 0; i < images; ++i) {
      LiveFrame frame = frameAt(from + i / 50.0, HoldReason::off, 1);
      frame.input.state.time = 100 + i / 50.0;
      frame.cost.total = ms;
      panel.showFrame(frame);
    }
  };
  panel.show();
  settle();
  EXPECT_FALSE(panel.replayButton().isEnabled());
  panel.recordButton().click();
  fly(1, 30, 101);
  panel.recordButton().click();
  fly(5, 99, 10);
  settle();
  EXPECT_EQ(panel.comparisonText(), "Recorded: 2 s, median 30 ms, p99 30 ms");
  panel.replayButton().click();
  ASSERT_EQ(asked.size(), 101u);
  EXPECT_EQ(asked.back().time, 102);
  fly(9, 20, 101);
  settle();
  EXPECT_EQ(panel.comparisonText(),
            "Recorded: 2 s, median 30 ms, p99 30 ms\nFlown again: 2 s, median 20 ms, p99 20 ms");
  fly(20, 70, 10);
  settle();
  EXPECT_FALSE(panel.comparisonText().contains("70")) << "the run is over";
}

TEST(RecordedRun, endsByItselfAndTakesEachStateOnce) {
  RecordedRun run;
  LiveFrame frame;
  frame.cost.total = 10;
  frame.cost.gpu = FrameCost::kNotMeasured;
  for (const double time : {5.0, 5.0, 4.0, 6.0}) {
    frame.input.state.time = time;
    EXPECT_TRUE(run.add(frame));
  }
  EXPECT_EQ(run.images(), 2u);
  frame.input.state.time = 5 + RecordedRun::kLongestS + 1;
  EXPECT_FALSE(run.add(frame));
  EXPECT_EQ(run.images(), 2u);
}

}  // namespace
}  // namespace trimtab::views
