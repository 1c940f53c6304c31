// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/policy/policy_panel.h"

#include <QElapsedTimer>
#include <QLineEdit>
#include <QListWidget>
#include <QMenu>
#include <QMimeData>
#include <QPushButton>
#include <QTabWidget>
#include <QTableView>
#include <QTemporaryDir>
#include <QToolButton>
#include <cmath>

#include "policy_flight.h"
#include "tests/views/application.h"
#include "views/editors/membership_editor.h"
#include "views/plots/surface_plot.h"
#include "views/policy/findings_page.h"
#include "views/policy/lever_surface.h"
#include "views/policy/levers_view.h"
#include "views/policy/policy_rules_model.h"
#include "views/policy/rules_page.h"
#include "views/policy/scheme_page.h"
#include "views/policy/shares_view.h"
#include "views/policy/signals_list.h"
#include "views/policy/term_plot.h"

namespace trimtab::views {
namespace {

class PolicyPanelTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(panel_, {640, 760}); }
  void useSmallPolicy() {
    test::setSmallPolicy(draft_);
    draft_.undoStack().clear();
    parts().signalsList->choose(Signal::above_ground);
    QCoreApplication::processEvents();
  }
  const PolicyPanel::Parts& parts() { return panel_.parts(); }
  QTableView& rules() { return parts().rules->table(); }
  QModelIndex cell(int row, int column) { return rules().model()->index(row, column); }
  bool type(int row, int column, const char* text) {
    return rules().model()->setData(cell(row, column), QString::fromLatin1(text), Qt::EditRole);
  }
  std::vector<std::string> lines() { return draft_.parameters().policy.rules.line; }
  void press(QWidget& widget, Qt::Key key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QTest::keyClick(&widget, key, modifiers);
  }
  void show(const SignalValues& flight) { panel_.showFrame(flight_.at(flight, draft_.active())); }
  static SignalValues lowAndFast() {
    SignalValues flight;
    flight[Signal::above_ground] = 1250;
    flight[Signal::speed] = 500;
    return flight;
  }

  Draft draft_;
  PolicyPanel panel_{draft_};
  test::PolicyFlight flight_;
};

TEST_F(PolicyPanelTest, withoutAPolicyItSaysWhatOneIsAndStartsOne) {
  const auto button = [&](const char* text) -> QPushButton* {
    for (auto* each : panel_.findChildren<QPushButton*>())
      if (each->text() == QString::fromUtf8(text)) return each;
    return nullptr;
  };
  QPushButton* add = button("Add a term");
  ASSERT_NE(add, nullptr);
  EXPECT_TRUE(add->isVisible());
  EXPECT_FALSE(parts().tabs->isVisible());
  QMenu* menu = button("Start from…")->menu();
  emit menu->aboutToShow();
  std::size_t withPolicy = 0;
  for (const std::string_view name : shippedPresets())
    withPolicy += !loadPreset(std::string(name))->parameters.policy.terms.line.empty();
  ASSERT_FALSE(menu->actions().isEmpty());
  EXPECT_EQ(menu->actions().size(), qsizetype(std::max<std::size_t>(withPolicy, 1)));
  EXPECT_EQ(menu->actions().first()->isEnabled(), withPolicy > 0);
  add->click();
  EXPECT_FALSE(draft_.parameters().policy.terms.line.empty());
  EXPECT_TRUE(draft_.parameters().policy.enabled);
  EXPECT_FALSE(draft_.isBroken());
  EXPECT_TRUE(parts().tabs->isVisible());
  EXPECT_FALSE(add->isVisible());
  draft_.undoStack().undo();
  EXPECT_TRUE(add->isVisible());
  EXPECT_EQ(draft_.parameters().policy, PolicyParameters{});
}

TEST_F(PolicyPanelTest, theSchemeOfDocumentsAAndBIsTheFirstEntry) {
  EXPECT_TRUE(parts().scheme->isVisible());
  EXPECT_TRUE(parts().scheme->memberships().isVisible());
  parts().scheme->showSurface();
  EXPECT_TRUE(parts().scheme->surface().isVisible());
  useSmallPolicy();
  EXPECT_FALSE(parts().scheme->isVisible());
  panel_.showEditorOf("fuzzy.pitch.curve_deg");
  EXPECT_TRUE(parts().scheme->memberships().isVisible());
  panel_.showEditorOf("policy.rules");
  EXPECT_TRUE(rules().isVisible());
  panel_.showEditorOf("policy.terms");
  EXPECT_TRUE(parts().plot->isVisible());
}

TEST_F(PolicyPanelTest, rulesAreTypedCellByCellInOneStepEach) {
  useSmallPolicy();
  EXPECT_TRUE(type(0, PolicyRulesModel::kCondition, "above_ground is very low or not speed is fast"));
  EXPECT_TRUE(type(0, PolicyRulesModel::kSettings, "screen_space_error = 4, render_scale = 0.75"));
  EXPECT_TRUE(type(0, PolicyRulesModel::kWeight, "0.5"));
  EXPECT_TRUE(type(0, PolicyRulesModel::kReason, "speed hides detail"));
  EXPECT_EQ(
      lines()[0],
      "if above_ground is very low or not speed is fast then screen_space_error = 4, render_scale = 0.75 "
      "with 0.5 # speed hides detail");
  EXPECT_EQ(draft_.undoStack().count(), 4);
  EXPECT_EQ(draft_.active()->policy.rules.line, lines());
  EXPECT_TRUE(rules().model()->setData(cell(0, PolicyRulesModel::kOn), Qt::Unchecked, Qt::CheckStateRole));
  EXPECT_TRUE(lines()[0].starts_with("off if"));
  EXPECT_TRUE(type(1, PolicyRulesModel::kCondition, "if speed is fast then lod_scale = 2 with 0.25"));
  EXPECT_EQ(lines()[1], "if speed is fast then lod_scale = 2 with 0.25") << "a whole rule may be typed";
}

TEST_F(PolicyPanelTest, whatDoesNotHoldIsRefusedWithTheReason) {
  useSmallPolicy();
  struct Case {
    int column;
    const char *text, *reason;
  };
  for (const Case& c : {Case{PolicyRulesModel::kCondition, "above_ground is lwo", "low, high"},
                        {PolicyRulesModel::kCondition, "height is low", "a signal"},
                        {PolicyRulesModel::kCondition, "above_ground is low and", "a signal"},
                        {PolicyRulesModel::kCondition, "", "a signal"},
                        {PolicyRulesModel::kSettings, "screen_space_error = 900", "0.1 to 64"},
                        {PolicyRulesModel::kSettings, "detail = 4", "a lever"},
                        {PolicyRulesModel::kSettings, "lod_scale 4", "= after the lever"},
                        {PolicyRulesModel::kWeight, "2", "0 to 1"},
                        {PolicyRulesModel::kWeight, "much", "not a number"}}) {
    const QString why = static_cast<PolicyRulesModel*>(rules().model())
                            ->refusal(cell(0, c.column), QString::fromLatin1(c.text));
    EXPECT_TRUE(why.contains(QLatin1String(c.reason))) << c.text << ": " << why.toStdString();
    EXPECT_FALSE(type(0, c.column, c.text)) << c.text;
  }
  EXPECT_EQ(draft_.undoStack().count(), 0);
}

TEST_F(PolicyPanelTest, aRefusedRuleStaysInItsEditor) {
  useSmallPolicy();
  parts().tabs->setCurrentWidget(parts().rules);
  rules().setFocus();
  rules().setCurrentIndex(cell(0, PolicyRulesModel::kCondition));
  const auto edit = [&] { return rules().viewport()->findChild<QLineEdit*>(); };
  press(rules(), Qt::Key_F2);
  ASSERT_NE(edit(), nullptr);
  edit()->setText(QStringLiteral("above_ground is lwo"));
  QTest::keyClick(edit(), Qt::Key_Return);
  ASSERT_NE(edit(), nullptr);
  EXPECT_EQ(edit()->text(), QStringLiteral("above_ground is lwo"));
  EXPECT_TRUE(parts().rules->note().contains(QStringLiteral("low, high")))
      << parts().rules->note().toStdString();
  // Left with the mouse, the text is offered again.
  rules().setFocus();
  EXPECT_TRUE(test::eventually([&] { return edit() == nullptr; }));
  EXPECT_EQ(draft_.undoStack().count(), 0);
  press(rules(), Qt::Key_F2);
  ASSERT_NE(edit(), nullptr);
  EXPECT_EQ(edit()->text(), QStringLiteral("above_ground is lwo"));
  edit()->setText(QStringLiteral("above_ground is high"));
  QTest::keyClick(edit(), Qt::Key_Return);
  EXPECT_TRUE(test::eventually([&] { return lines()[0].starts_with("if above_ground is high then"); }));
  EXPECT_EQ(parts().rules->note(), QString());
}

TEST_F(PolicyPanelTest, rulesAreAddedCopiedMovedAndRemovedByTheKeyboardAlone) {
  useSmallPolicy();
  parts().tabs->setCurrentWidget(parts().rules);
  const std::vector<std::string> before = lines();
  rules().setFocus();
  rules().setCurrentIndex(cell(0, PolicyRulesModel::kCondition));
  press(rules(), Qt::Key_D, Qt::ControlModifier);
  EXPECT_EQ(lines(), (std::vector{before[0], before[0], before[1]}));
  press(rules(), Qt::Key_Down, Qt::AltModifier);
  EXPECT_EQ(lines(), (std::vector{before[0], before[1], before[0]}));
  EXPECT_EQ(parts().rules->selected(), 2);
  press(rules(), Qt::Key_Up, Qt::AltModifier);
  press(rules(), Qt::Key_Up, Qt::AltModifier);
  EXPECT_EQ(parts().rules->selected(), 0);
  press(rules(), Qt::Key_Delete);
  EXPECT_EQ(lines(), before);
  press(rules(), Qt::Key_Insert);
  ASSERT_EQ(lines().size(), 3u);
  EXPECT_EQ(lines()[1], "if above_ground is low then screen_space_error = 4");
  EXPECT_FALSE(draft_.isBroken());
  rules().setCurrentIndex(cell(1, PolicyRulesModel::kOn));
  press(rules(), Qt::Key_Space);
  EXPECT_TRUE(lines()[1].starts_with("off ")) << lines()[1];
  while (draft_.undoStack().canUndo()) draft_.undoStack().undo();
  EXPECT_EQ(lines(), before);
}

TEST_F(PolicyPanelTest, aDroppedRuleMovesThere) {
  useSmallPolicy();
  draft_.setValue("policy.rules",
                  TextLines{{"if speed is fast then lod_scale = 1", "if speed is fast then lod_scale = 2",
                             "if speed is fast then lod_scale = 3"}});
  const auto drop = [&](int from, int before) {
    const std::unique_ptr<QMimeData> data(rules().model()->mimeData({cell(from, 1)}));
    rules().model()->dropMimeData(data.get(), Qt::MoveAction, before, 0, {});
    std::string order;
    for (const std::string& line : lines()) order += line.back();
    return order;
  };
  EXPECT_EQ(drop(0, 3), "231");
  EXPECT_EQ(drop(2, 0), "123");
  EXPECT_EQ(drop(1, 1), "123") << "onto its own place";
  EXPECT_EQ(drop(0, 2), "213");
  EXPECT_EQ(parts().rules->selected(), 1);
}

TEST_F(PolicyPanelTest, aLineThatCannotBeReadIsShownAndMended) {
  useSmallPolicy();
  draft_.setValue("policy.rules", TextLines{{"if above_ground is low", lines()[1]}});
  EXPECT_TRUE(draft_.isBroken());
  EXPECT_EQ(draft_.active()->policy.rules.line.size(), 2u) << "the last valid policy keeps running";
  EXPECT_EQ(cell(0, PolicyRulesModel::kCondition).data().toString(),
            QStringLiteral("if above_ground is low"));
  EXPECT_NE(parts().rules->note(), QString());
  EXPECT_FALSE(type(0, PolicyRulesModel::kCondition, "above_ground is low"));
  EXPECT_TRUE(type(0, PolicyRulesModel::kCondition, "if above_ground is low then lod_scale = 1"));
  EXPECT_FALSE(draft_.isBroken());
}

TEST_F(PolicyPanelTest, leversAndSharesSayWhatTheRulesDo) {
  useSmallPolicy();
  show(lowAndFast());  // low by 0.75, high by 0.25: shares alike, as speed is fast
  parts().tabs->setCurrentIndex(2);
  const auto levers = [&] { return parts().levers->lines(); };
  EXPECT_TRUE(test::eventually([&] {
    return levers()[1].contains(QStringLiteral("rule 1 75 %, rule 2 25 %"));
  })) << levers().join('\n').toStdString();
  EXPECT_TRUE(levers()[1].startsWith(QStringLiteral("Allowed error 3.38 px"))) << levers()[1].toStdString();
  EXPECT_TRUE(levers()[3].contains(QStringLiteral("rule 2 100 %"))) << levers()[3].toStdString();
  EXPECT_TRUE(levers()[6].contains(QStringLiteral("no rule sets it"))) << levers()[6].toStdString();
  QAbstractItemModel& shares = *parts().shares->model();
  EXPECT_TRUE(test::eventually([&] {
    return shares.rowCount() == 2 && shares.index(0, 2).data().toString() == QStringLiteral("75 %");
  }));
  EXPECT_EQ(shares.index(0, 1).data().toString(), QStringLiteral("0.75"));
  EXPECT_EQ(shares.columnCount(), 4) << "only levers that the policy sets";
  EXPECT_EQ(shares.index(0, 3).data().toString(), QString()) << "rule 1 does not set the far distance";
  EXPECT_EQ(cell(0, PolicyRulesModel::kFires).data().toString(), QStringLiteral("0.75"));

  SignalValues slowAndLow = lowAndFast();
  slowAndLow[Signal::above_ground] = 500;
  slowAndLow[Signal::speed] = 100;
  show(slowAndLow);
  EXPECT_TRUE(
      test::eventually([&] { return levers()[1].contains(QStringLiteral("no rule fires: neutral")); }));
  draft_.setValue("policy.enabled", false);
  EXPECT_TRUE(test::eventually([&] { return levers()[1].contains(QStringLiteral("no policy")); }));
}

TEST_F(PolicyPanelTest, theSurfaceIsTheTargetOfTheRulesWithTheTrackOnIt) {
  useSmallPolicy();
  parts().tabs->setCurrentWidget(parts().surface);
  LeverSurface& surface = parts().surface->surface();
  for (int i = 0; i < 100; ++i) panel_.showFrame(flight_.next(draft_.active()));
  EXPECT_TRUE(test::eventually([&] { return surface.computed() > 0 && surface.trackPoints() > 25; }));
  EXPECT_EQ(surface.targetAt(2250, 300), 1.5);
  EXPECT_NEAR(surface.targetAt(1250, 450), 0.75 * 4 + 0.25 * 1.5, 1e-9);
  EXPECT_TRUE(std::isnan(surface.targetAt(800, 150))) << "no rule fires";
  QTest::qWait(300);
  const int computed = surface.computed();
  for (int i = 0; i < 20; ++i) panel_.showFrame(flight_.next(draft_.active()));
  QTest::qWait(300);
  EXPECT_EQ(surface.computed(), computed) << "the flight moves on the surface and does not change it";
  EXPECT_TRUE(type(1, PolicyRulesModel::kSettings, "screen_space_error = 2"));
  EXPECT_TRUE(test::eventually([&] { return surface.targetAt(2250, 300) == 2; }));
}

TEST_F(PolicyPanelTest, findingsLeadToTheirRuleOrTerm) {
  useSmallPolicy();
  draft_.setValue("policy.terms",
                  TextLines{{"above_ground low = ramp 2000 1000", "above_ground high = ramp 1000 2000",
                             "speed fast = ramp 200 400", "roll steep = ramp 30 60"}});
  EXPECT_TRUE(type(0, PolicyRulesModel::kCondition, "above_ground is low and above_ground is not any"));
  FindingsPage& page = *parts().findings;
  parts().tabs->setCurrentWidget(&page);
  const auto rowOf = [&](const char* text) {
    for (int i = 0; i < page.list().count(); ++i)
      if (page.list().item(i)->text().contains(QLatin1String(text))) return i;
    return -1;
  };
  EXPECT_TRUE(test::eventually([&] { return rowOf("Term roll is steep") >= 0; }));
  EXPECT_TRUE(parts().tabs->tabText(4).contains(QLatin1Char('('))) << parts().tabs->tabText(4).toStdString();
  const int never = rowOf("fires at most 0");
  ASSERT_GE(never, 0);
  page.list().setCurrentRow(never);
  emit page.list().itemActivated(page.list().item(never));
  EXPECT_EQ(parts().tabs->currentWidget(), parts().rules);
  EXPECT_EQ(parts().rules->selected(), 0);
  const int unused = rowOf("Term roll is steep");
  page.list().setCurrentRow(unused);
  emit page.list().itemActivated(page.list().item(unused));
  EXPECT_EQ(parts().plot->signal(), Signal::roll);
  EXPECT_EQ(parts().plot->term(), 3);

  page.list().setCurrentRow(1);
  const int before = page.list().count();
  EXPECT_TRUE(type(0, PolicyRulesModel::kCondition, "above_ground is low"));
  EXPECT_TRUE(test::eventually([&] { return page.list().count() != before; }));
  EXPECT_EQ(page.list().currentRow(), std::min(1, page.list().count() - 1)) << "a review keeps the place";
}

TEST_F(PolicyPanelTest, policiesComeFromFilesAndGoIntoThem) {
  useSmallPolicy();
  const QTemporaryDir dir;
  const QString file = dir.filePath(QStringLiteral("policy.fll"));
  ASSERT_TRUE(panel_.exportFile(file).empty());
  const PolicyParameters before = draft_.parameters().policy;
  draft_.resetAll();
  EXPECT_TRUE(panel_.policy().empty());
  EXPECT_TRUE(panel_.importFile(file)->empty());
  EXPECT_EQ(draft_.parameters().policy, before);
  EXPECT_FALSE(panel_.importFile(dir.filePath(QStringLiteral("policy.txt")))->empty());
  EXPECT_FALSE(panel_.importFile(dir.filePath(QStringLiteral("gone.fll")))->empty());
  EXPECT_FALSE(panel_.exportFile(dir.filePath(QStringLiteral("policy"))).empty());
  EXPECT_EQ(draft_.parameters().policy, before);
}

/// Counts what is painted in a widget and its children.
class PaintCounter : public QObject {
 public:
  explicit PaintCounter(QWidget& widget) {
    for (QWidget* each : widget.findChildren<QWidget*>()) each->installEventFilter(this);
  }
  int paints = 0;

 protected:
  bool eventFilter(QObject*, QEvent* event) override {
    paints += event->type() == QEvent::Paint;
    return false;
  }
};

TEST_F(PolicyPanelTest, nothingIsPaintedWhileTheFlightRests) {
  useSmallPolicy();
  const LiveFrame frame = flight_.at(lowAndFast(), draft_.active());
  const auto rest = [&](int frames) {
    for (int i = 0; i < frames; ++i) {
      panel_.showFrame(frame);
      QTest::qWait(20);
    }
  };
  for (int tab = 0; tab < parts().tabs->count(); ++tab) {
    parts().tabs->setCurrentIndex(tab);
    rest(40);
    PaintCounter counter(panel_);
    rest(20);
    EXPECT_EQ(counter.paints, 0) << "tab " << tab;
  }
}

TEST_F(PolicyPanelTest, fortyRulesFollowADrag) {
  test::setLargePolicy(draft_);
  ASSERT_FALSE(draft_.isBroken()) << toString(draft_.findings());
  EXPECT_EQ(rules().model()->rowCount(), 40);
  parts().signalsList->choose(Signal::altitude);
  parts().tabs->setCurrentWidget(parts().rules);
  for (int i = 0; i < 40; ++i) panel_.showFrame(flight_.next(draft_.active()));
  QCoreApplication::processEvents();
  TermPlot& plot = *parts().plot;
  plot.selectTerm(1);
  const QPointF from = plot.pixelOf(plot.points()[1].x, 1);
  QTest::mousePress(&plot, Qt::LeftButton, Qt::NoModifier, from.toPoint());
  QElapsedTimer timer;
  timer.start();
  constexpr int kSteps = 50;
  for (int i = 1; i <= kSteps; ++i) {
    QTest::mouseMove(&plot, (from + QPointF(i, 0)).toPoint());
    panel_.showFrame(flight_.next(draft_.active()));
    QCoreApplication::processEvents();
  }
  const double ms = static_cast<double>(timer.nsecsElapsed()) / 1e6 / kSteps;
  QTest::mouseRelease(&plot, Qt::LeftButton, Qt::NoModifier, (from + QPointF(kSteps, 0)).toPoint());
  std::printf("a step of a drag with 40 rules takes %.2f ms\n", ms);
  EXPECT_NE(draft_.parameters().policy.terms.line[1], "altitude medium = triangle 4000 9000 20000");
  EXPECT_EQ(draft_.active()->policy.terms.line, draft_.parameters().policy.terms.line);
}

}  // namespace
}  // namespace trimtab::views
