// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/static_lod_panel.h"

#include <QCheckBox>
#include <QLabel>
#include <QSignalSpy>
#include <QSlider>
#include <map>
#include <sstream>

#include "application.h"
#include "tests/support.h"
#include "views/controls/choice_box.h"

namespace trimtab::views {
namespace {

StaticLodSummary someTrees() {
  StaticLodSummary trees;
  trees.trianglesPerNode = 2000;
  trees.levels = 4;
  trees.tiles = 3;
  trees.nodes = 45;
  trees.sourceTriangles = 40000;
  trees.faces = 100000;
  trees.distinctFaces = 90000;
  trees.facesOfLevel = {6000, 12000, 24000, 40000};
  return trees;
}

class StaticLodPanelTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(panel_, {440, 700}); }
  bool says(const QString& text) const {
    for (const QLabel* label : panel_.findChildren<QLabel*>())
      if (label->isVisible() && label->text().contains(text)) return true;
    return false;
  }

  Draft draft_;
  StaticLodPanel panel_{draft_};
};

TEST_F(StaticLodPanelTest, saysHowToGetTreesWhereThereAreNone) {
  EXPECT_TRUE(says(QStringLiteral(".btg.gz")));
  EXPECT_EQ(panel_.depth(), -1);
  EXPECT_FALSE(panel_.picture());
  panel_.setTrees(someTrees());
  EXPECT_FALSE(says(QStringLiteral(".btg.gz")));
  panel_.setTrees(std::nullopt);
  EXPECT_TRUE(says(QStringLiteral(".btg.gz")));
}

TEST_F(StaticLodPanelTest, showsTheTerrainBesideThePublishedRow) {
  panel_.setTrees(someTrees());
  for (const char* text : {"30,987", "126,520", "4.08", "40,000", "100,000", "90,000", "2.25"})
    EXPECT_TRUE(says(QString::fromLatin1(text))) << text;
}

TEST_F(StaticLodPanelTest, knowsThePublishedRow) {
  TRIMTAB_NEEDS_SHARED("published/static_lod.csv");
  std::istringstream csv(test::readFile(test::sharedDir() / "published/static_lod.csv"));
  const PublishedStaticLod p;
  const std::map<std::string, std::uint64_t> ours{{"triangles_original", p.triangles},
                                                  {"n", p.trianglesPerNode},
                                                  {"levels", p.levels},
                                                  {"faces_all_levels", p.faces}};
  std::size_t found = 0;
  for (std::string line; std::getline(csv, line);) {
    const auto comma = line.find(',');
    const auto mine = ours.find(line.substr(0, comma));
    if (mine == ours.end()) continue;
    EXPECT_EQ(std::to_string(mine->second), line.substr(comma + 1)) << line;
    ++found;
  }
  EXPECT_EQ(found, ours.size());
}

TEST_F(StaticLodPanelTest, showsWhatIsDrawnOfEachLevel) {
  panel_.setTrees(someTrees());
  EXPECT_TRUE(says(QStringLiteral("tiled levels are drawn")));
  LiveFrame frame;
  const auto result = std::make_shared<FrameResult>();
  frame.result = result;
  result->staticLod.drawn = true;
  result->staticLod.triangles[1] = 2345;
  result->staticLod.triangles[3] = 10000;
  result->staticLod.nodes[1] = 2;
  panel_.showFrame(frame);
  EXPECT_TRUE(test::eventually([&] { return says(QStringLiteral("12,345 triangles in 2 nodes")); }));
  bool bars = false;
  for (const QWidget* each : panel_.findChildren<QWidget*>())
    bars |= each->accessibleDescription().contains(QStringLiteral("2,345 of 12,000"));
  EXPECT_TRUE(bars);
}

TEST_F(StaticLodPanelTest, goesFromLevelToLevelByKeyboardAlone) {
  panel_.setTrees(someTrees());
  QSignalSpy spy(&panel_, &StaticLodPanel::overlayChanged);
  QSlider* slider = nullptr;
  for (QSlider* each : panel_.findChildren<QSlider*>())
    if (each->accessibleName().startsWith(QStringLiteral("Level"))) slider = each;
  ASSERT_TRUE(slider);
  EXPECT_NE(slider->focusPolicy() & Qt::TabFocus, 0);
  EXPECT_EQ(slider->maximum(), 3);
  slider->setFocus();
  QTest::keyClick(slider, Qt::Key_Right);
  EXPECT_EQ(panel_.depth(), 1) << "moving the slider shows the level";
  ASSERT_FALSE(spy.isEmpty());
  EXPECT_EQ(spy.last(), (QList<QVariant>{1, false}));
  EXPECT_TRUE(says(QStringLiteral("12,000 faces")));
  QTest::keyClick(slider, Qt::Key_End);
  EXPECT_EQ(spy.last(), (QList<QVariant>{3, false}));

  for (QCheckBox* box : panel_.findChildren<QCheckBox*>()) {
    EXPECT_NE(box->focusPolicy() & Qt::TabFocus, 0);
    QTest::keyClick(box, Qt::Key_Space);
  }
  EXPECT_EQ(spy.last(), (QList<QVariant>{-1, true})) << "one level off, the picture on";
}

TEST_F(StaticLodPanelTest, takesTheOverlayBackWithTheTrees) {
  panel_.setTrees(someTrees());
  for (QCheckBox* box : panel_.findChildren<QCheckBox*>()) box->setChecked(true);
  EXPECT_EQ(panel_.depth(), 0);
  QSignalSpy spy(&panel_, &StaticLodPanel::overlayChanged);
  panel_.setTrees(std::nullopt);
  ASSERT_FALSE(spy.isEmpty());
  EXPECT_EQ(spy.last(), (QList<QVariant>{-1, false}));
}

TEST_F(StaticLodPanelTest, editsThePreset) {
  const auto boxes = panel_.findChildren<ChoiceBox*>();
  ASSERT_FALSE(boxes.isEmpty());
  const int before = boxes.front()->currentIndex();
  boxes.front()->setCurrentIndex(static_cast<int>(ErrorMeasure::as_published));
  EXPECT_EQ(draft_.active()->staticLod.error, ErrorMeasure::as_published);
  draft_.undoStack().undo();
  EXPECT_EQ(draft_.active()->staticLod.error, ErrorMeasure{before});
  EXPECT_EQ(boxes.front()->currentIndex(), before);
}

}  // namespace
}  // namespace trimtab::views
