// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/editors/bands_editor.h"

#include <QLabel>
#include <QSignalSpy>
#include <QTableView>

#include "application.h"
#include "views/controls/number_box.h"
#include "views/editors/band_edit.h"
#include "views/editors/band_scale.h"

namespace trimtab::views {
namespace {

using test::bandsOf;
using test::drag;

class BandsEditorTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(editor_, {560, 620}); }
  BandScale& scale() { return editor_.scale(); }
  QPointF edge(std::size_t band) { return scale().pixelOf(bandsOf(draft_).band[band].low); }
  bool type(int row, int column, const QString& text) {
    QAbstractItemModel* model = editor_.table().model();
    return model->setData(model->index(row, column), text, Qt::EditRole);
  }

  Draft draft_;
  BandsEditor editor_{draft_};
};

TEST_F(BandsEditorTest, dragMovesAnEdgeInOneStepAndUndoRestoresIt) {
  const BandList before = bandsOf(draft_);
  drag(scale(), edge(2), scale().pixelOf(1.2));
  EXPECT_NEAR(bandsOf(draft_).band[2].low, 1.2, 0.011);
  EXPECT_EQ(bandsOf(draft_).band[2].widthPx, 640);
  EXPECT_EQ(draft_.undoStack().count(), 1);
  draft_.undoStack().undo();
  EXPECT_EQ(bandsOf(draft_), before);
}

TEST_F(BandsEditorTest, neighboursStopAnEdge) {
  drag(scale(), edge(1), scale().pixelOf(1.9));
  EXPECT_DOUBLE_EQ(bandsOf(draft_).band[1].low, 0.99);
  drag(scale(), edge(0), scale().pixelOf(0) - QPointF(50, 0));
  EXPECT_DOUBLE_EQ(bandsOf(draft_).band[0].low, 0.01);
}

TEST_F(BandsEditorTest, anEdgeThatLeavesNoRoomForHysteresisIsShownAndTheLastValidSetRuns) {
  drag(scale(), edge(1), scale().pixelOf(0.96));
  EXPECT_TRUE(draft_.isBroken());
  EXPECT_NEAR(bandsOf(draft_).band[1].low, 0.96, 0.011);
  EXPECT_LT(draft_.active()->scheme.bands.band[1].low, 0.9) << "the last place of the drag that left room";
  bool said = false;
  for (const QLabel* label : editor_.findChildren<QLabel*>())
    said = said || (label->isVisible() && label->text().contains("Hysteresis:"));
  EXPECT_TRUE(said);
}

TEST_F(BandsEditorTest, escapeCancelsADrag) {
  const BandList before = bandsOf(draft_);
  drag(scale(), edge(1), scale().pixelOf(0.7), false);
  EXPECT_NE(bandsOf(draft_), before);
  QTest::keyClick(&scale(), Qt::Key_Escape);
  EXPECT_EQ(bandsOf(draft_), before);
  EXPECT_EQ(draft_.undoStack().count(), 0);
}

TEST_F(BandsEditorTest, bandsAreSplitAndRemoved) {
  QTest::mouseDClick(&scale(), Qt::LeftButton, Qt::NoModifier, scale().pixelOf(0.75).toPoint());
  ASSERT_EQ(bandsOf(draft_).size, 5u);
  EXPECT_NEAR(bandsOf(draft_).band[2].low, 0.75, 0.011);
  EXPECT_EQ(bandsOf(draft_).band[2].widthPx, 400) << "the size of the band that was split";
  QTest::keyClick(&scale(), Qt::Key_Delete);
  EXPECT_EQ(bandsOf(draft_).size, 4u);
  QSignalSpy refused(&scale(), &BandScale::refused);
  scale().select(0);
  for (int i = 0; i < 6; ++i) QTest::keyClick(&scale(), Qt::Key_Delete);
  EXPECT_EQ(bandsOf(draft_).size, 1u);
  EXPECT_EQ(refused.count(), 3);
}

TEST_F(BandsEditorTest, aFullListTakesNoMoreBands) {
  QSignalSpy refused(&scale(), &BandScale::refused);
  for (int i = 0; i < 20; ++i) scale().addBand(1.51 + 0.02 * i);
  EXPECT_EQ(bandsOf(draft_).size, BandList::kCapacity);
  EXPECT_EQ(refused.count(), 20 - static_cast<int>(BandList::kCapacity - 4));
}

TEST_F(BandsEditorTest, arrowKeysNudgeTheEdge) {
  scale().setFocus();
  scale().select(1);
  QTest::keyClick(&scale(), Qt::Key_Right);
  EXPECT_DOUBLE_EQ(bandsOf(draft_).band[1].low, 0.51);
  QTest::keyClick(&scale(), Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_DOUBLE_EQ(bandsOf(draft_).band[1].low, 0.41);
}

TEST_F(BandsEditorTest, typedSizesAndEdgesAreTakenOrRefused) {
  EXPECT_TRUE(type(1, kBandWidth, "512 px"));
  EXPECT_TRUE(type(1, kBandHeight, "384"));
  EXPECT_TRUE(type(1, kBandFrom, "0.455"));
  const Band band = bandsOf(draft_).band[1];
  EXPECT_EQ(band, (Band{0.455, 512, 384}));
  for (const char* text : {"", "0", "15", "8193", "512.5", "-1", "nan", "wide"})
    EXPECT_FALSE(type(1, kBandWidth, text)) << text;
  for (const char* text : {"", "0.1", "1", "2", "-1", "nan", "inf"})
    EXPECT_FALSE(type(1, kBandFrom, text)) << text;
  EXPECT_FALSE(type(1, kBandTo, "0.9"));
  EXPECT_EQ(bandsOf(draft_).band[1], band);
}

TEST_F(BandsEditorTest, theFilesEdgesStayBehindThoseThatAreDragged) {
  const QPoint old = edge(1).toPoint();
  const auto picture = [&] {
    QCoreApplication::processEvents();
    return scale().grab(QRect(old - QPoint(6, 30), QSize(13, 60))).toImage();
  };
  drag(scale(), edge(1), scale().pixelOf(0.7));
  scale().select(0);
  const QImage behind = picture();
  QTest::mouseMove(&scale(), old + QPoint(20, 0));
  EXPECT_TRUE(scale().toolTip().contains("file: ")) << scale().toolTip().toStdString();
  draft_.markSaved();
  EXPECT_NE(picture(), behind) << "the file has the new edge now";
}

TEST_F(BandsEditorTest, edgesAreTheDecimalsThatPeopleType) {
  ASSERT_TRUE(type(1, kBandFrom, "0.56"));
  scale().select(1);
  QTest::keyClick(&scale(), Qt::Key_Right);
  EXPECT_EQ(bandsOf(draft_).band[1].low, 0.57) << "57 * 0.01 is 0.5700000000000001";
}

TEST_F(BandsEditorTest, aRowIsSelectedAgainAfterTheScaleSelectedNone) {
  QTableView& table = editor_.table();
  const auto click = [&] {
    const QRect cell = table.visualRect(table.model()->index(1, kBandFrom));
    QTest::mouseClick(table.viewport(), Qt::LeftButton, {}, cell.center());
  };
  click();
  ASSERT_EQ(scale().selected(), 1);
  scale().select(-1);
  EXPECT_FALSE(table.currentIndex().isValid());
  click();
  EXPECT_EQ(scale().selected(), 1);
}

}  // namespace
}  // namespace trimtab::views
