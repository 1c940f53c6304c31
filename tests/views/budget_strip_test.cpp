// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/budget_strip.h"

#include <gtest/gtest.h>

#include <QTest>
#include <cmath>

namespace trimtab::views {
namespace {

FrameCost costOf(double totalMs) {
  FrameCost cost;
  cost.total = totalMs;
  cost.draw = totalMs * 0.8;
  cost.occlusion = totalMs * 0.1;
  cost.gpu = FrameCost::kNotMeasured;
  return cost;
}

TEST(BudgetMinute, countsTheShareOfTheLastMinuteAndForgetsWhatIsOlder) {
  BudgetMinute minute;
  EXPECT_TRUE(std::isnan(minute.overShare(16)));
  EXPECT_FALSE(minute.worstStage(16));
  for (int i = 0; i < 100; ++i) minute.add(i, costOf(i < 50 ? 20 : 10), {});
  EXPECT_EQ(minute.images(), 61u);
  EXPECT_DOUBLE_EQ(minute.overShare(16), 11.0 / 61);
  EXPECT_EQ(minute.overShare(25), 0);
}

TEST(BudgetMinute, theWorstStageIsThatOfTheImagesOverTheBudget) {
  BudgetMinute minute;
  for (int i = 0; i < 50; ++i) minute.add(i * 0.1, costOf(10), {});
  FrameCost rain = costOf(40);
  rain.weather = 30;  // a part of the drawing
  minute.add(5, rain, {});
  EXPECT_EQ(minute.worstStage(16)->name, "weather");
  EXPECT_DOUBLE_EQ(minute.worstStage(16)->ms, 30);
  EXPECT_EQ(minute.worstStage(100)->name, "drawing") << "none is over: all count";
  EXPECT_EQ(minute.help(16, {})->lever, Lever::particle_density);
  EXPECT_TRUE(std::isnan(minute.help(16, {})->ms));
}

TEST(BudgetMinute, knownCostsNameTheLeverThatSavesMost) {
  BudgetMinute minute;
  minute.add(0, costOf(20), {1e6, 1, 1, 0, false});
  CostCoefficients triangles;
  triangles.known = true;
  triangles.perTriangle = 1e-5;
  triangles.perGroundMpx = 2;
  EXPECT_EQ(minute.help(16, triangles)->lever, Lever::screen_space_error);
  EXPECT_NEAR(minute.help(16, triangles)->ms, 5, 1e-9);
  CostCoefficients pixels = triangles;
  pixels.perGroundMpx = 17;
  EXPECT_EQ(minute.help(16, pixels)->lever, Lever::render_scale);
  EXPECT_NEAR(minute.help(16, pixels)->ms, 8.5, 1e-9);
  EXPECT_EQ(minute.help(16, pixels, 1u << indexOf(Lever::render_scale))->lever, Lever::screen_space_error)
      << "what is spent helps no more";
  EXPECT_FALSE(minute.help(16, {}, 1u << indexOf(Lever::screen_space_error)));
}

TEST(BudgetMinute, noLeverSavesMoreThanTheImageTookForIt) {
  BudgetMinute minute;
  FrameCost cost = costOf(20);
  cost.blur = 3;
  cost.weather = 2;
  minute.add(0, cost, {1000, 1, 1, 1, true});
  CostCoefficients overrated;
  overrated.known = true;
  overrated.perBlurMpx = 5;
  overrated.perTriangle = 1e-3;
  EXPECT_EQ(minute.help(16, overrated)->lever, Lever::blur_strength);
  EXPECT_DOUBLE_EQ(minute.help(16, overrated)->ms, 3) << "not 5";
}

TEST(BudgetStrip, aClickOpensTheKnobThatItNamesAndNoneThatIsAtItsCap) {
  Draft draft;
  ASSERT_TRUE(draft.setText("hold.enabled", "true").empty());
  ASSERT_TRUE(draft.setText("hold.error_maximum_px", "16").empty());
  BudgetStrip strip(draft);
  strip.show();
  QStringList asked;
  QObject::connect(&strip, &BudgetStrip::knobAsked, &strip, [&](const QString& key) { asked << key; });
  LiveFrame frame;
  frame.newImage = true;
  frame.cost = costOf(20);
  frame.levers.emplace();
  strip.showFrame(frame, 1);
  ASSERT_TRUE(QTest::qWaitFor([&] { return strip.text().contains("most help: allowed error"); }, 5000));
  QTest::mouseClick(&strip, Qt::LeftButton);
  EXPECT_EQ(asked, QStringList{"lod.screen_space_error_px"});
  frame.levers->drawn.errorPx = 16;
  strip.showFrame(frame, 1);
  EXPECT_TRUE(QTest::qWaitFor([&] { return !strip.text().contains("most help"); }, 5000))
      << strip.text().toStdString();
  QTest::mouseClick(&strip, Qt::LeftButton);
  EXPECT_EQ(asked.size(), 1);
}

TEST(BudgetStrip, saysHowMuchOfTheMinuteIsOverWhereAndWhatHelps) {
  Draft draft;
  ASSERT_TRUE(draft.setText("measure.budget_ms", "16").empty());
  BudgetStrip strip(draft);
  strip.show();
  LiveFrame frame;
  frame.newImage = true;
  for (int i = 0; i < 20; ++i) {
    frame.time = i;
    frame.cost = costOf(i == 0 ? 20 : 10);
    strip.showFrame(frame, 1);
  }
  frame.newImage = false;
  strip.showFrame(frame, 1);
  EXPECT_TRUE(QTest::qWaitFor([&] { return strip.text().contains("5 % of the last minute"); }, 5000))
      << strip.text().toStdString();
  EXPECT_TRUE(strip.text().contains("longest: drawing, 16 ms")) << strip.text().toStdString();
  EXPECT_TRUE(strip.text().contains("most help: allowed error"));
  EXPECT_EQ(strip.minute().images(), 20u);
  ASSERT_TRUE(draft.setText("measure.budget_ms", "30").empty());
  EXPECT_TRUE(QTest::qWaitFor([&] { return strip.text().contains("Within 30"); }, 5000));
}

}  // namespace
}  // namespace trimtab::views
