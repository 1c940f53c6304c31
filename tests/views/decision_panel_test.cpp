// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/decision_panel.h"

#include "views/controls/lever_chain_table.h"

#include <QClipboard>
#include <QLabel>
#include <QPushButton>
#include <QSignalSpy>
#include <QTableView>
#include <QTest>

#include "application.h"
#include "live_flight.h"
#include "tests/support.h"
#include "views/panels/decision_log.h"

namespace trimtab::views {
namespace {

class DecisionPanelTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(panel_, {520, 520}); }
  /// One frame at an altitude in level flight.
  void fly(double altitudeFt, double pitchDeg = 0) {
    LiveFrame frame;
    frame.time = 0.5 * static_cast<double>(packet_);
    frame.input.state.packet = packet_++;
    frame.decision = decide(test::inputAt(altitudeFt, pitchDeg), draft_.active(), memory_);
    panel_.showFrame(frame);
  }
  QString cell(int row, int column) const { return panel_.log().index(row, column).data().toString(); }

  Draft draft_;
  DecisionMemory memory_;
  std::uint64_t packet_ = 0;
  DecisionPanel panel_{draft_};
};

TEST_F(DecisionPanelTest, logsChangesAndNothingElse) {
  for (int i = 0; i < 10; ++i) fly(3000);      // 1.5
  for (int i = 0; i < 10; ++i) fly(6000);      // 0.8
  for (int i = 0; i < 10; ++i) fly(9000, -3);  // 0.55
  for (int i = 0; i < 10; ++i) fly(9000, 29);  // 0.017: frustum
  for (int i = 0; i < 10; ++i) fly(6000);
  const char* const sizes[] = {"800x600", "400x300", "none", "400x300"};
  ASSERT_EQ(panel_.log().rowCount(), 4);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(cell(i, DecisionLog::kDepthMap), sizes[i]) << i;
  EXPECT_EQ(cell(2, DecisionLog::kScheme), "frustum");
  EXPECT_EQ(cell(1, DecisionLog::kTime), "5.000");
  EXPECT_EQ(cell(1, DecisionLog::kPacket), "10");
  EXPECT_TRUE(cell(1, DecisionLog::kReason).contains("6000 ft"));
}

TEST_F(DecisionPanelTest, beingHeldByHysteresisIsNoChange) {
  fly(6000, 10);  // 0.633: second band
  fly(6000, 20);  // 0.467: held, the edge is 0.5 - 0.05
  fly(6000, 10);
  ASSERT_EQ(panel_.log().rowCount(), 1);
  fly(6000, 22);  // 0.433
  EXPECT_EQ(panel_.log().rowCount(), 2);
}

TEST_F(DecisionPanelTest, inputThatStopsMakingSenseIsAChange) {
  fly(9000, 29);
  fly(std::nan(""));
  fly(std::nan(""));
  ASSERT_EQ(panel_.log().rowCount(), 2);
  EXPECT_TRUE(cell(1, DecisionLog::kReason).contains("not a number"));
}

TEST_F(DecisionPanelTest, leadsToTheChoicesThatLeaveTheImageWithoutADepthMap) {
  auto* const lead = panel_.findChild<QPushButton*>();
  ASSERT_NE(lead, nullptr);
  LiveFrame frame;
  frame.decision = decide(test::inputAt(6000, 0), draft_.active(), memory_);
  FrameResult drawn;
  drawn.occlusion = OcclusionMethod::horizon;
  frame.result = std::make_shared<const FrameResult>(drawn);
  panel_.showFrame(frame);
  ASSERT_TRUE(test::eventually([&] { return lead->isVisible(); }));
  for (const QLabel* label : panel_.findChildren<QLabel*>())
    EXPECT_FALSE(label->text().contains("depth map 4")) << "a size beside \"no depth map\" contradicts it";
  QSignalSpy asked(&panel_, &DecisionPanel::cullingAsked);
  QTest::mouseClick(lead, Qt::LeftButton);
  EXPECT_EQ(asked.size(), 1);
  drawn.depthMap = frame.decision.occlusionResolution;
  frame.result = std::make_shared<const FrameResult>(drawn);
  panel_.showFrame(frame);
  EXPECT_TRUE(test::eventually([&] { return !lead->isVisible(); })) << "a depth map was drawn";
}

TEST_F(DecisionPanelTest, recordsWhileHidden) {
  panel_.hide();
  fly(3000);
  fly(6000);
  EXPECT_EQ(panel_.log().rowCount(), 2);
}

TEST_F(DecisionPanelTest, copiesTheSelectionOrAll) {
  fly(3000);
  fly(6000);
  fly(9000, 29);
  QTableView& view = panel_.logView();
  view.setFocus();
  view.selectionModel()->select(panel_.log().index(1, 0),
                                QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
  panel_.copyLog();
  const QStringList some = QApplication::clipboard()->text().split('\n', Qt::SkipEmptyParts);
  ASSERT_EQ(some.size(), 2);
  EXPECT_EQ(some[0], "time_s\tpacket\tscheme\tdepth_map_px\treason");
  EXPECT_TRUE(some[1].startsWith("0.500\t1\tdynamic\t400x300\t"));
  panel_.activateWindow();
  view.setFocus();
  QTest::keyClick(&view, Qt::Key_A, Qt::ControlModifier);
  QTest::keyClick(&view, Qt::Key_C, Qt::ControlModifier);
  EXPECT_EQ(QApplication::clipboard()->text().split('\n', Qt::SkipEmptyParts).size(), 4);
}

TEST_F(DecisionPanelTest, savesTheLogAndSaysWhenItCannot) {
  fly(3000);
  fly(6000);
  const test::ScratchDir dir;
  EXPECT_TRUE(panel_.saveLog(QString::fromStdString((dir / "log.csv").string())).empty());
  const std::string saved = test::readFile(dir / "log.csv");
  EXPECT_EQ(std::count(saved.begin(), saved.end(), '\n'), 3);
  EXPECT_FALSE(panel_.saveLog(QString::fromStdString((dir / "no" / "log.csv").string())).empty());
}

TEST_F(DecisionPanelTest, showsWhoChangedEachLeverAndWhy) {
  LiveFrame frame;
  frame.decision = decide(test::inputAt(6000, 0), draft_.active(), memory_);
  frame.decision.weather.farReason = FarReason::fixed;
  frame.decision.weather.farM = 20e3;
  frame.levers = leversOf(frame.decision, *draft_.active());
  frame.hold.reason = HoldReason::lowered;
  frame.levers->drawn = withBudget(frame.levers->policy, {8, 1, 1, 1});
  panel_.showFrame(frame);
  panel_.show();
  ASSERT_TRUE(QTest::qWaitFor([&] { return panel_.levers().item(0, 0)->text() == "8 px"; }));
  EXPECT_EQ(panel_.levers().item(0, 1)->text(), "preset 2 px, budget 8 px");
  EXPECT_TRUE(panel_.levers().item(0, 1)->toolTip().contains("lowered to"));
  EXPECT_EQ(panel_.levers().item(1, 1)->text(), "preset");
  EXPECT_EQ(panel_.levers().item(3, 1)->text(), "preset unlimited, weather 20000 m");
  EXPECT_TRUE(panel_.levers().item(3, 1)->toolTip().contains("fixed"));
}

TEST_F(DecisionPanelTest, showsSchemeAndReason) {
  fly(6000);
  const auto isSaid = [this](const QString& text) {
    for (const QLabel* label : panel_.findChildren<QLabel*>())
      if (label->text() == text) return true;
    return false;
  };
  EXPECT_TRUE(test::eventually([&] { return isSaid("Dynamic: depth map 400 × 300 px"); }));
  DecisionMemory memory;
  EXPECT_TRUE(isSaid(QString::fromStdString(
      explain(decide(test::inputAt(6000, 0), draft_.active(), memory), draft_.active()))));
}

TEST(DecisionLog, isBoundedAndForgetsTheOldest) {
  DecisionLog log;
  FrameDecision decision;
  for (int i = 0; i < 25'000; ++i) {
    decision.band = i % 2;
    ASSERT_TRUE(log.isChange(decision));
    log.append(i, static_cast<std::uint64_t>(i), decision, "reason");
  }
  EXPECT_LE(log.rowCount(), DecisionLog::kCapacity);
  EXPECT_EQ(log.forgotten() + static_cast<std::uint64_t>(log.rowCount()), 25'000u);
  EXPECT_EQ(log.index(log.rowCount() - 1, DecisionLog::kPacket).data().toString(), "24999");
}

TEST(DecisionLog, quotesReasonsInCsv) {
  DecisionLog log;
  log.append(1.5, 7, FrameDecision{}, "a \"quoted\", comma");
  EXPECT_EQ(log.toCsv(),
            "time_s,packet,scheme,depth_map_px,reason\n1.500,7,frustum,none,\"a \"\"quoted\"\", comma\"\n");
}

}  // namespace
}  // namespace trimtab::views
