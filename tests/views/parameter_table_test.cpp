// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/controls/parameter_table.h"

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QToolButton>
#include <algorithm>
#include <set>

#include "application.h"
#include "trimtab/preset/preset.h"
#include "views/controls/choice_box.h"
#include "views/controls/note_line.h"
#include "views/controls/number_box.h"
#include "views/controls/parameter_line.h"
#include "views/controls/parameter_lines.h"
#include "views/controls/parameter_slider.h"

namespace trimtab::views {
namespace {

using test::numberOf;

class ParameterTableTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(table_, {560, 760}); }
  template <class Editor>
  Editor& editor(std::string_view key) {
    Editor* found = qobject_cast<Editor*>(table_.line(key)->editor());
    EXPECT_NE(found, nullptr) << key;
    return *found;
  }
  void type(QWidget& widget, const QString& text) {
    widget.setFocus();
    QLineEdit* line = qobject_cast<QLineEdit*>(&widget);
    if (!line) line = widget.findChild<QLineEdit*>();
    line->selectAll();
    QTest::keyClicks(line, text);
    QTest::keyClick(line, Qt::Key_Return);
  }
  bool isShown(std::string_view key) const {
    const auto keys = table_.visibleKeys();
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  }

  Draft draft_;
  ParameterTable table_{draft_};
};

TEST_F(ParameterTableTest, aNameHasOneLineWhereThereIsRoom) {
  table_.tier().setCurrentIndex(1);
  test::expose(table_, {1100, 760});
  for (const ParameterRow& row : parameterRows())
    for (const QLabel* label : table_.findChildren<QLabel*>())
      if (label->buddy() == table_.line(row.key)->editor()) {
        EXPECT_LT(label->heightForWidth(label->width()), 2 * label->fontMetrics().lineSpacing())
            << row.key << ": " << label->width() << " px";
      }
}

TEST_F(ParameterTableTest, hasALineForEveryRow) {
  for (const ParameterRow& row : parameterRows()) {
    const ParameterLine* line = table_.line(row.key);
    ASSERT_NE(line, nullptr) << row.key;
    EXPECT_FALSE(line->editor()->accessibleName().isEmpty()) << row.key;
    EXPECT_NE(line->editor()->focusPolicy(), Qt::NoFocus) << row.key;
    EXPECT_FALSE(line->resetButton()->isEnabled()) << row.key;
  }
}

TEST_F(ParameterTableTest, basicHidesAdvancedRowsUnlessTheyAreSearchedOrChanged) {
  EXPECT_FALSE(isShown("fuzzy.pitch.step"));
  table_.search().setText("pitch step");
  EXPECT_TRUE(isShown("fuzzy.pitch.step"));
  EXPECT_FALSE(isShown("lod.scale"));
  table_.search().clear();
  table_.tier().setCurrentIndex(1);
  EXPECT_EQ(table_.visibleKeys().size(), parameterRows().size());
  table_.tier().setCurrentIndex(0);
  draft_.setValue("fuzzy.pitch.step", 0.02);
  table_.changedOnly().setChecked(true);
  ASSERT_EQ(table_.visibleKeys().size(), 1u);
  EXPECT_EQ(table_.visibleKeys()[0], "fuzzy.pitch.step");
}

TEST_F(ParameterTableTest, searchLooksAtLabelKeyAndHelp) {
  const struct {
    const char* text;
    const char* key;
  } found[] = {{"hysteresis", "fuzzy.hysteresis"},
               {"LOD SCALE", "lod.scale"},
               {"budget_ms", "measure.budget_ms"},
               {"membership offset", "fuzzy.altitude.membership_offset"}};
  for (const auto& [text, key] : found) {
    table_.search().setText(text);
    EXPECT_TRUE(isShown(key)) << text;
    EXPECT_LT(table_.visibleKeys().size(), parameterRows().size() / 2) << text;
  }
  table_.search().setText("no such thing");
  EXPECT_TRUE(table_.visibleKeys().empty());
}

TEST_F(ParameterTableTest, typedNumbersAreOneStepAndUnitsAreConverted) {
  type(editor<NumberBox>("view.near_m"), "10 ft");
  EXPECT_DOUBLE_EQ(numberOf(draft_, "view.near_m"), 3.048);
  EXPECT_EQ(draft_.undoStack().count(), 1);
  EXPECT_EQ(draft_.undoStack().undoText(), "Change Near plane");
  type(editor<NumberBox>("view.width_px"), "1,920");
  EXPECT_EQ(numberOf(draft_, "view.width_px"), 1920);
  draft_.undoStack().undo();
  EXPECT_EQ(editor<NumberBox>("view.width_px").value(), 1280);
}

TEST_F(ParameterTableTest, textThatIsNoNumberOrOutOfRangeIsRefusedAndShown) {
  const char* const bad[] = {"abc", "", "-3", "99999999", "12 kt"};
  for (const char* text : bad) {
    type(editor<NumberBox>("view.near_m"), text);
    EXPECT_EQ(numberOf(draft_, "view.near_m"), 1) << text;
    EXPECT_TRUE(table_.line("view.near_m")->problem().contains("refused")) << text;
    EXPECT_EQ(editor<NumberBox>("view.near_m").text(), "1 m") << text;
  }
  EXPECT_EQ(draft_.undoStack().count(), 0);
  type(editor<NumberBox>("view.near_m"), "2");
  EXPECT_TRUE(table_.line("view.near_m")->problem().isEmpty()) << "a good value takes the message away";
}

TEST_F(ParameterTableTest, aRefusalMovesNoControlAndGivesWayToThePointer) {
  const auto places = [&] {
    std::vector<QPoint> all;
    for (const std::string_view key : table_.visibleKeys())
      all.push_back(table_.line(key)->editor()->mapTo(&table_, QPoint()));
    return all;
  };
  table_.tier().setCurrentIndex(1);
  QTest::qWait(20);
  const auto before = places();
  type(editor<NumberBox>("fuzzy.hysteresis"), "nonsense");
  QTest::qWait(20);
  ASSERT_FALSE(table_.line("fuzzy.hysteresis")->problem().isEmpty());
  EXPECT_EQ(places(), before);
  NoteBubble* bubble = nullptr;
  for (NoteBubble* each : table_.findChildren<NoteBubble*>())
    if (each->isVisible()) bubble = each;
  ASSERT_NE(bubble, nullptr) << "the refusal is in sight";
  EXPECT_FALSE(
      bubble->geometry().intersects(editor<NumberBox>("fuzzy.hysteresis").parentWidget()->geometry()));
  QEnterEvent enter({}, {}, {});
  QCoreApplication::sendEvent(bubble, &enter);
  EXPECT_FALSE(bubble->isVisible()) << "what it covers can be reached";
  editor<NumberBox>("fuzzy.hysteresis").clearFocus();
  editor<NumberBox>("fuzzy.hysteresis").setFocus();
  EXPECT_TRUE(bubble->isVisible()) << "the focus brings it back";
}

TEST_F(ParameterTableTest, aNumberThatTheBoxCannotShowExactlyIsNotTouchedByLookingAtIt) {
  const double odd = 0.1 + 0.2;
  draft_.setValue("lod.scale", odd);
  NumberBox& box = editor<NumberBox>("lod.scale");
  box.setFocus();
  box.clearFocus();
  EXPECT_EQ(numberOf(draft_, "lod.scale"), odd);
}

TEST_F(ParameterTableTest, curvesAndBandsAreTypedAsText) {
  type(editor<QLineEdit>("fuzzy.pitch.curve_deg"), "-20:1 20:0");
  EXPECT_EQ(test::curveOf(draft_, "fuzzy.pitch.curve_deg"), (CurvePoints{{-20, 1}, {20, 0}}));
  type(editor<QLineEdit>("fuzzy.bands_px"), "0.2:100x");
  EXPECT_EQ(test::bandsOf(draft_).size, 4u);
  EXPECT_TRUE(table_.line("fuzzy.bands_px")->problem().contains("refused"));
}

TEST_F(ParameterTableTest, aBrokenRuleIsShownAtItsLine) {
  draft_.setValue("fuzzy.hysteresis", 0.3);
  EXPECT_TRUE(table_.line("fuzzy.hysteresis")->problem().contains("half the narrowest band"));
  draft_.undoStack().undo();
  EXPECT_TRUE(table_.line("fuzzy.hysteresis")->problem().isEmpty());
}

TEST_F(ParameterTableTest, resetOfOneAndOfAll) {
  draft_.setValue("lod.scale", 3.0);
  draft_.setValue("fuzzy.combination", ChoiceIndex{1});
  draft_.setValue("host.extrapolate", false);
  EXPECT_TRUE(table_.line("lod.scale")->resetButton()->isEnabled());
  table_.line("lod.scale")->resetButton()->click();
  EXPECT_EQ(numberOf(draft_, "lod.scale"), 1);
  EXPECT_FALSE(table_.line("lod.scale")->resetButton()->isEnabled());
  for (QPushButton* button : table_.findChildren<QPushButton*>())
    if (button->text() == "Reset all") button->click();
  EXPECT_FALSE(draft_.isChanged("fuzzy.combination"));
  EXPECT_TRUE(editor<QCheckBox>("host.extrapolate").isChecked());
  draft_.undoStack().undo();
  EXPECT_FALSE(editor<QCheckBox>("host.extrapolate").isChecked());
  EXPECT_EQ(editor<QComboBox>("fuzzy.combination").currentIndex(), 1);
}

TEST_F(ParameterTableTest, anUntouchedPresetReadsAsUnchangedAndResetAllKeepsIt) {
  draft_.load(*loadPreset("as-published"));
  EXPECT_EQ(table_.summary(), "nothing differs.");
  table_.changedOnly().setChecked(true);
  EXPECT_TRUE(table_.visibleKeys().empty());
  draft_.setValue("lod.scale", 3.0);
  EXPECT_EQ(table_.summary(), "1 parameter differs.");
  EXPECT_EQ(table_.visibleKeys(), std::vector<std::string_view>{"lod.scale"});
  for (QPushButton* button : table_.findChildren<QPushButton*>())
    if (button->text() == "Reset all") button->click();
  EXPECT_EQ(numberOf(draft_, "fuzzy.hysteresis"), 0) << "as published, not as the program's default";
  EXPECT_EQ(numberOf(draft_, "lod.scale"), 1);
}

TEST_F(ParameterTableTest, aRowShowsTheValuesOfFileBaseAndDefaultsAndGoesBackToEach) {
  test::expose(table_, {800, 760});
  Preset mine = *loadPreset("as-published");
  mine.base = "as-published";
  mine.parameters.scheme.hysteresis = Membership{0.02};
  draft_.load(mine);
  draft_.setValue("fuzzy.hysteresis", 0.04);
  ParameterLine& line = *table_.line("fuzzy.hysteresis");
  const struct {
    Reference of;
    const char* text;
    double value;
  } columns[] = {
      {Reference::base, "0", 0}, {Reference::defaults, "0.05", 0.05}, {Reference::file, "0.02", 0.02}};
  for (const auto& [of, text, value] : columns) {
    QToolButton& button = *line.valueButton(of);
    EXPECT_TRUE(button.isVisible() && button.isEnabled()) << text;
    EXPECT_EQ(button.text(), text);
    button.click();
    EXPECT_EQ(numberOf(draft_, "fuzzy.hysteresis"), value);
    EXPECT_FALSE(button.isEnabled()) << text;
  }
  draft_.markSaved();
  EXPECT_EQ(line.valueButton(Reference::file)->text(), "0.02");
  draft_.load(Preset{});
  EXPECT_FALSE(line.valueButton(Reference::base)->isVisible()) << "the same as the defaults";
}

TEST_F(ParameterTableTest, comparesWithWhatIsChosen) {
  draft_.load(*loadPreset("as-published"));
  QComboBox& with = table_.comparedWith();
  const int defaults = with.findData(int(Reference::defaults));
  with.setCurrentIndex(defaults);
  emit with.activated(defaults);
  EXPECT_NE(table_.summary(), "nothing differs.");
  EXPECT_TRUE(table_.line("fuzzy.hysteresis")->resetButton()->isEnabled());
  table_.line("fuzzy.hysteresis")->resetButton()->click();
  EXPECT_EQ(numberOf(draft_, "fuzzy.hysteresis"), 0.05);
  EXPECT_EQ(with.findData(int(Reference::pinned)), -1);
  draft_.pin("snapshot A", draft_.parameters());
  EXPECT_GE(with.findData(int(Reference::pinned)), 0);
}

TEST_F(ParameterTableTest, slidersSpanTheUsualRangeAndDragInOneStep) {
  ParameterSlider slider(draft_, "lod.scale");
  test::expose(slider, {300, 30});
  // Exponential: half way between 0.25 and 16 is their geometric mean.
  slider.setSliderDown(true);
  for (int i = 300; i <= 500; i += 20) slider.setValue(i);
  slider.setSliderDown(false);
  EXPECT_NEAR(numberOf(draft_, "lod.scale"), 2.0, 0.05);
  EXPECT_EQ(draft_.undoStack().count(), 1);
  draft_.undoStack().undo();
  EXPECT_EQ(numberOf(draft_, "lod.scale"), 1);
  slider.setValue(1000);
  EXPECT_EQ(numberOf(draft_, "lod.scale"), 16);
  draft_.setValue("lod.scale", 50.0);
  EXPECT_EQ(slider.value(), 1000) << "beyond the usual range it stays at its end";
  EXPECT_EQ(numberOf(draft_, "lod.scale"), 50.0);
}

TEST_F(ParameterTableTest, separateClicksOnTheArrowsAreSeparateSteps) {
  NumberBox& box = editor<NumberBox>("view.horizontal_fov_deg");
  const QPoint up(box.width() - 6, 5);
  for (int i = 0; i < 3; ++i) QTest::mouseClick(&box, Qt::LeftButton, Qt::NoModifier, up);
  EXPECT_EQ(numberOf(draft_, "view.horizontal_fov_deg"), 63);
  EXPECT_EQ(draft_.undoStack().count(), 3);
}

TEST_F(ParameterTableTest, theWheelDoesNotChangeWhatIsMerelyScrolledPast) {
  NumberBox& box = editor<NumberBox>("lod.scale");
  table_.search().setFocus();
  QWheelEvent event(QPointF(5, 5), box.mapToGlobal(QPointF(5, 5)), {}, {0, 120}, Qt::NoButton, Qt::NoModifier,
                    Qt::NoScrollPhase, false);
  QApplication::sendEvent(&box, &event);
  EXPECT_EQ(numberOf(draft_, "lod.scale"), 1);
}

TEST_F(ParameterTableTest, toolTipsNameTheDocumentsThatTheyCite) {
  const auto tip = [](const char* key) { return helpText(*findRow(key)); };
  const QString both = tip("fuzzy.altitude.reading");
  EXPECT_TRUE(both.contains("A: C. J. Lee, K. C. Park, K. Kim: Dynamic Culling Scheme for Graphic"))
      << both.toStdString();
  EXPECT_TRUE(both.contains("B: C. Lee, S. Kang, K. Kim"));
  EXPECT_FALSE(both.contains("C: J. H. Lim"));
  EXPECT_TRUE(tip("motion.blur_frames").contains("Helmet Mounted"));
  for (const ParameterRow& row : parameterRows())
    if (!row.source.empty() && row.source[0] >= 'A' && row.source[0] <= 'E' &&
        (row.source.size() == 1 || row.source[1] == ':' || row.source[1] == ',')) {
      EXPECT_TRUE(helpText(row).contains("<br>" + QString(QChar(row.source[0])) + ": ")) << row.key;
    }
  EXPECT_TRUE(documentOf('F').empty());
}

TEST_F(ParameterTableTest, tabReachesEveryEditor) {
  table_.activateWindow();
  table_.tier().setCurrentIndex(1);
  table_.search().setFocus();
  std::set<QWidget*> reached;
  for (int i = 0; i < 400; ++i) {
    QWidget* now = QApplication::focusWidget();
    ASSERT_NE(now, nullptr);
    if (!reached.insert(now).second && now == &table_.search()) break;
    QTest::keyClick(now, Qt::Key_Tab);
  }
  for (const ParameterRow& row : parameterRows())
    EXPECT_TRUE(reached.contains(table_.line(row.key)->editor())) << row.key;
}

TEST_F(ParameterTableTest, arrowsGoToTheDecimalsThatPeopleType) {
  draft_.setValue("measure.budget_ms", 0.2);
  NumberBox& box = editor<NumberBox>("measure.budget_ms");
  box.stepUp();
  EXPECT_EQ(numberOf(draft_, "measure.budget_ms"), 0.3) << "3 * 0.1 is 0.30000000000000004";
  EXPECT_EQ(box.text(), "0.3 ms");
}

TEST(ParameterLines, aGoodValueTakesTheRefusalAway) {
  Draft draft;
  constexpr const char* kKeys[] = {"view.near_m"};
  ParameterLines lines(draft, kKeys);
  test::expose(lines, {420, 80});
  const auto type = [&](const QString& text) {
    auto* line = lines.findChild<NumberBox*>()->findChild<QLineEdit*>();
    line->setFocus();
    line->selectAll();
    QTest::keyClicks(line, text);
    QTest::keyClick(line, Qt::Key_Return);
  };
  const auto* said = lines.findChild<NoteBubble*>();
  type("-3");
  EXPECT_TRUE(said->text().contains("refused")) << said->text().toStdString();
  type("2");
  EXPECT_TRUE(said->text().isEmpty()) << said->text().toStdString();
}

}  // namespace
}  // namespace trimtab::views
