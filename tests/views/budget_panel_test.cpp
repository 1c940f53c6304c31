// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/budget_panel.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QLayout>
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
  LeverChain& levers = frame.levers.emplace();
  for (FrameLevers* step : {&levers.preset, &levers.motion, &levers.weather, &levers.policy, &levers.drawn})
    step->errorPx = 1;
  levers.drawn = withBudget(levers.policy, frame.hold.held);
  frame.hold.limitMs = 15.4;
  frame.hold.halfBandMs = 1.5;
  frame.holdGains.error = {6, 0.0041};
  frame.holdGains.renderScale = {3.96, 0.0105};
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
  EXPECT_EQ(panel.levers().verticalHeaderItem(0)->text(), "Allowed error");
  EXPECT_EQ(panel.levers().item(0, 0)->text(), "1 px");
  EXPECT_EQ(panel.levers().item(0, 1)->text(), "preset");
  EXPECT_EQ(panel.levers().item(0, 2)->text(), "4 px");
  EXPECT_EQ(panel.levers().item(0, 0)->toolTip(), "preset 1 px, budget 4 px");
  EXPECT_EQ(panel.levers().item(4, 2)->text(), "0.8");
  EXPECT_EQ(panel.levers().item(1, 3)->text(), "") << "the budget leaves the LOD scale alone";
  EXPECT_TRUE(panel.stateText().startsWith("Lowered")) << panel.stateText().toStdString();
}

TEST_F(BudgetPanelTest, saysHowManyMillisecondsEachLeverTakesOff) {
  panel.showFrame(frameAt(1, HoldReason::lowered, 4));
  panel.show();
  settle();
  EXPECT_EQ(panel.levers().item(0, 3)->text(), "6");
  EXPECT_EQ(panel.levers().item(4, 3)->text(), "3.96");
  EXPECT_EQ(panel.levers().item(4, 4)->text(), "0.0105");
  EXPECT_EQ(panel.levers().item(6, 3)->text(), "");
  ASSERT_EQ(panel.reasons().count(), 1);
  const QString change = panel.reasons().item(0)->text();
  EXPECT_TRUE(change.contains("allowed error takes off 6 ms, render scale takes off 4 ms"))
      << change.toStdString();
  EXPECT_FALSE(change.contains("blur takes")) << change.toStdString();
}

TEST_F(BudgetPanelTest, beginsWithItsSwitchAndSaysWhereTheLimitComesFrom) {
  for (const auto& [key, text] : {std::pair{"hold.enabled", "true"}, std::pair{"measure.budget_ms", "16.7"},
                                  std::pair{"hold.margin", "0.08"}})
    ASSERT_TRUE(draft.setText(key, text).empty());
  LiveFrame frame = frameAt(1, HoldReason::lowered, 4);
  frame.hold.limitMs = 12.5;
  panel.showFrame(frame);
  panel.show();
  settle();
  EXPECT_EQ(panel.limitText(), "16.7 ms budget − 1.34 ms margin − 2.86 ms caution = 12.5 ms for predictions");
  const QWidget* const first = panel.layout()->itemAt(0)->widget();
  EXPECT_NE(first->findChild<QCheckBox*>(), nullptr) << "the switch comes first";
}

TEST_F(BudgetPanelTest, saysThatItLeavesTheLeversAloneWherePredictionsAreOff) {
  LiveFrame frame = frameAt(1, HoldReason::not_trusted, 1);
  frame.hold.held = frame.hold.asked;
  panel.showFrame(frame);
  panel.show();
  settle();
  EXPECT_EQ(panel.reasons().count(), 1);
  EXPECT_TRUE(panel.stateText().contains("predict")) << panel.stateText().toStdString();
}

TEST_F(BudgetPanelTest, stacksPredictedAndMeasuredStagesOnOneScaleAndShowsHowFarOffTheyWere) {
  BudgetPlot& plot = panel.plot();
  for (int i = 0; i < 20; ++i) {
    LiveFrame frame = frameAt(i / 10.0, HoldReason::held, 4);
    frame.cost.weather = 3;
    frame.cost.decide = 1;
    panel.showFrame(frame);
  }
  const auto last = [](const QCPGraph* graph) { return (graph->data()->constEnd() - 1)->value; };
  EXPECT_DOUBLE_EQ(last(plot.predicted()[0]), 12);
  EXPECT_DOUBLE_EQ(last(plot.predicted()[3]), 14.5);
  EXPECT_DOUBLE_EQ(last(plot.measured()[0]), 11);
  EXPECT_DOUBLE_EQ(last(plot.measured()[1]), 14);
  EXPECT_DOUBLE_EQ(last(plot.measured()[3]), 15);
  EXPECT_NEAR(last(&plot.off()), 100 * (14.0 / 15 - 1), 1e-9);
  plot.refresh();
  EXPECT_EQ(plot.predicted()[0]->valueAxis()->range(), plot.measured()[0]->valueAxis()->range());
  EXPECT_NE(plot.predicted()[0]->valueAxis(), plot.measured()[0]->valueAxis());
  plot.append(frameAt(2, HoldReason::off, 4), 16.7);
  EXPECT_TRUE(std::isnan(last(plot.predicted()[0])));
  EXPECT_TRUE(std::isnan(last(&plot.off()))) << "what is not held is not predicted";
  EXPECT_DOUBLE_EQ(last(plot.measured()[3]), 15) << "but it is measured";
}

TEST_F(BudgetPanelTest, fliesARunAgainUnderAnotherModeAsOneUndoStep) {
  panel.setRecording(true);
  for (int i = 0; i < 3; ++i) {
    LiveFrame frame = frameAt(i, HoldReason::off, 1);
    frame.input.state.time = 100 + i;
    panel.showFrame(frame);
  }
  panel.setRecording(false);
  panel.show();
  settle();
  EXPECT_FALSE(draft.parameters().hold.enabled);
  panel.modeChoice().setCurrentText("with the budget held");
  panel.replayButton().click();
  EXPECT_TRUE(draft.parameters().hold.enabled);
  EXPECT_EQ(draft.undoStack().count(), 1);
  panel.modeChoice().setCurrentIndex(1);
  panel.replayButton().click();
  EXPECT_FALSE(draft.parameters().hold.enabled);
  EXPECT_FALSE(draft.parameters().policy.enabled);
  panel.modeChoice().setCurrentIndex(0);
  panel.replayButton().click();
  EXPECT_EQ(draft.undoStack().count(), 2) << "nothing to switch";
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
  panel.setRecording(true);
  fly(1, 30, 101);
  panel.setRecording(false);
  fly(5, 99, 10);
  settle();
  EXPECT_EQ(panel.comparisonText(), "Recorded: 2 s, median 30 ms, p99 30 ms");
  panel.replayButton().click();
  ASSERT_EQ(asked.size(), 101u);
  EXPECT_EQ(asked.back().time, 102);
  fly(9, 20, 101);
  settle();
  EXPECT_EQ(panel.comparisonText(),
            "Recorded: 2 s, median 30 ms, p99 30 ms\nFlown again: 2 s, median 20 ms, p99 20 ms; too short to "
            "compare");
  // The recorded times lie over those of the new flight.
  const auto recorded = panel.plot().recorded().data();
  ASSERT_EQ(recorded->size(), 101);
  EXPECT_NEAR(recorded->constBegin()->key, 9, 1e-9);
  EXPECT_NEAR((recorded->constEnd() - 1)->key, 11, 1e-9);
  EXPECT_EQ(recorded->constBegin()->value, 30);
  fly(20, 70, 10);
  settle();
  EXPECT_FALSE(panel.comparisonText().contains("70")) << "the run is over";
}

TEST_F(BudgetPanelTest, comparesTwoRunsSecondBySecondAndCallsNoiseNoDifference) {
  const auto fly = [&](double ms, double everyOther, int images) {
    for (int i = 0; i < images; ++i) {
      LiveFrame frame = frameAt(i / 10.0, HoldReason::off, 1);
      frame.input.state.time = 100 + i / 10.0;
      frame.cost.total = i / 10 % 2 ? ms : ms * everyOther;
      panel.showFrame(frame);
    }
  };
  panel.show();
  const auto compared = [&](double ms, double everyOther) {
    panel.setRecording(true);
    fly(30, 1, 95);
    panel.setRecording(false);
    settle();
    EXPECT_TRUE(panel.comparisonText().endsWith("p99 – ms")) << "95 images have no 99th percentile";
    panel.replayButton().click();
    fly(ms, everyOther, 95);
    settle();
    return panel.comparisonText().section("; ", 1);
  };
  EXPECT_EQ(compared(15, 1), "50 % faster (× 0.5 to 0.5, by second)");
  EXPECT_EQ(compared(29, 1.08), "no difference (× 0.97 to 1.04, by second)");
}

TEST_F(BudgetPanelTest, fliesAgainUnderEachModeOfTheExperimentAndUndoTakesItBack) {
  struct Mode {
    MotionControl headMotion;
    RatioMode weatherCut;
    bool policy, hold;
  };
  constexpr Mode kModes[] = {{MotionControl::off, RatioMode::off, false, false},
                             {MotionControl::with_restoration, RatioMode::adaptive, false, false},
                             {MotionControl::off, RatioMode::adaptive, true, false},
                             {MotionControl::off, RatioMode::adaptive, true, true}};
  panel.show();
  panel.setRecording(true);
  for (int i = 0; i < 5; ++i) {
    LiveFrame frame = frameAt(i, HoldReason::off, 1);
    frame.input.state.time = i;
    panel.showFrame(frame);
  }
  panel.setRecording(false);
  settle();
  QComboBox& choice = panel.modeChoice();
  ASSERT_EQ(choice.count(), 5);
  for (int i = 0; i < 4; ++i) {
    choice.setCurrentIndex(i + 1);
    panel.replayButton().click();
    const TuningParameters& p = draft.parameters();
    const std::string name = choice.currentText().toStdString();
    EXPECT_EQ(p.motion.control, kModes[i].headMotion) << name;
    EXPECT_EQ(p.weather.ratioMode, kModes[i].weatherCut) << name;
    EXPECT_EQ(p.policy.enabled, kModes[i].policy) << name;
    EXPECT_EQ(p.hold.enabled, kModes[i].hold) << name;
  }
  while (draft.undoStack().canUndo()) draft.undoStack().undo();
  EXPECT_FALSE(draft.isDirty());
  EXPECT_EQ(draft.parameters().motion.control, TuningParameters{}.motion.control);
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
