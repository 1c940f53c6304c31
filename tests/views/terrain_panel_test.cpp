// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/terrain_panel.h"

#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSignalSpy>
#include <QTableView>

#include "application.h"
#include "tests/support.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::views {
namespace {

TerrainSummary someTerrain() {
  return {.name = QStringLiteral("andes<1>"),
          .source = QStringLiteral("andes.tif"),
          .columns = 1000,
          .rows = 2000,
          .voidsFilled = 20000,
          .bytes = 8'000'000,
          .postM = 30,
          .lowestM = -4,
          .highestM = 6961,
          .southDeg = -33,
          .westDeg = -70.5,
          .northDeg = -32,
          .eastDeg = -69,
          .tiles = {{2048, 4194304, 0, 0.07, kNan, kNan}, {512, 1048576, 0, 12.25, kNan, kNan}},
          .patches = {{
                          2,
                          900,
                          12000,
                          412.3,
                          60.25,
                          512,
                      },
                      {4, 1900, 26000, 290, 41, 388},
                      {8, 4000, 51000, 9.5, 1.625, 14}}};
}

class TerrainPanelTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(panel_, {560, 760}); }
  bool says(const QString& text) const {
    for (const QLabel* label : panel_.findChildren<QLabel*>())
      if (label->isVisible() && label->text().contains(text)) return true;
    return false;
  }
  QTableView& table() { return *panel_.findChild<QTableView*>(); }
  QString cell(int row, int column) { return table().model()->index(row, column).data().toString(); }
  void show(const LiveFrame& frame) {
    panel_.showFrame(frame);
    QTest::qWait(150);
  }

  Draft draft_;
  TerrainPanel panel_{draft_};
};

TEST_F(TerrainPanelTest, saysOfAnOsgSceneWhatItIsAndNothingOfPosts) {
  TerrainSummary scene = someTerrain();
  scene.osgScene = true;
  scene.columns = scene.rows = 2;
  scene.tiles = scene.patches = {};
  panel_.setTerrain(scene);
  EXPECT_TRUE(says(QStringLiteral("A scene of OpenSceneGraph")));
  EXPECT_TRUE(says(QStringLiteral("andes.tif")));
  EXPECT_FALSE(says(QStringLiteral("2 × 2")));
  EXPECT_FALSE(says(QStringLiteral("a post")));
  EXPECT_TRUE(says(QStringLiteral("OpenSceneGraph chooses its levels")));
  EXPECT_FALSE(says(QStringLiteral("In memory")));
  EXPECT_FALSE(table().isVisible());
  panel_.setTerrain(someTerrain());
  EXPECT_TRUE(table().isVisible());
}

TEST_F(TerrainPanelTest, saysWhatToDoWhereThereIsNoTerrain) {
  EXPECT_TRUE(says(QStringLiteral("bake")));
  EXPECT_FALSE(table().isVisible());
}

TEST_F(TerrainPanelTest, saysWhatTheTerrainIsWithUnits) {
  panel_.setTerrain(someTerrain());
  for (const char* text : {"andes&lt;1&gt;", "1,000 × 2,000 posts", "30 m apart", "-4 to 6,961 m", "33° S",
                           "70.5° W", "8 MB", "4 bytes a post", "20,000 voids filled (1 %)"})
    EXPECT_TRUE(says(QString::fromUtf8(text))) << text;
}

TEST_F(TerrainPanelTest, showsTheLevelsOfWhatIsDrawn) {
  panel_.setTerrain(someTerrain());
  show({});
  ASSERT_EQ(table().model()->rowCount(), 2);
  EXPECT_EQ(cell(0, 0), QStringLiteral("0, finest"));
  EXPECT_EQ(cell(1, 3), QStringLiteral("12.3"));
  EXPECT_TRUE(table().isColumnHidden(4)) << "of tiles no rms is known";
  LiveFrame frame;
  const auto result = std::make_shared<FrameResult>();
  frame.result = result;
  result->patches = true;
  frame.levels.nodes[2] = 5;
  frame.levels.triangles[2] = 2345;
  show(frame);
  ASSERT_EQ(table().model()->rowCount(), 3);
  EXPECT_EQ(cell(0, 0), QStringLiteral("0, coarsest"));
  EXPECT_EQ(cell(2, 4), QStringLiteral("1.63"));
  EXPECT_EQ(cell(2, 7), QStringLiteral("5 (2,345)"));
  EXPECT_EQ(cell(1, 7), QStringLiteral("–"));
  EXPECT_FALSE(table().isColumnHidden(4));
}

TEST_F(TerrainPanelTest, saysWhatPagingLacks) {
  panel_.setTerrain(someTerrain());
  LiveFrame frame;
  const auto result = std::make_shared<FrameResult>();
  frame.result = result;
  result->patches = true;
  result->paging = {.waiting = 7,
                    .heldBack = 12,
                    .pagesRead = 40,
                    .bytesRead = 9'000'000,
                    .bytes = 30'000'000,
                    .budgetBytes = 512'000'000,
                    .longestReadMs = 3.25};
  show(frame);
  for (const char* text : {"30 MB of 512 MB", "40 pages", "12 pairs", "7 more pages"})
    EXPECT_TRUE(says(QString::fromUtf8(text))) << text;
  result->paging.waiting = 0;
  result->paging.failed = 3;
  show(frame);
  EXPECT_TRUE(says(QStringLiteral("holds no more")));
  EXPECT_TRUE(says(QStringLiteral("3 pages cannot be read")));
  result->paging.heldBack = result->paging.failed = 0;
  show(frame);
  EXPECT_FALSE(says(QStringLiteral("coarser than asked")));
}

TEST_F(TerrainPanelTest, showsWorkInProgressAndCancelsIt) {
  auto* bar = panel_.findChild<QProgressBar*>();
  EXPECT_FALSE(bar->isVisible());
  panel_.showJob(0.25, QStringLiteral("patches"));
  EXPECT_TRUE(bar->isVisible());
  EXPECT_EQ(bar->value(), 250);
  EXPECT_TRUE(says(QStringLiteral("patches")));
  QSignalSpy asked(&panel_, &TerrainPanel::cancelAsked);
  panel_.findChild<QPushButton*>()->click();
  EXPECT_EQ(asked.size(), 1);
  panel_.endJob();
  EXPECT_FALSE(bar->isVisible());
}

}  // namespace
}  // namespace trimtab::views
