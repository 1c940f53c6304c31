// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/model/snapshots.h"

#include <QLineEdit>
#include <QSignalSpy>
#include <QToolButton>
#include <cmath>

#include "application.h"
#include "views/panels/snapshots_panel.h"

namespace trimtab::views {
namespace {

class SnapshotsTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(panel_, {520, 260}); }
  double scale() const { return test::numberOf(draft_, "lod.scale"); }
  void image(double totalMs, bool newImage = true) {
    LiveFrame frame;
    frame.cost.total = totalMs;
    frame.newImage = newImage;
    snapshots_.showFrame(frame);
  }

  Draft draft_;
  Snapshots snapshots_{draft_};
  SnapshotsPanel panel_{draft_, snapshots_};
};

TEST_F(SnapshotsTest, theFirstPressKeepsAndLaterOnesSwitchInOneStep) {
  panel_.switchButton(0).click();
  draft_.setValue("lod.scale", 4.0);
  draft_.setValue("view.near_m", 2.0);
  panel_.switchButton(1).click();
  EXPECT_EQ(snapshots_.active(), 1);
  panel_.switchButton(0).click();
  EXPECT_EQ(scale(), 1);
  EXPECT_EQ(snapshots_.active(), 0);
  EXPECT_EQ(draft_.undoStack().undoText(), "Switch to Snapshot A");
  EXPECT_EQ(draft_.step(draft_.undoStack().count() - 1).changes.size(), 2u);
  panel_.switchButton(1).click();
  EXPECT_EQ(scale(), 4);
  draft_.undoStack().undo();
  EXPECT_EQ(scale(), 1) << "a switch can be undone";
  EXPECT_FALSE(snapshots_.isKept(2));
}

TEST_F(SnapshotsTest, anEditLeavesTheSnapshotAsItWas) {
  snapshots_.keep(0);
  draft_.setValue("lod.scale", 4.0);
  EXPECT_EQ(snapshots_.active(), -1);
  EXPECT_FALSE(panel_.switchButton(0).isChecked());
  snapshots_.switchTo(0);
  EXPECT_EQ(scale(), 1);
  EXPECT_TRUE(panel_.switchButton(0).isChecked());
}

TEST_F(SnapshotsTest, measuresTheActiveOneSinceTheSwitch) {
  snapshots_.keep(0);
  for (const double ms : {10.0, 90.0, 12.0}) image(ms);
  image(500, false);
  snapshots_.addError(0.02);
  EXPECT_EQ(snapshots_.medianMs(0), 12);
  EXPECT_EQ(snapshots_.images(0), 3u);
  EXPECT_EQ(snapshots_.medianError(0), 0.02);
  draft_.setValue("lod.scale", 4.0);
  image(1);
  EXPECT_EQ(snapshots_.images(0), 3u) << "the draft is no longer the snapshot";
  snapshots_.keep(1);
  image(30);
  EXPECT_EQ(snapshots_.medianMs(1), 30);
  EXPECT_EQ(snapshots_.medianMs(0), 12) << "the other's result stays beside it";
  ASSERT_TRUE(test::eventually([&] { return panel_.resultText(1).contains("30"); }));
  EXPECT_TRUE(panel_.resultText(0).contains("12.0 ms")) << panel_.resultText(0).toStdString();
  EXPECT_TRUE(panel_.resultText(0).contains("FLIP 0.02"));
  snapshots_.switchTo(0);
  EXPECT_TRUE(std::isnan(snapshots_.medianMs(0))) << "since the last switch";
}

TEST_F(SnapshotsTest, thePinnedOneIsAReferenceOfTheDraftUnderItsName) {
  snapshots_.keep(1);
  panel_.nameEdit(1).setText("far cut");
  QTest::keyClick(&panel_.nameEdit(1), Qt::Key_Return);
  panel_.pinButton(1).click();
  EXPECT_EQ(draft_.referenceName(Reference::pinned), "snapshot B, far cut");
  draft_.setValue("lod.scale", 4.0);
  EXPECT_TRUE(draft_.isChanged("lod.scale", Reference::pinned));
  snapshots_.keep(1);
  EXPECT_FALSE(draft_.isChanged("lod.scale", Reference::pinned)) << "what is pinned is kept anew";
  snapshots_.forget(1);
  EXPECT_EQ(draft_.reference(Reference::pinned), nullptr);
  EXPECT_FALSE(panel_.pinButton(1).isChecked());
}

TEST_F(SnapshotsTest, saysHowManyParametersDifferFromTheFile) {
  draft_.setValue("lod.scale", 4.0);
  snapshots_.keep(2);
  EXPECT_TRUE(panel_.resultText(2).startsWith("1 from the file")) << panel_.resultText(2).toStdString();
  draft_.markSaved();
  EXPECT_TRUE(panel_.resultText(2).startsWith("as the file"));
}

}  // namespace
}  // namespace trimtab::views
