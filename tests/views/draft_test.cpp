// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/model/draft.h"

#include <QLocale>
#include <QSignalSpy>
#include <algorithm>

#include "application.h"
#include "trimtab/units/not_finite.h"
#include "views/model/keys.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

TEST(ViewKeys, areRowsOfTheTable) {
  for (const std::string_view key :
       {key::kAltitudeCurve, key::kAltitudeReading, key::kAltitudeReference, key::kPitchCurve,
        key::kPitchReading, key::kBands, key::kHysteresis, key::kCombination, key::kBudget,
        key::kPolicyEnabled, key::kPolicyNorm, key::kPolicyTerms, key::kPolicyRules})
    EXPECT_NE(findRow(key), nullptr) << key;
}

TEST(Draft, isValidCleanAndUnchangedAtTheStart) {
  const Draft draft;
  EXPECT_FALSE(draft.isBroken());
  EXPECT_FALSE(draft.isDirty());
  EXPECT_TRUE(draft.findings().empty());
  for (const ParameterRow& row : parameterRows()) EXPECT_FALSE(draft.isChanged(row.key)) << row.key;
}

TEST(Draft, namesTheUndoStepByTheRowsLabel) {
  Draft draft;
  ASSERT_TRUE(draft.setValue("fuzzy.hysteresis", 0.03).empty());
  EXPECT_EQ(draft.undoStack().undoText(), "Change Hysteresis");
  EXPECT_TRUE(draft.isDirty());
  draft.reset("fuzzy.hysteresis");
  EXPECT_EQ(draft.undoStack().undoText(), "Reset Hysteresis");
}

TEST(Draft, undoRestoresEveryKindBitForBit) {
  Draft draft;
  const double odd = 0.1 + 0.2;
  ASSERT_TRUE(draft.setValue("lod.scale", odd).empty());
  for (const ParameterRow& row : parameterRows()) {
    const ParameterValue before = draft.value(row.key);
    ParameterValue after = before;
    if (double* number = std::get_if<double>(&after)) *number = row.hard.low;
    if (bool* flag = std::get_if<bool>(&after)) *flag = !*flag;
    if (ChoiceIndex* choice = std::get_if<ChoiceIndex>(&after))
      choice->index = (choice->index + 1) % row.choices.size();
    if (CurvePoints* curve = std::get_if<CurvePoints>(&after)) curve->point[0].y = 1.0 / 3;
    if (BandList* bands = std::get_if<BandList>(&after)) bands->band[0].low = 1.0 / 9;
    if (before == after) continue;
    ASSERT_TRUE(draft.setValue(row.key, after).empty()) << row.key;
    EXPECT_EQ(draft.value(row.key), after) << row.key;
    draft.undoStack().undo();
    EXPECT_EQ(draft.value(row.key), before) << row.key;
    draft.undoStack().redo();
    EXPECT_EQ(draft.value(row.key), after) << row.key;
    draft.undoStack().undo();
  }
  EXPECT_EQ(std::get<double>(draft.value("lod.scale")), odd);
}

TEST(Draft, editsOfOneTokenAreOneStep) {
  Draft draft;
  const MergeToken token = draft.newToken();
  for (int i = 1; i <= 20; ++i) draft.setValue("lod.scale", 1 + i * 0.1, token);
  EXPECT_EQ(draft.undoStack().count(), 1);
  draft.setValue("lod.scale", 5.0, draft.newToken());
  EXPECT_EQ(draft.undoStack().count(), 2);
  draft.undoStack().undo();
  EXPECT_EQ(std::get<double>(draft.value("lod.scale")), 3.0);
  draft.undoStack().undo();
  EXPECT_EQ(std::get<double>(draft.value("lod.scale")), 1.0);
  draft.undoStack().redo();
  EXPECT_EQ(std::get<double>(draft.value("lod.scale")), 3.0) << "the last value of the drag, not its first";
}

TEST(Draft, aTokenThatReturnsToItsStartLeavesNoStep) {
  Draft draft;
  const MergeToken token = draft.newToken();
  draft.setValue("lod.scale", 2.0, token);
  draft.setValue("lod.scale", 1.0, token);
  EXPECT_EQ(draft.undoStack().count(), 0);
  EXPECT_FALSE(draft.isDirty());
}

TEST(Draft, settingTheSameValueIsNoStep) {
  Draft draft;
  draft.setValue("lod.scale", 1.0);
  EXPECT_EQ(draft.undoStack().count(), 0);
}

TEST(Draft, refusesWhatIsOutsideTheHardRange) {
  const struct {
    const char* key;
    double value;
  } refused[] = {{"fuzzy.hysteresis", -0.01}, {"fuzzy.hysteresis", 1.01}, {"fuzzy.hysteresis", kNan},
                 {"lod.scale", kInfinity},    {"lod.scale", -kInfinity},  {"view.width_px", 640.5}};
  Draft draft;
  for (const auto& [key, value] : refused) {
    const Findings findings = draft.setValue(key, value);
    ASSERT_EQ(findings.size(), 1u) << key << " " << value;
    EXPECT_EQ(findings[0].key, key);
    EXPECT_FALSE(findings[0].expected.empty());
  }
  EXPECT_EQ(draft.undoStack().count(), 0);
}

TEST(Draft, aBrokenRuleIsHeldWhileTheLastValidSetRuns) {
  Draft draft;
  QSignalSpy active(&draft, &Draft::activeChanged), findings(&draft, &Draft::findingsChanged);
  ASSERT_TRUE(draft.setValue("fuzzy.hysteresis", 0.3).empty());
  EXPECT_TRUE(draft.isBroken());
  EXPECT_EQ(draft.active()->scheme.hysteresis.value(), 0.05);
  EXPECT_EQ(draft.parameters().scheme.hysteresis.value(), 0.3);
  ASSERT_FALSE(draft.findingsOf("fuzzy.hysteresis").empty());
  EXPECT_EQ(draft.findingsOf("fuzzy.hysteresis").front().severity, Severity::error);
  EXPECT_EQ(active.count(), 0);
  EXPECT_EQ(findings.count(), 1);

  draft.undoStack().undo();
  EXPECT_FALSE(draft.isBroken());
  EXPECT_EQ(active.count(), 0) << "the same values run as before";
  draft.setValue("fuzzy.hysteresis", 0.02);
  EXPECT_EQ(active.count(), 1);
  EXPECT_EQ(draft.active()->scheme.hysteresis.value(), 0.02);
}

TEST(Draft, typedTextIsParsedByTheTableOrRefused) {
  Draft draft;
  EXPECT_TRUE(draft.setText("view.near_m", "10 ft").empty());
  EXPECT_DOUBLE_EQ(std::get<double>(draft.value("view.near_m")), 3.048);
  EXPECT_FALSE(draft.setText("view.near_m", "far").empty());
  EXPECT_FALSE(draft.setText("view.near_m", "10 deg").empty());
  EXPECT_DOUBLE_EQ(std::get<double>(draft.value("view.near_m")), 3.048);
}

TEST(Draft, resetAllIsOneStepBackToTheBase) {
  Draft draft;
  const Result<Preset> published = loadPreset("as-published");
  ASSERT_TRUE(published);
  Preset mine;
  mine.base = "as-published";
  mine.parameters = published->parameters;
  draft.load(mine);
  EXPECT_EQ(draft.value("fuzzy.hysteresis"), ParameterValue{0.0});
  EXPECT_FALSE(draft.isChanged("fuzzy.hysteresis"))
      << "the base, not the default, is what it is held against";
  draft.setValue("fuzzy.hysteresis", 0.04);
  draft.setValue("lod.scale", 4.0);
  draft.resetAll(Reference::base);
  EXPECT_EQ(draft.undoStack().count(), 3);
  EXPECT_EQ(draft.value("fuzzy.hysteresis"), ParameterValue{0.0});
  draft.undoStack().undo();
  EXPECT_EQ(draft.value("fuzzy.hysteresis"), ParameterValue{0.04});
  EXPECT_EQ(draft.value("lod.scale"), ParameterValue{4.0});
}

TEST(Draft, anUntouchedPresetDiffersFromNothingAndResetsToItself) {
  Draft draft;
  draft.load(*loadPreset("as-published"));
  EXPECT_TRUE(std::ranges::none_of(parameterRows(),
                                   [&](const ParameterRow& row) { return draft.isChanged(row.key); }));
  EXPECT_TRUE(draft.isChanged("fuzzy.hysteresis", Reference::base));
  EXPECT_TRUE(draft.isChanged("fuzzy.hysteresis", Reference::defaults));
  EXPECT_FALSE(draft.isChanged("fuzzy.hysteresis", Reference::pinned)) << "nothing is pinned";
  draft.resetAll();
  EXPECT_EQ(draft.undoStack().count(), 0);
  draft.setValue("fuzzy.hysteresis", 0.04);
  draft.reset("fuzzy.hysteresis");
  EXPECT_EQ(draft.value("fuzzy.hysteresis"), ParameterValue{0.0});
  draft.reset("fuzzy.hysteresis", Reference::defaults);
  EXPECT_EQ(draft.value("fuzzy.hysteresis"), ParameterValue{0.05});
}

TEST(Draft, savingMakesItsValuesThoseOfTheFile) {
  Draft draft;
  draft.setValue("lod.scale", 4.0);
  QSignalSpy references(&draft, &Draft::referencesChanged);
  draft.markSaved();
  EXPECT_EQ(references.count(), 1);
  EXPECT_FALSE(draft.isDirty());
  EXPECT_FALSE(draft.isChanged("lod.scale"));
  draft.undoStack().undo();
  EXPECT_TRUE(draft.isChanged("lod.scale")) << "the file has the later value";
}

TEST(Draft, aPinnedSnapshotIsAReferenceUntilItIsUnpinned) {
  Draft draft;
  TuningParameters kept = draft.parameters();
  draft.setValue("lod.scale", 4.0);
  draft.pin("snapshot A", kept);
  EXPECT_TRUE(draft.isChanged("lod.scale", Reference::pinned));
  EXPECT_EQ(draft.referenceName(Reference::pinned), "snapshot A");
  draft.resetAll(Reference::pinned);
  EXPECT_EQ(draft.undoStack().undoText(), "Reset All to snapshot A");
  EXPECT_EQ(draft.value("lod.scale"), ParameterValue{1.0});
  draft.unpin();
  EXPECT_EQ(draft.reference(Reference::pinned), nullptr);
}

TEST(Draft, aStepHasItsValuesBeforeAndAfterAndTheTimeOfItsLastEdit) {
  Draft draft;
  const QDateTime start = QDateTime::currentDateTime();
  const MergeToken token = draft.newToken();
  draft.setValue("lod.scale", 2.0, token);
  draft.setValue("lod.scale", 3.0, token);
  const Step step = draft.step(0);
  ASSERT_EQ(step.changes.size(), 1u);
  EXPECT_EQ(step.text, "Change LOD scale");
  EXPECT_EQ(step.changes[0].before, ParameterValue{1.0});
  EXPECT_EQ(step.changes[0].after, ParameterValue{3.0});
  EXPECT_GE(step.when, start);
}

TEST(Draft, loadingStartsACleanHistory) {
  Draft draft;
  draft.setValue("lod.scale", 4.0);
  QSignalSpy dirty(&draft, &Draft::dirtyChanged), loaded(&draft, &Draft::loaded);
  draft.load(Preset{});
  EXPECT_FALSE(draft.isDirty());
  EXPECT_EQ(draft.undoStack().count(), 0);
  EXPECT_EQ(loaded.count(), 1);
  EXPECT_EQ(dirty.count(), 1);
  EXPECT_EQ(draft.value("lod.scale"), ParameterValue{1.0});
}

TEST(Draft, isCleanAgainWhenUndoReturnsToWhatWasSaved) {
  Draft draft;
  draft.setValue("lod.scale", 4.0);
  draft.undoStack().setClean();
  draft.setValue("lod.scale", 5.0);
  EXPECT_TRUE(draft.isDirty());
  draft.undoStack().undo();
  EXPECT_FALSE(draft.isDirty());
}

TEST(NumberText, minusZeroIsZeroInEveryLocale) {
  const QLocale before;
  for (const QLocale::Language language : {QLocale::C, QLocale::Swedish}) {
    QLocale::setDefault(QLocale(language));
    EXPECT_EQ(numberText(-0.001, 2), "0") << language;
  }
  QLocale::setDefault(before);
}

}  // namespace
}  // namespace trimtab::views
