// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/budget_panel.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QListWidget>
#include <QTableWidget>

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

void settle() {
  for (int i = 0; i < 20; ++i) QApplication::processEvents(QEventLoop::AllEvents, 20);
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
    for (int i = 0; i < plot.legend->itemCount(); ++i) {
      const auto* item = qobject_cast<QCPPlottableLegendItem*>(plot.legend->item(i));
      ASSERT_NE(item, nullptr);
      const QString name = item->plottable()->name();
      const int needed = QFontMetrics(item->font()).horizontalAdvance(name) + plot.legend->iconSize().width();
      EXPECT_GE(item->rect().width(), needed) << widthPx << ' ' << name.toStdString();
      EXPECT_TRUE(plot.rect().contains(item->rect())) << widthPx << ' ' << name.toStdString();
    }
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

}  // namespace
}  // namespace trimtab::views
