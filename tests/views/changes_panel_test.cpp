// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/changes_panel.h"

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QTableView>

#include "application.h"
#include "views/model/changes_model.h"
#include "views/model/value_text.h"

namespace trimtab::views {
namespace {

class ChangesPanelTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(panel_, {700, 300}); }
  QString cell(int row, int column) const {
    const QAbstractItemModel& model = *panel_.table().model();
    return model.data(model.index(row, column)).toString();
  }
  int rows() const { return panel_.table().model()->rowCount(); }

  Draft draft_;
  mutable ChangesPanel panel_{draft_};
};

TEST_F(ChangesPanelTest, aLineSaysWhatWasChangedFromWhatToWhatAndWhen) {
  draft_.setValue("lod.scale", 4.0);
  draft_.setValue("view.near_m", 2.0);
  ASSERT_EQ(rows(), 3);
  EXPECT_EQ(cell(1, ChangesModel::kWhat), "LOD scale");
  EXPECT_EQ(cell(1, ChangesModel::kBefore), "1");
  EXPECT_EQ(cell(1, ChangesModel::kAfter), "4");
  EXPECT_EQ(cell(2, ChangesModel::kAfter), "2 m") << "with its unit";
  EXPECT_FALSE(cell(2, ChangesModel::kWhen).isEmpty());
  EXPECT_EQ(panel_.summary(), "2 parameters differ from the file.");
}

TEST_F(ChangesPanelTest, oneChangeIsRevertedAndLaterOnesStay) {
  draft_.setValue("lod.scale", 4.0);
  draft_.setValue("view.near_m", 2.0);
  QTableView& table = panel_.table();
  table.setCurrentIndex(table.model()->index(1, 0));
  table.setFocus();
  QTest::keyClick(&table, Qt::Key_Delete);
  EXPECT_EQ(test::numberOf(draft_, "lod.scale"), 1);
  EXPECT_EQ(test::numberOf(draft_, "view.near_m"), 2);
  ASSERT_EQ(rows(), 4) << "it is a step that can be undone";
  draft_.undoStack().undo();
  EXPECT_EQ(test::numberOf(draft_, "lod.scale"), 4);
}

TEST_F(ChangesPanelTest, aClickGoesBackAndForward) {
  draft_.setValue("lod.scale", 4.0);
  draft_.setValue("lod.scale", 5.0);
  QTableView& table = panel_.table();
  const auto click = [&](int row) {
    const QRect at = table.visualRect(table.model()->index(row, 0));
    QTest::mouseClick(table.viewport(), Qt::LeftButton, Qt::NoModifier, at.center());
  };
  click(0);
  EXPECT_EQ(test::numberOf(draft_, "lod.scale"), 1);
  EXPECT_EQ(rows(), 3) << "undone steps stay until there is a new one";
  click(1);
  EXPECT_EQ(test::numberOf(draft_, "lod.scale"), 4);
  draft_.setValue("view.near_m", 2.0);
  EXPECT_EQ(rows(), 3);
  EXPECT_EQ(cell(2, ChangesModel::kWhat), "Near plane");
  draft_.load(Preset{});
  EXPECT_EQ(rows(), 1);
}

TEST_F(ChangesPanelTest, marksWhatWasSavedAndCountsFromThere) {
  draft_.setValue("lod.scale", 4.0);
  draft_.markSaved();
  EXPECT_EQ(cell(1, ChangesModel::kWhat), "LOD scale, saved");
  EXPECT_EQ(panel_.summary(), "Nothing differs from the file.");
}

TEST_F(ChangesPanelTest, ofListsOnlyTheEntriesThatDifferAreNamed) {
  CurvePoints curve = test::curveOf(draft_, "fuzzy.altitude.curve_ft");
  const std::string old = toText(*findRow("fuzzy.altitude.curve_ft"), ParameterValue{curve});
  curve.point[1].y = 0.55;
  draft_.setValue("fuzzy.altitude.curve_ft", curve);
  EXPECT_EQ(cell(1, ChangesModel::kAfter), QString::number(curve.point[1].x) + ":0.55");
  EXPECT_TRUE(QString::fromStdString(old).split(' ').contains(cell(1, ChangesModel::kBefore)));
}

TEST_F(ChangesPanelTest, aStepOfManyParametersNamesEach) {
  draft_.setValue("lod.scale", 4.0);
  draft_.setValue("host.extrapolate", false);
  draft_.resetAll();
  EXPECT_EQ(cell(3, ChangesModel::kWhat), "Reset All to the file (2 parameters)");
  EXPECT_TRUE(cell(3, ChangesModel::kBefore).contains("LOD scale 4")) << cell(3, 1).toStdString();
  EXPECT_TRUE(stepText(draft_.step(2)).contains("LOD scale: 4 → 1"));
  panel_.table().selectAll();
  panel_.table().actions().constFirst()->trigger();
  EXPECT_EQ(QApplication::clipboard()->text().count('\n'), 5);
}

TEST(ChangesModel, aNameWithAPlaceholderIsShownAsItIs) {
  Draft draft;
  ChangesModel model(draft);
  TuningParameters other = draft.parameters();
  findRow("lod.scale")->set(other, 4.0);
  findRow("host.extrapolate")->set(other, false);
  draft.takeParameters(other, "Switch to A, 50 %2");
  EXPECT_EQ(model.data(model.index(1, ChangesModel::kWhat), Qt::DisplayRole).toString(),
            "Switch to A, 50 %2 (2 parameters)");
}

}  // namespace
}  // namespace trimtab::views
