// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/plots/error_timeline.h"

#include <QSignalSpy>
#include <cmath>
#include <utility>

#include "application.h"
#include "error_run_sample.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::views {
namespace {

class ErrorTimelineTest : public testing::Test {
 protected:
  void SetUp() override {
    test::expose(line_, {520, 320});
    line_.show(test::sampleRun());
    line_.replot(QCustomPlot::rpImmediateRefresh);
    line_.setFocus();
  }
  QCPGraph* graph(const QString& name, int lane) {
    int seen = 0;
    for (int i = 0; i < line_.graphCount(); ++i)
      if (line_.graph(i)->name() == name && seen++ == lane) return line_.graph(i);
    return nullptr;
  }

  ErrorTimeline line_;
};

TEST_F(ErrorTimelineTest, drawsFrameTimeAndErrorOfEachPresetOfTheCase) {
  // "proposed" is the last case of the run; "none" has only "fine".
  for (const char* preset : {"fine", "coarse"})
    for (int lane = 0; lane < 2; ++lane) {
      ASSERT_NE(graph(preset, lane), nullptr) << preset << lane;
      EXPECT_EQ(graph(preset, lane)->dataCount(), 11);
    }
  EXPECT_NEAR(graph("coarse", 0)->dataMainValue(5), 4, 1e-12);
  EXPECT_NEAR(graph("coarse", 1)->dataMainValue(5), 0.08, 1e-12);
  line_.showError(1);
  EXPECT_EQ(graph("coarse", 1)->dataMainValue(5), 30);
  line_.showMethod("none");
  EXPECT_EQ(graph("coarse", 0), nullptr);
  EXPECT_EQ(graph("fine", 1)->dataMainValue(5), kEqualDb);
}

TEST_F(ErrorTimelineTest, keysGoFromFrameToFrameAndTellWhere) {
  QSignalSpy sought(&line_, &ErrorTimeline::sought);
  line_.follow(105);
  EXPECT_EQ(sought.count(), 0) << "following the flight must not seek it";
  const auto press = [&](Qt::Key key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QTest::keyClick(&line_, key, modifiers);
    return sought.isEmpty() ? kNan : sought.takeLast().front().toDouble();
  };
  EXPECT_EQ(press(Qt::Key_Right), 106);
  EXPECT_EQ(press(Qt::Key_Right), 108);
  EXPECT_EQ(press(Qt::Key_Left), 106);
  line_.follow(105);
  EXPECT_EQ(press(Qt::Key_Left), 104);
  EXPECT_EQ(press(Qt::Key_End), 120);
  EXPECT_EQ(press(Qt::Key_Right), 120);
  EXPECT_EQ(press(Qt::Key_Left, Qt::ShiftModifier), 100);
  EXPECT_EQ(press(Qt::Key_W), 108) << "the worst frame";
  EXPECT_EQ(press(Qt::Key_Home), 100);
  EXPECT_EQ(line_.cursorTime(), 100);
}

TEST_F(ErrorTimelineTest, draggingSeeksAndFollowingDoesNotPullTheCursorAway) {
  QSignalSpy sought(&line_, &ErrorTimeline::sought);
  test::drag(line_, line_.pixelOf(102), line_.pixelOf(114), false);
  ASSERT_GT(sought.count(), 2);
  EXPECT_NEAR(sought.last().front().toDouble(), 114, 0.2);
  line_.follow(101);
  EXPECT_NEAR(line_.cursorTime(), 114, 0.2);
  QTest::mouseRelease(&line_, Qt::LeftButton, Qt::NoModifier, line_.pixelOf(114).toPoint());
  line_.follow(101);
  EXPECT_EQ(line_.cursorTime(), 101);
}

TEST_F(ErrorTimelineTest, marksTheWorstFramesAndDescribesThem) {
  ASSERT_EQ(line_.worst().size(), 2u);
  EXPECT_EQ(line_.worst()[0].frame, 4);
  line_.follow(108);
  for (const char* part : {"108 s", "coarse: 3.9 ms", "FLIP 0.079", "largest FLIP"})
    EXPECT_TRUE(line_.accessibleDescription().contains(part))
        << part << " in " << line_.accessibleDescription().toStdString();
}

TEST_F(ErrorTimelineTest, survivesFramesThatWereNotMeasuredAndMarksThatAreNotThere) {
  ErrorRun run = test::sampleRun();
  run.series[1].errors[0].fill(kNan);
  run.series[2].ms[3] = kNan;
  run.series[2].worst << ErrorRun::Mark{99, "gone"} << ErrorRun::Mark{-1, "gone"};
  line_.show(run);
  line_.replot(QCustomPlot::rpImmediateRefresh);
  EXPECT_TRUE(std::isfinite(line_.axisRect(1)->axis(QCPAxis::atLeft)->range().upper));
  EXPECT_EQ(line_.worst().size(), 2u);
  line_.follow(kNan);
  line_.show({});
  QTest::keyClick(&line_, Qt::Key_Right);
  QTest::keyClick(&line_, Qt::Key_W);
  EXPECT_TRUE(std::isnan(line_.cursorTime()));
}

TEST_F(ErrorTimelineTest, keysZoomNoFartherThanTheWheelDoes) {
  const auto shown = [&] { return line_.axisRect(0)->axis(QCPAxis::atBottom)->range(); };
  const QCPRange whole = shown();
  for (int i = 0; i < 60; ++i) QTest::keyClick(&line_, Qt::Key_Plus);
  EXPECT_LT(shown().size(), 0.2);
  EXPECT_GE(shown().size(), 0.1);
  for (int i = 0; i < 60; ++i) QTest::keyClick(&line_, Qt::Key_Minus);
  EXPECT_NEAR(shown().lower, whole.lower, 1e-9);
  EXPECT_NEAR(shown().upper, whole.upper, 1e-9);
}

TEST_F(ErrorTimelineTest, showsFrameTimesWithoutAnError) {
  line_.showError(-1);  // of a list that is empty
  line_.follow(108);
  EXPECT_GT(line_.graphCount(), 0);
  EXPECT_FALSE(line_.accessibleDescription().contains("FLIP"));
  line_.showError(0);
  EXPECT_TRUE(line_.accessibleDescription().contains("FLIP"));
}

TEST_F(ErrorTimelineTest, tellsOfTheNearestFrame) {
  for (const auto& [at, says] :
       {std::pair{90.0, "100 s"}, {104.9, "104 s"}, {105.0, "104 s"}, {105.1, "106 s"}, {400.0, "120 s"}}) {
    line_.follow(at);
    EXPECT_TRUE(line_.accessibleDescription().startsWith(says)) << at;
  }
}

}  // namespace
}  // namespace trimtab::views
