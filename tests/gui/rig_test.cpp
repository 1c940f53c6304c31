// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAccessible>
#include <QComboBox>
#include <QElapsedTimer>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QSet>
#include <QSettings>
#include <QStandardItemModel>
#include <QTableWidget>
#include <algorithm>
#include <fstream>

#include "app/workbench/controllers/flight_controller.h"
#include "app/workbench/controllers/ig_controller.h"
#include "app/workbench/docks/fit_page.h"
#include "app/workbench/window/session_keeper.h"
#include "policy_dock.h"
#include "tests/core/rig/profiles.h"
#include "trimtab/preset/policy_lines.h"
#include "trimtab/preset/preset.h"
#include "views/policy/lever_surface.h"
#include "views/policy/policy_rules_model.h"
#include "views/policy/rules_page.h"

namespace trimtab::test {
namespace {

void writeFile(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// A fit of `viewer` as its library would have written it after so many views.
IgFit fitOf(std::size_t views) {
  IgFit fit;
  fit.ig = "viewer";
  fit.views = views;
  fit.timeMs = 8;
  fit.loadLow = 4000, fit.loadHigh = 18000;
  fit.points = {{1, 4, {0.4, 0.38, 0.43, views}, {0.36, 0.35, 0.37, views}, 0.021, 2.25},
                {3, 20000, {0.9, 0.85, 0.97, views}, {0.8, 0.79, 0.81, views}}};
  fit.neutralPx = 0.75;
  return fit;
}

class WorkbenchRig : public PolicyDock {
 protected:
  void SetUp() override {
    PolicyDock::SetUp();
    if (HasFatalFailure()) return;
    QSettings().remove(QStringLiteral("fit/command"));
    writeFile(dir_ / "viewer.json", kViewer);
  }
  QString path(const std::string& name) const { return QString::fromStdString((dir_ / name).string()); }
  workbench::IgController& ig() { return *w().controllers().ig; }
  workbench::FitPage& page() { return *w().panels().fit; }
  QPushButton& button(const QString& begin) {
    for (QPushButton* each : page().findChildren<QPushButton*>())
      if (each->text().remove('&').startsWith(begin)) return *each;
    ADD_FAILURE() << "no button " << begin.toStdString();
    return *page().findChild<QPushButton*>();
  }
  QTableWidget& levers(const char* dock) {
    for (QTableWidget* table : w().dock(QString::fromLatin1(dock))->findChildren<QTableWidget*>())
      if (table->rowCount() == int(kFrameLeverRows.size())) return *table;
    ADD_FAILURE() << dock;
    return *w().findChild<QTableWidget*>();
  }
  static int rowOfLever(const std::string& key) {
    const auto at = std::ranges::find(kFrameLeverRows, key, &FrameLeverRow::key);
    return int(at - kFrameLeverRows.begin());
  }
  /// Writes an image generator that is a shell script: it leaves a fit as the library does, by steps, and
  /// says what it got. `end` is what it does then.
  void writeIg(const std::string& end) {
    writeFile(dir_ / "few.json", fitText(fitOf(7)));
    writeFile(dir_ / "enough.json", fitText(fitOf(24)));
    writeFile(dir_ / "ig.sh", "cd \"" + dir_.path().string() +
                                  "\"\n"
                                  "echo \"preset $1 flight $2 profile $TRIMTAB_PROFILE\"\n"
                                  "cp \"$1\" preset.json\n" +
                                  end);
    page().findChild<QLineEdit*>()->setText(QStringLiteral("sh \"%1\" {preset} {flight}").arg(path("ig.sh")));
  }
  static std::string leave(const std::string& fit) {
    return "cp " + fit + " half && mv half \"$TRIMTAB_FIT\"\n";
  }
  bool runs() {
    bool ended = false, good = false;
    QObject::connect(
        &page(), &workbench::FitPage::finished, &page(), [&](bool enough) { ended = true, good = enough; },
        Qt::SingleShotConnection);
    button("Fit to").click();
    EXPECT_TRUE(waitFor([&] { return ended || !page().running(); }));
    return waitFor([&] { return ended; }, 2000) && good;
  }
  QString output() { return page().findChild<QPlainTextEdit*>(QStringLiteral("output"))->toPlainText(); }

  /// Saves a screenshot of the window to look at, as large as the smallest screen, if TRIMTAB_SHOTS names a
  /// folder.
  void keepShot(const QString& name) {
    const QString folder = qEnvironmentVariable("TRIMTAB_SHOTS");
    if (folder.isEmpty()) return;
    for (const QSize size : {QSize(900, 700), QSize(1400, 900)}) {
      w().resize(size);
      QTest::qWait(1000);
      EXPECT_EQ(w().size(), size);
      onDisplay(w()).save(QStringLiteral("%1/%2-%3.png").arg(folder, name).arg(size.width()));
    }
  }

  ScratchDir dir_;
};

TEST_F(WorkbenchRig, greysWhatTheImageGeneratorLacksWhereverLeversAreListed) {
  ASSERT_NO_FATAL_FAILURE(setPolicy({"above_ground low = ramp 500 100"},
                                    {"if above_ground is low then lod_scale = 2, render_scale = 0.7"}));
  ASSERT_TRUE(settle());
  parts().signalsList->choose(Signal::above_ground);
  ASSERT_TRUE(ig().open(path("viewer.json"))) << w().messages().text().toStdString();
  const QStringList bars = parts().levers->lines();
  const auto says = [&](const char* label, const char* text) {
    return std::ranges::any_of(parts().levers->lines(), [&](const QString& line) {
      return line.startsWith(QLatin1String(label)) && line.contains(QLatin1String(text));
    });
  };
  EXPECT_TRUE(says("Render scale", "viewer does not have it")) << bars.join('\n').toStdString();
  EXPECT_FALSE(says("LOD scale", "does not have it"));
  EXPECT_FALSE(says("Allowed error –", "does not have it")) << "the LOD scale follows it";

  const int renderScale = rowOfLever("render_scale"), farDistance = rowOfLever("far_distance");
  for (const char* dock : {"decision", "budget"}) {
    QTableWidget& table = levers(dock);
    ASSERT_TRUE(waitFor([&] { return table.item(renderScale, 0)->toolTip().contains("does not have it"); }))
        << dock;
    EXPECT_TRUE(table.item(renderScale, 0)->data(Qt::ForegroundRole).isValid()) << "grey, " << dock;
    EXPECT_FALSE(table.item(farDistance, 0)->data(Qt::ForegroundRole).isValid());
    EXPECT_TRUE(table.item(farDistance, 0)->toolTip().contains("viewer: zFar = 80 km"))
        << table.item(farDistance, 0)->toolTip().toStdString();
  }

  const views::RulesPage& rules = *parts().rules;
  const QAbstractItemModel& model = *parts().rules->table().model();
  const QModelIndex settings = model.index(0, views::PolicyRulesModel::kSettings);
  EXPECT_TRUE(settings.data(Qt::ForegroundRole).isValid());
  EXPECT_TRUE(settings.data(Qt::ToolTipRole).toString().contains("viewer: LODScale, 1 to 8"))
      << settings.data(Qt::ToolTipRole).toString().toStdString();
  EXPECT_TRUE(settings.data(Qt::ToolTipRole).toString().contains("viewer does not have it"));
  EXPECT_GE(rules.selected(), -1);
  const auto& items = *qobject_cast<QStandardItemModel*>(parts().surface->findChild<QComboBox*>()->model());
  EXPECT_FALSE(items.item(int(Lever::render_scale))->isEnabled());
  EXPECT_TRUE(items.item(int(Lever::lod_scale))->isEnabled());

  parts().tabs->setCurrentIndex(2);
  workbench::raiseDock(*w().dock(QStringLiteral("decision")));
  keepShot("levers");
  trigger("None: this program's own");
  EXPECT_FALSE(settings.data(Qt::ForegroundRole).isValid());
  EXPECT_TRUE(items.item(int(Lever::render_scale))->isEnabled());
  EXPECT_FALSE(levers("decision").item(renderScale, 0)->data(Qt::ForegroundRole).isValid());
}

TEST_F(WorkbenchRig, offersNoLeverThatIsMissingToARule) {
  ASSERT_NO_FATAL_FAILURE(
      setPolicy({"above_ground low = ramp 500 100"}, {"if above_ground is low then lod_scale = 2"}));
  // It has neither an allowed error nor an LOD scale.
  std::string text = kViewer;
  text.replace(text.find("\"lod_scale\""), 11, "\"particle_density\"");
  writeFile(dir_ / "other.json", text);
  ASSERT_TRUE(ig().open(path("other.json"))) << w().messages().text().toStdString();
  parts().signalsList->choose(Signal::above_ground);
  parts().tabs->setCurrentWidget(parts().rules);
  parts().rules->addRule();
  ASSERT_EQ(parts().rules->table().model()->rowCount(), 2);
  const Result<Policy> policy = policyOf(w().draft().parameters().policy);
  ASSERT_TRUE(policy);
  EXPECT_EQ(policy->rules[1].settings.front().lever, Lever::far_distance) << "a lever that it has";

  ASSERT_NO_FATAL_FAILURE(activate());
  QTableView& table = parts().rules->table();
  table.setFocus();
  table.setCurrentIndex(table.model()->index(0, views::PolicyRulesModel::kSettings));
  table.edit(table.currentIndex());
  auto* const edit = table.viewport()->findChild<QLineEdit*>();
  ASSERT_NE(edit, nullptr);
  edit->clear();
  QTest::keyClicks(edit, "l");
  const auto offered = [&]() -> QAbstractItemView* {
    for (QAbstractItemView* list : edit->findChildren<QAbstractItemView*>())
      if (list->isVisible()) return list;
    return qobject_cast<QAbstractItemView*>(QApplication::activePopupWidget());
  };
  ASSERT_TRUE(waitFor([&] { return offered() != nullptr; }));
  QModelIndex first;
  for (int i = 0; i < offered()->model()->rowCount(); ++i)
    if (offered()->model()->index(i, 0).data().toString().startsWith("lod_scale"))
      first = offered()->model()->index(i, 0);
  EXPECT_EQ(first.data().toString(), QStringLiteral("lod_scale – viewer does not have it"));
  EXPECT_FALSE(first.flags() & Qt::ItemIsEnabled);
  QTest::keyClick(offered(), Qt::Key_Escape);
}

TEST_F(WorkbenchRig, limitsThePresetAndEveryExport) {
  ASSERT_TRUE(ig().open(path("viewer.json")));
  ASSERT_NO_FATAL_FAILURE(setPolicy({"above_ground low = ramp 500 100"},
                                    {"if above_ground is low then lod_scale = 2, render_scale = 0.7"}));
  const QString exported = path("export.json");
  ASSERT_TRUE(w().controllers().document->exportTo(exported, ExportFormat::json, {}, {}));
  EXPECT_TRUE(w().messages().text().contains("limited to viewer"));
  const auto rules = [](const TuningParameters& p) { return p.policy.rules.line.front(); };
  EXPECT_EQ(rules(loadPreset(exported.toStdString())->parameters),
            "if above_ground is low then lod_scale = 2");
  EXPECT_EQ(rules(w().draft().parameters()), "if above_ground is low then lod_scale = 2, render_scale = 0.7")
      << "what is edited stays";

  const int steps = w().draft().undoStack().count();
  trigger("Limit preset to the image generator");
  EXPECT_EQ(w().draft().undoStack().count(), steps + 1);
  EXPECT_EQ(rules(w().draft().parameters()), "if above_ground is low then lod_scale = 2");
  EXPECT_TRUE(w().messages().text().contains("policy.rules.1")) << w().messages().text().toStdString();
  EXPECT_TRUE(comesToFront("messages"));
  w().draft().undoStack().undo();
  EXPECT_EQ(rules(w().draft().parameters()), "if above_ground is low then lod_scale = 2, render_scale = 0.7");
}

TEST_F(WorkbenchRig, keepsTheProfileInTheSessionAndSaysItsName) {
  EXPECT_FALSE(command("Limit preset")->isEnabled());
  QLabel* const place = labelNamed(w(), "Image generator");
  ASSERT_NE(place, nullptr);
  EXPECT_FALSE(place->isVisible());
  ASSERT_TRUE(ig().open(path("viewer.json")));
  EXPECT_EQ(place->text(), "for viewer");
  EXPECT_TRUE(place->isVisible());
  EXPECT_LE(w().minimumSizeHint().width(), 900);
  EXPECT_LE(w().minimumSizeHint().height(), 700);
  ASSERT_TRUE(w().sessions().saveTo(path("day.session.json")));
  ig().takeAway();
  EXPECT_FALSE(place->isVisible());
  ASSERT_TRUE(w().sessions().open(path("day.session.json")));
  ASSERT_NE(w().draft().imageGenerator(), nullptr);
  EXPECT_EQ(w().draft().imageGenerator()->name, "viewer");
  writeFile(dir_ / "bad.json",
            "{\"format\": \"trimtab-ig-profile\", \"version\": 1, \"name\": \"x\",\n\"levers\": {\n"
            "\"lodscale\": {\"from\": 1, \"to\": 2, \"neutral\": 1}}}");
  EXPECT_FALSE(ig().open(path("bad.json")));
  EXPECT_TRUE(w().messages().text().contains("bad.json:3")) << w().messages().text().toStdString();
  EXPECT_TRUE(w().messages().text().contains("levers.lodscale"));
  EXPECT_EQ(w().draft().imageGenerator()->name, "viewer") << "the earlier one stays";
}

TEST_F(WorkbenchRig, fitsThePresetToAnImageGeneratorThatItRuns) {
  EXPECT_FALSE(button("Fit to").isEnabled()) << "it needs a profile";
  ASSERT_TRUE(ig().open(path("viewer.json")));
  ASSERT_TRUE(w().controllers().document->open(QStringLiteral("low-level")));
  writeIg(leave("few.json") + "while [ ! -e go ]; do sleep 0.05; done\n" + leave("enough.json"));
  button("Fit to").click();
  EXPECT_TRUE(labelSays(page(), "Ctrl+L opens one")) << "the command names a flight";
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  trigger("Fit to this image generator");
  EXPECT_TRUE(comesToFront(page()));
  bool ended = false, good = false;
  QObject::connect(
      &page(), &workbench::FitPage::finished, &page(), [&](bool enough) { ended = true, good = enough; },
      Qt::SingleShotConnection);
  button("Fit to").click();
  ASSERT_TRUE(waitFor([&] { return labelSays(page(), "7 of at least 20 views"); }));
  EXPECT_TRUE(w().viewport().paused()) << "the image generator has the machine for itself";
  writeFile(dir_ / "go", "");
  ASSERT_TRUE(waitFor([&] { return ended; }));
  EXPECT_TRUE(good) << w().messages().text().toStdString();
  EXPECT_TRUE(output().contains("profile " + path("viewer.json"))) << output().toStdString();
  EXPECT_TRUE(output().contains("flight " + QString::fromStdString(sampleFlight())));
  const auto given = loadPreset((dir_ / "preset.json").string());
  ASSERT_TRUE(given) << toString(given.findings());
  EXPECT_EQ(given->parameters.motion.blurStrength.value(), 0) << "it was limited";

  QTableWidget& table = *page().findChild<QTableWidget*>();
  ASSERT_EQ(table.rowCount(), 2);
  EXPECT_EQ(table.item(0, 0)->text(), "LODScale 4");
  EXPECT_EQ(table.item(0, 2)->text(), "0.4");
  EXPECT_EQ(table.item(0, 3)->text(), "0.38 to 0.43");
  EXPECT_EQ(table.item(1, 0)->text(), "zFar 20 km");
  const int steps = w().draft().undoStack().count();
  keepShot("fit");
  QTest::mouseClick(&button("Use fitted"), Qt::LeftButton);
  EXPECT_EQ(w().draft().undoStack().count(), steps + 1);
  EXPECT_EQ(w().draft().parameters().policy.terms.line.front(), "triangles many = ramp 4000 18000");
  EXPECT_TRUE(w().messages().text().contains("fitted to viewer"));
  w().draft().undoStack().undo();
  EXPECT_NE(w().draft().parameters().policy.terms.line.front(), "triangles many = ramp 4000 18000");
}

TEST_F(WorkbenchRig, saysWhyAFitFailed) {
  ASSERT_TRUE(ig().open(path("viewer.json")));
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  const auto fails = [&](const char* why) {
    EXPECT_FALSE(runs());
    EXPECT_TRUE(labelSays(page(), QString::fromLatin1(why))) << why;
    EXPECT_FALSE(button("Use fitted").isEnabled());
  };
  page().findChild<QLineEdit*>()->setText("/nowhere/viewer {preset}");
  fails("a program of this name");
  writeIg("echo 'no display' >&2; exit 3\n");
  fails("exit code 3: no display");
  writeIg("");
  fails("no file");
  writeIg(leave("few.json"));
  fails("at least 20 views");
  IgFit other = fitOf(24);
  other.ig = "another";
  writeIg(leave("another.json"));
  writeFile(dir_ / "another.json", fitText(other));
  fails("one of \"another\"");
  page().open(path("another.json"));
  EXPECT_FALSE(page().fit());
  page().open(path("enough.json"));
  ASSERT_TRUE(page().fit());
  EXPECT_TRUE(button("Use fitted").isEnabled());

  writeFile(dir_ / "viewer.json", std::string(kViewer).replace(std::string(kViewer).find("80"), 2, "90"));
  button("Fit to").click();
  EXPECT_TRUE(labelSays(page(), "another profile"));
}

TEST_F(WorkbenchRig, endsAnImageGeneratorThatIsCancelledAndKeepsWhatItHas) {
  ASSERT_TRUE(ig().open(path("viewer.json")));
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  for (const bool deaf : {false, true}) {
    writeIg(std::string(deaf ? "trap '' TERM\n" : "trap 'touch asked; exit 0' TERM\n") +
            leave("enough.json") + "while true; do sleep 0.1; done\n");
    bool ended = false, good = false;
    QObject::connect(
        &page(), &workbench::FitPage::finished, &page(), [&](bool enough) { ended = true, good = enough; },
        Qt::SingleShotConnection);
    button("Fit to").click();
    ASSERT_TRUE(waitFor([&] { return labelSays(page(), "24 views: enough"); }));
    QElapsedTimer since;
    since.start();
    button("Cancel").click();
    ASSERT_TRUE(waitFor([&] { return ended; }, 20000));
    EXPECT_TRUE(good);
    EXPECT_FALSE(page().running());
    ASSERT_TRUE(page().fit());
    EXPECT_EQ(page().fit()->views, 24u);
    if (deaf)
      EXPECT_GE(since.elapsed(), 2800) << "it has three seconds to end by itself";
    else
      EXPECT_TRUE(std::filesystem::exists(dir_ / "asked")) << "by SIGTERM";
  }
}

TEST_F(WorkbenchRig, isReachedByKeysAndHasNames) {
  ASSERT_TRUE(ig().open(path("viewer.json")));
  workbench::raiseDock(page());
  ASSERT_TRUE(comesToFront(page()));
  ASSERT_NO_FATAL_FAILURE(activate());
  trigger("Fit to this image generator");
  EXPECT_TRUE(waitFor([&] { return page().findChild<QLineEdit*>()->hasFocus(); }));
  QSet<QWidget*> reached;
  for (const bool back : {false, true}) {
    page().begin();
    for (int i = 0; i < 12; ++i) {
      QWidget* const focus = QApplication::focusWidget();
      ASSERT_NE(focus, nullptr);
      if (page().isAncestorOf(focus)) reached.insert(focus);
      QTest::keyClick(focus, back ? Qt::Key_Backtab : Qt::Key_Tab);
    }
  }
  for (const char* text : {"Profile", "Fit to", "Open a fit"})
    EXPECT_TRUE(reached.contains(&button(QString::fromLatin1(text)))) << text;
  for (QWidget* each : std::as_const(reached))
    EXPECT_FALSE(QAccessible::queryAccessibleInterface(each)->text(QAccessible::Name).isEmpty())
        << each->metaObject()->className();
}

}  // namespace
}  // namespace trimtab::test
