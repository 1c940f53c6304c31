// SPDX-License-Identifier: GPL-3.0-or-later
#include <QDockWidget>
#include <QTableView>
#include <cmath>

#include "app/workbench/docks/changes_dock.h"
#include "gui_support.h"
#include "views/panels/changes_panel.h"

namespace trimtab::test {
namespace {

class WorkbenchChanges : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    ASSERT_NO_FATAL_FAILURE(activate());
  }
  views::Snapshots& snapshots() { return w().panels().changes->snapshots(); }
  double scale() { return w().draft().parameters().lod.scale.value(); }
};

TEST_F(WorkbenchChanges, aKeySwitchesSnapshotsAndTheirImagesAreMeasured) {
  QTest::keyClick(&w(), Qt::Key_F9);
  ASSERT_TRUE(snapshots().isKept(0));
  ASSERT_TRUE(w().draft().setText("lod.scale", "4").empty());
  QTest::keyClick(&w(), Qt::Key_F10, Qt::ShiftModifier);
  QTest::keyClick(&w(), Qt::Key_F9);
  EXPECT_EQ(scale(), 1);
  EXPECT_TRUE(waitFor([&] { return snapshots().images(0) > 0; }));
  QTest::keyClick(&w(), Qt::Key_F10);
  EXPECT_EQ(scale(), 4);
  EXPECT_TRUE(waitFor([&] { return snapshots().images(1) > 0; }));
  EXPECT_GT(snapshots().medianMs(0), 0) << "the other's result stays";
  EXPECT_GT(snapshots().medianMs(1), 0);
}

TEST_F(WorkbenchChanges, theErrorOfASnapshotIsMeasuredWhileItsResultsAreSeen) {
  EXPECT_FALSE(w().controllers().errors->dock().live().isOn());
  workbench::raiseDock(*w().panels().changes);
  QCoreApplication::processEvents();
  QTest::keyClick(&w(), Qt::Key_F9);
  EXPECT_TRUE(w().controllers().errors->dock().live().isOn());
  look(-12);
  EXPECT_TRUE(waitFor([&] { return std::isfinite(snapshots().medianError(0)); }));
  ASSERT_TRUE(w().draft().setText("lod.scale", "4").empty());
  EXPECT_FALSE(w().controllers().errors->dock().live().isOn()) << "no snapshot is measured";
}

}  // namespace
}  // namespace trimtab::test
