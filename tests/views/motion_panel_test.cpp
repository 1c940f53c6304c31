// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/motion_panel.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QLineEdit>
#include <QListWidget>
#include <QSignalSpy>
#include <QTest>
#include <algorithm>

#include "trimtab/motion/head_motion.h"
#include "views/plots/motion_plot.h"

namespace trimtab::views {
namespace {

/// A head that turns at these rates, 60 states a second, shown frame by frame.
void show(MotionPanel& panel, const std::vector<double>& ratesDegPerS) {
  MotionMemory memory;
  AircraftState state;
  double heading = 0;
  for (const double rate : ratesDegPerS) {
    state.time += 1.0 / 60;
    heading += rate / 60;
    state.head = Attitude{Degrees{heading}, Degrees{0}, Degrees{0}};
    LiveFrame frame;
    frame.time = state.time;
    frame.decision.motion = decideMotion(state, MotionParameters{}, memory);
    panel.showFrame(frame);
  }
}

std::vector<double> rates(int slow, int fast) {
  std::vector<double> all(static_cast<std::size_t>(slow), 5.0);
  all.insert(all.end(), static_cast<std::size_t>(fast), 180.0);
  return all;
}

/// The largest rate in the panel's plot, deg/s.
double largestRate(const MotionPanel& panel) {
  const auto* plot = panel.findChild<MotionPlot*>();
  double largest = 0;
  for (int i = 0; i < plot->graphCount(); ++i)
    if (plot->graph(i)->name() == QStringLiteral("rate"))
      for (const QCPGraphData& point : *plot->graph(i)->data()) largest = std::max(largest, point.value);
  return largest;
}

TEST(MotionPanel, listsTheReasonOfEachChangeOnceAndNothingElse) {
  Draft draft;
  MotionPanel panel(draft);
  show(panel, rates(3, 29));
  ASSERT_EQ(panel.reasons().count(), 2) << "nine more fast frames are not enough for a third";
  EXPECT_TRUE(panel.reasons().item(0)->text().contains(QStringLiteral("detail lowered, LOD scale 2")))
      << "hidden or not";
  EXPECT_TRUE(panel.reasons().item(1)->text().contains(QStringLiteral("detail lowered, LOD scale 4")));
  LiveFrame same;
  same.time = 2;
  panel.showFrame(same);
  EXPECT_EQ(panel.reasons().count(), 2);
}

TEST(MotionPanel, saysTheRateAgainstTheThreshold) {
  Draft draft;
  MotionPanel panel(draft);
  panel.show();
  ASSERT_TRUE(QTest::qWaitForWindowExposed(&panel));
  show(panel, rates(2, 5));
  ASSERT_TRUE(QTest::qWaitFor([&] { return panel.stateText().startsWith(QStringLiteral("Fast")); }));
  EXPECT_EQ(panel.stateText(), QStringLiteral("Fast: 180 deg/s, threshold 60 deg/s"));
  EXPECT_NEAR(largestRate(panel), 180, 1e-6);
}

TEST(MotionPanel, holdsTheLastSecondsOnly) {
  Draft draft;
  MotionPanel panel(draft);
  show(panel, rates(0, 30));
  EXPECT_NEAR(largestRate(panel), 180, 1e-6);
  LiveFrame later;
  later.time = 1 + MotionPlot::kSpanS;
  panel.showFrame(later);
  EXPECT_EQ(largestRate(panel), 0);
}

TEST(MotionPanel, asksForTheSourceThatIsChosenAndForAFileOfALog) {
  Draft draft;
  MotionPanel panel(draft);
  QSignalSpy asked(&panel, &MotionPanel::sourceAsked), file(&panel, &MotionPanel::openLogAsked);
  emit panel.sourceBox().activated(MotionPanel::pointer);
  ASSERT_EQ(asked.count(), 1);
  EXPECT_EQ(asked.at(0).at(0).toInt(), MotionPanel::pointer);
  emit panel.sourceBox().activated(MotionPanel::log);
  EXPECT_EQ(file.count(), 1);
  EXPECT_EQ(asked.count(), 1) << "a log is used once a file is named";
  panel.setSource(MotionPanel::none, {});
  EXPECT_EQ(panel.source(), MotionPanel::none);
  EXPECT_EQ(asked.count(), 1) << "what is told is not asked";
}

TEST(MotionPanel, takesASweepWithOrWithoutItsName) {
  Draft draft;
  MotionPanel panel(draft);
  EXPECT_EQ(panel.sweepText(), QStringLiteral("sweep:180deg/1s/2s"));
  panel.sweepEdit().setText(QStringLiteral(" nod:40/1s "));
  EXPECT_EQ(panel.sweepText(), QStringLiteral("nod:40/1s"));
}

TEST(MotionPlot, aJumpOfTheViewDoesNotFlattenTheSweepBeforeIt) {
  MotionPlot plot;
  LiveFrame frame;
  for (int i = 0; i < 600; ++i) {
    frame.time = i / 60.0;
    frame.decision.motion.rateDegPerS = i == 400 ? 50'000 : 180;
    frame.decision.motion.thresholdDegPerS = 60;
    plot.append(frame);
  }
  plot.refresh();
  EXPECT_GT(plot.yAxis->range().upper, 180);
  EXPECT_LT(plot.yAxis->range().upper, 1000);
}

}  // namespace
}  // namespace trimtab::views
