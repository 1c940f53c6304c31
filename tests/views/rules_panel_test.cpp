// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/rules_panel.h"

#include <QAbstractItemDelegate>
#include <QComboBox>
#include <QHeaderView>
#include <QLineEdit>
#include <QSignalSpy>
#include <QTableView>
#include <QTemporaryDir>
#include <QToolButton>

#include "application.h"
#include "live_flight.h"
#include "trimtab/fuzzy/combination.h"
#include "views/controls/parameter_line.h"
#include "views/controls/parameter_table.h"
#include "views/editors/rule_viewer.h"
#include "views/editors/rules_editor.h"
#include "views/model/rules_model.h"

namespace trimtab::views {
namespace {

RuleList rulesOf(const Draft& draft) {
  return std::get<RuleList>(draft.value("fuzzy.rules"));
}

class RulesPanelTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(panel_, {560, 620}); }
  RulesEditor& editor() { return panel_.editor(); }
  QTableView& table() { return editor().table(); }
  QModelIndex cell(int row, int column) { return table().model()->index(row, column); }
  bool type(int row, int column, const QVariant& value) {
    return table().model()->setData(cell(row, column), value, Qt::EditRole);
  }
  std::string text() { return toText(*findRow("fuzzy.rules"), draft_.value("fuzzy.rules")); }

  Draft draft_;
  RulesPanel panel_{draft_};
};

TEST_F(RulesPanelTest, typedWeightsAndOutputsAreOneUndoStepEach) {
  EXPECT_TRUE(type(1, RulesModel::kWeight, QStringLiteral("2.5")));
  EXPECT_TRUE(type(1, RulesModel::kOutput, QStringLiteral("0.75")));
  EXPECT_EQ(rulesOf(draft_).rule[1], (FuzzyRule{AltitudeCondition::low, PitchCondition::nose_up, 2.5, 0.75}));
  EXPECT_EQ(draft_.active()->scheme.rules, rulesOf(draft_));
  EXPECT_EQ(draft_.undoStack().count(), 2);
  draft_.undoStack().undo();
  draft_.undoStack().undo();
  EXPECT_EQ(rulesOf(draft_), kRuleBase);
}

TEST_F(RulesPanelTest, whatIsOutsideTheRangeIsRefusedWithTheReason) {
  for (const char* const bad : {"x", "nan", "-1", "1001", ""}) {
    EXPECT_FALSE(type(0, RulesModel::kWeight, QString::fromLatin1(bad))) << bad;
    EXPECT_NE(editor().note(), "") << bad;
  }
  EXPECT_FALSE(type(0, RulesModel::kOutput, QStringLiteral("2.1")));
  EXPECT_TRUE(editor().note().contains(QStringLiteral("0 to 2"))) << qPrintable(editor().note());
  EXPECT_EQ(rulesOf(draft_), kRuleBase);
  EXPECT_EQ(draft_.undoStack().count(), 0);
}

TEST_F(RulesPanelTest, aClickOnAConditionOffersThemInAComboBox) {
  const QRect at = table().visualRect(cell(2, RulesModel::kPitch));
  QTest::mouseClick(table().viewport(), Qt::LeftButton, Qt::NoModifier, at.center());
  auto* const box = table().viewport()->findChild<QComboBox*>();
  ASSERT_NE(box, nullptr);
  EXPECT_EQ(box->currentIndex(), 1) << "nose down";
  EXPECT_EQ(box->count(), 3);
  box->setCurrentIndex(0);
  emit box->activated(0);
  EXPECT_EQ(rulesOf(draft_).rule[2].pitch, PitchCondition::any);
  EXPECT_EQ(draft_.undoStack().count(), 1);
}

TEST_F(RulesPanelTest, rulesAreAddedCopiedRemovedAndMovedByTheKeyboardAlone) {
  table().setFocus();
  table().setCurrentIndex(cell(1, RulesModel::kWeight));
  const auto press = [&](Qt::Key key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QTest::keyClick(&table(), key, modifiers);
  };
  press(Qt::Key_D, Qt::ControlModifier);
  EXPECT_EQ(text(), "low&down*1=2 low&up*1=1 low&up*1=1 high&down*1=0.5 high&up*1=0");
  EXPECT_EQ(editor().selected(), 2);
  press(Qt::Key_Insert);
  EXPECT_EQ(text(), "low&down*1=2 low&up*1=1 low&up*1=1 any*1=0 high&down*1=0.5 high&up*1=0");
  press(Qt::Key_Up, Qt::AltModifier);
  press(Qt::Key_Up, Qt::AltModifier);
  press(Qt::Key_Up, Qt::AltModifier);
  press(Qt::Key_Up, Qt::AltModifier);
  EXPECT_EQ(text(), "any*1=0 low&down*1=2 low&up*1=1 low&up*1=1 high&down*1=0.5 high&up*1=0");
  EXPECT_EQ(editor().selected(), 0);
  press(Qt::Key_Down, Qt::AltModifier);
  EXPECT_EQ(text(), "low&down*1=2 any*1=0 low&up*1=1 low&up*1=1 high&down*1=0.5 high&up*1=0");
  press(Qt::Key_Delete);
  EXPECT_EQ(text(), "low&down*1=2 low&up*1=1 low&up*1=1 high&down*1=0.5 high&up*1=0");
  while (draft_.undoStack().canUndo()) draft_.undoStack().undo();
  EXPECT_EQ(rulesOf(draft_), kRuleBase);
}

TEST_F(RulesPanelTest, oneRuleStaysAndSixteenAreTheMost) {
  table().setCurrentIndex(cell(0, 0));
  for (int i = 0; i < 20; ++i) editor().addRule();
  EXPECT_EQ(rulesOf(draft_).size, RuleList::kCapacity);
  EXPECT_TRUE(editor().note().contains(QStringLiteral("16")));
  for (int i = 0; i < 20; ++i) editor().removeRule();
  EXPECT_EQ(rulesOf(draft_).size, 1u);
  EXPECT_EQ(editor().note(), QStringLiteral("One rule must stay."));
}

TEST_F(RulesPanelTest, aRuleBaseThatCountsForNothingIsShownAndTheLastValidOneRuns) {
  for (int row = 0; row < 4; ++row) type(row, RulesModel::kWeight, QStringLiteral("0"));
  EXPECT_TRUE(draft_.isBroken());
  EXPECT_TRUE(editor().note().contains(QStringLiteral("above 0"))) << qPrintable(editor().note());
  EXPECT_GT(draft_.active()->scheme.rules.rule[3].weight, 0);
}

TEST_F(RulesPanelTest, saysWhenTheTotalDoesNotComeFromTheRules) {
  EXPECT_NE(editor().note(), "");
  draft_.setValue("fuzzy.combination", ChoiceIndex{2});
  EXPECT_EQ(editor().note(), "");
}

TEST_F(RulesPanelTest, theViewerSaysWhatEachRuleDoesInTheLastFrame) {
  RuleViewer& viewer = panel_.viewer();
  EXPECT_EQ(viewer.lines().size(), 1) << "no frame yet";
  draft_.setText("fuzzy.rules", "low&down*2=1.5 high*1=0.5 any*0=1");
  LiveFrame frame;
  DecisionMemory memory;
  frame.decision = decide(test::inputAt(5000, -12), draft_.active(), memory);
  panel_.showFrame(frame);
  // Altitude 0.6 and pitch 0.7, by hand; (2 x 0.6 x 1.5 + 0.4 x 0.5) / (1.2 + 0.4) = 1.25.
  EXPECT_EQ(viewer.lines(),
            (QStringList{"Low, nose down: 0.600, 0.700, fires 0.600, counts 1.200, output 1.5",
                         "High: 0.400, any, fires 0.400, counts 0.400, output 0.5",
                         "Always: any, any, fires 1.000, counts 0.000, output 1", "Total 1.250"}));
  EXPECT_EQ(frame.decision.ruleFiring.count, 3u);
  draft_.setText("fuzzy.rules", "low*1=1.5 high&up*1=2");
  frame.decision = decide(test::inputAt(9000, -40), draft_.active(), memory);
  panel_.showFrame(frame);
  EXPECT_EQ(viewer.lines().last(), QStringLiteral("No rule fires: total 0"));
  EXPECT_EQ(viewer.grab().isNull(), false);
}

TEST_F(RulesPanelTest, theViewerCopesWithFramesOfOtherRulesAndOfNone) {
  LiveFrame frame;
  DecisionMemory memory;
  frame.decision = decide(test::inputAt(5000, 0), draft_.active(), memory);
  panel_.showFrame(frame);
  draft_.setText("fuzzy.rules", "low*1=1 low*1=1 low*1=1 low*1=1 low*1=1 low*1=1");
  EXPECT_EQ(panel_.viewer().lines().size(), 7) << "the frame's memberships, the rules of now";
  frame.decision = decide(test::inputAt(std::nan(""), 0), draft_.active(), memory);
  panel_.showFrame(frame);
  EXPECT_EQ(panel_.viewer().lines().size(), 1);
}

TEST_F(RulesPanelTest, filesAreWrittenAndTakenInOneStep) {
  const QTemporaryDir dir;
  draft_.setText("fuzzy.rules", "low&down*0.5=1.5 any*1=0.25");
  draft_.setText("fuzzy.altitude.curve_ft", "3000:1 9000:0");
  for (const char* const name : {"rules.fll", "rules.fis"}) {
    const QString file = dir.filePath(QString::fromLatin1(name));
    EXPECT_TRUE(panel_.exportFile(file).empty());
    const TuningParameters before = draft_.parameters();
    draft_.resetAll();
    const int steps = draft_.undoStack().count();
    EXPECT_TRUE(panel_.importFile(file).empty());
    EXPECT_EQ(draft_.undoStack().count(), steps + 1);
    EXPECT_EQ(rulesOf(draft_), before.scheme.rules);
    EXPECT_EQ(draft_.parameters().scheme.combination, Combination::rules);
    EXPECT_EQ(test::curveOf(draft_, "fuzzy.altitude.curve_ft"), before.altitude.curve);
  }
}

TEST_F(RulesPanelTest, aFileThatCannotBeReadLeavesEverythingAndSaysWhy) {
  const QTemporaryDir dir;
  const TuningParameters before = draft_.parameters();
  EXPECT_FALSE(panel_.importFile(dir.filePath(QStringLiteral("none.fll"))).empty());
  EXPECT_FALSE(panel_.importFile(QStringLiteral("x.txt")).empty());
  ASSERT_TRUE(writeAtomically(dir.filePath(QStringLiteral("bad.fll")).toStdString(), "Engine: x\nno\n"));
  const Findings findings = panel_.importFile(dir.filePath(QStringLiteral("bad.fll")));
  ASSERT_FALSE(findings.empty());
  EXPECT_TRUE(findings.front().where.ends_with("bad.fll:2"));
  EXPECT_TRUE(differences(before, draft_.parameters()).empty());
  EXPECT_EQ(draft_.undoStack().count(), 0);
}

TEST(ParameterTableLists, askForTheirOwnEditors) {
  Draft draft;
  ParameterTable parameters(draft);
  QSignalSpy asked(&parameters, &ParameterTable::editorAsked);
  for (const char* const key : {"fuzzy.rules", "fuzzy.bands_px", "fuzzy.pitch.curve_deg"}) {
    auto* const line = qobject_cast<QLineEdit*>(parameters.line(key)->editor());
    ASSERT_NE(line, nullptr) << key;
    auto* const button = line->parentWidget()->findChild<QToolButton*>();
    ASSERT_NE(button, nullptr) << key;
    button->click();
    EXPECT_EQ(asked.last().first().toString().toStdString(), key);
  }
  EXPECT_EQ(qobject_cast<QLineEdit*>(parameters.line("fuzzy.rules")->editor())->text(),
            QStringLiteral("low&down*1=2 low&up*1=1 high&down*1=0.5 high&up*1=0"));
}

}  // namespace
}  // namespace trimtab::views
