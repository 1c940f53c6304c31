// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/culling_panel.h"

#include <gtest/gtest.h>

#include <QLabel>
#include <QTest>
#include <QWheelEvent>
#include <algorithm>
#include <memory>

#include "trimtab/frame/overlay_colours.h"
#include "views/controls/bar_list.h"
#include "views/insets/depth_map_inset.h"
#include "views/insets/horizon_inset.h"
#include "views/plots/time_plot.h"

namespace trimtab::views {
namespace {

/// What the panel says of a frame that has no horizon to show.
class CullingPanelTest : public ::testing::Test {
 protected:
  CullingPanelTest() { panel_.show(); }
  bool says(const LiveFrame& frame, const QString& text) {
    panel_.showFrame(frame);
    panel_.showHorizon({}, 0, 60);
    return QTest::qWaitFor([&] {
      const auto labels = panel_.findChildren<QLabel*>();
      return std::any_of(labels.begin(), labels.end(),
                         [&](const QLabel* label) { return label->text().contains(text); });
    });
  }
  QString ofHorizon() const { return panel_.findChild<HorizonInset*>()->accessibleDescription(); }

  Draft draft_;
  CullingPanel panel_{draft_};
};

TEST_F(CullingPanelTest, saysWhatServesAndWhyNotWhatWasAskedFor) {
  LiveFrame frame;
  const auto result = std::make_shared<FrameResult>();
  frame.result = result;
  result->visible.tiles.resize(10);
  frame.decision.occlusionResolution = OcclusionResolution{800, 600};
  result->note = "The eye is under the ground.";
  EXPECT_TRUE(
      says(frame, QStringLiteral("Nothing is looked for behind the ground. The eye is under the ground.")));
  EXPECT_EQ(ofHorizon(), QStringLiteral("The eye is under the ground."));

  result->note.clear();
  result->occlusion = OcclusionMethod::horizon;
  EXPECT_TRUE(says(frame, QStringLiteral("The horizon is left out: near here it hid next to nothing.")));
  EXPECT_EQ(ofHorizon(), QStringLiteral("The horizon is left out: near here it hid next to nothing."));

  result->occlusion = OcclusionMethod::depth_map;
  result->counters.depthMapsDrawn = 4711;
  EXPECT_TRUE(says(frame, QStringLiteral("depth maps drawn 4")));
  EXPECT_EQ(ofHorizon(), QStringLiteral("A depth map serves, not the horizon."));
  result->depthMap = OcclusionResolution{400, 300};
  EXPECT_TRUE(says(frame, QStringLiteral("serves, 400 × 300 px."))) << "the map's size, not the band's";

  result->occlusion.reset();
  EXPECT_TRUE(says(frame, QStringLiteral("of the static trees serves, 400")));
  result->depthMap.reset();
  frame.decision.occlusionResolution.reset();
  EXPECT_TRUE(says(frame, QStringLiteral("plain view-frustum culling")));
  EXPECT_EQ(ofHorizon(), QStringLiteral("No horizon: nothing asks for one in this frame."));
}

TEST_F(CullingPanelTest, aReasonHasTheColourThatTheImageGivesIt) {
  const auto result = std::make_shared<FrameResult>();
  result->tilesInCut = 40;
  result->visible.tiles.resize(10);
  result->visible.outsideFrustum = result->visible.occluded = 10;
  result->visible.beyondVisibility = result->visible.backFacing = 5;
  LiveFrame frame;
  frame.result = result;
  panel_.showFrame(frame);
  const auto shows = [&](CullReason reason) {
    const auto [red, green, blue] = reasonColour(reason);
    const QImage image = panel_.findChild<BarList*>()->grab().toImage();
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        if (image.pixelColor(x, y) == QColor(red, green, blue)) return true;
    return false;
  };
  for (const CullReason reason : {CullReason::drawn, CullReason::outside_frustum, CullReason::occluded,
                                  CullReason::beyond_visibility, CullReason::back_facing})
    EXPECT_TRUE(QTest::qWaitFor([&] { return shows(reason); })) << int(reason);
}

TEST_F(CullingPanelTest, theDepthMapIsShownOrWhyThereIsNone) {
  const auto* const inset = panel_.findChild<DepthMapInset*>();
  const auto says = [&](const QString& text) {
    return QTest::qWaitFor([&] { return inset->accessibleDescription() == text; });
  };
  const QString none = "No depth map: scheme is frustum", caption = "32 × 24 px, near 1 m, far 5 km";
  panel_.showFrame({});
  EXPECT_TRUE(says(none));
  QImage map(32, 24, QImage::Format_Grayscale8);
  map.fill(90);
  LiveFrame frame;
  frame.decision.scheme = Scheme::dynamic;
  FrameResult result;
  result.depthMap = OcclusionResolution{32, 24};
  frame.result = std::make_shared<const FrameResult>(result);
  panel_.showFrame(frame);
  panel_.showMap(map, caption);
  EXPECT_TRUE(says(caption));
  panel_.showFrame({});
  EXPECT_TRUE(says(none));
}

TEST_F(CullingPanelTest, showsStagesWithTheirBudgetAndLetsTheDockScroll) {
  TraceBuffer frames;
  panel_.showStages(frames);
  auto* plot = panel_.findChild<TimePlot*>();
  ASSERT_NE(plot, nullptr);
  const auto budget = [&] {
    for (int i = 0; i < plot->itemCount(); ++i)
      if (const auto* line = qobject_cast<QCPItemStraightLine*>(plot->item(i)))
        if (line->point1->value() == line->point2->value()) return line->point1->value();
    return 0.0;
  };
  EXPECT_EQ(budget(), draft_.active()->measure.budget.value());
  draft_.setValue("measure.budget_ms", 8.3);
  EXPECT_EQ(budget(), 8.3);
  // The wheel scrolls the dock, also once the plot was clicked; with Ctrl it zooms.
  const double shown = plot->shown().size();
  const auto turned = [&](Qt::KeyboardModifiers keys) {
    QWheelEvent wheel({50, 50}, plot->mapToGlobal(QPointF(50, 50)), {}, {0, -120}, Qt::NoButton, keys,
                      Qt::NoScrollPhase, false);
    wheel.accept();
    static_cast<QObject*>(plot)->event(&wheel);
    return wheel.isAccepted();
  };
  plot->setFocus();
  EXPECT_FALSE(turned(Qt::NoModifier));
  EXPECT_EQ(plot->shown().size(), shown);
  EXPECT_TRUE(turned(Qt::ControlModifier));
  EXPECT_GT(plot->shown().size(), shown);
}

}  // namespace
}  // namespace trimtab::views
