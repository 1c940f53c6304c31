// SPDX-License-Identifier: GPL-3.0-or-later
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>
#include <algorithm>

#include "app/workbench/controllers/flight_controller.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/search_page.h"
#include "app/workbench/viewport/split_view.h"
#include "app/workbench/window/workspaces.h"
#include "gui_support.h"
#include "tests/child.h"
#include "trimtab/preset/preset.h"

namespace trimtab::test {
namespace {

class SearchPage : public Bench {
 protected:
  workbench::SearchPage& page() { return *w().panels().search; }
  QPushButton& button(const QString& text) {
    for (QPushButton* button : page().findChildren<QPushButton*>())
      if (button->text() == text) return *button;
    ADD_FAILURE() << text.toStdString();
    return *page().findChild<QPushButton*>();
  }
  /// Shows the page, for a screenshot to look at if TRIMTAB_SHOTS names a folder.
  void shoot(const QString& name) {
    w().workspaces().show(workbench::Workspaces::kMeasure);
    workbench::raiseDock(page());
    if (const QString folder = qEnvironmentVariable("TRIMTAB_SHOTS"); !folder.isEmpty()) {
      waitFor([] { return false; }, 500);
      onDisplay(w()).save(folder + QLatin1Char('/') + name);
    }
  }
  /// The programs that search.
  std::vector<pid_t> searching() {
    std::vector<pid_t> found;
    for (const pid_t pid : processesWith({"trimtab-cli", "tune"}))
      if (parentOf(pid) == ::getpid()) found.push_back(pid);
    return found;
  }
  /// Starts a small search without a limit.
  void run() {
    for (QLineEdit* line : page().findChildren<QLineEdit*>())
      if (line->text() == QStringLiteral("1280x720")) line->setText(QStringLiteral("96x64"));
    page().findChild<QDoubleSpinBox*>()->setValue(0);
    for (QSpinBox* number : page().findChildren<QSpinBox*>())
      number->setValue(number->maximum() > 100000 ? 400 : 3);
    ended_ = good_ = false;
    QObject::connect(
        &page(), &workbench::SearchPage::finished, &page(),
        [this](bool good) { ended_ = true, good_ = good; }, Qt::SingleShotConnection);
    page().run();
  }
  bool ends() {
    EXPECT_TRUE(waitFor([this] { return ended_; }, 180000));
    return good_;
  }

 private:
  bool ended_ = false, good_ = false;
};

TEST_F(SearchPage, findsPresetsAlongTheFlightAndFliesTheOneThatIsChosen) {
  page().run();
  EXPECT_FALSE(page().running());
  EXPECT_TRUE(labelSays(page(), "Ctrl+L opens one")) << "it needs a flight";
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  for (QComboBox* choice : page().findChildren<QComboBox*>())
    choice->setCurrentText(QStringLiteral("Geometric, px"));
  run();
  ASSERT_TRUE(ends()) << w().messages().text().toStdString();
  ASSERT_TRUE(page().report());
  EXPECT_TRUE(labelSays(page(), "No limit was asked for"));
  EXPECT_EQ(page().report()->plots.front().yLabel, "largest geometric error");
  QTableWidget& table = *page().findChild<QTableWidget*>();
  ASSERT_GT(table.rowCount(), 1);
  // The first row is the preset that the search began from: there is nothing to use.
  table.selectRow(0);
  EXPECT_FALSE(button(QStringLiteral("&Use preset")).isEnabled());
  table.selectRow(table.rowCount() - 1);
  ASSERT_TRUE(button(QStringLiteral("&Use preset")).isEnabled());
  const TuningParameters before = w().draft().parameters();
  shoot(QStringLiteral("search.png"));
  button(QStringLiteral("&Use preset")).click();
  EXPECT_FALSE(differences(before, w().draft().parameters()).empty()) << "it is flown";
  w().draft().undoStack().undo();
  EXPECT_TRUE(differences(before, w().draft().parameters()).empty()) << "and taken back";

  const ScratchDir dir;
  const QString file = QString::fromStdString((dir / "mine.json").string());
  page().save(file);
  button(QStringLiteral("&Use preset")).click();
  EXPECT_TRUE(
      differences(loadPreset(file.toStdString()).value().parameters, w().draft().parameters()).empty());
  page().save(QString::fromStdString((dir / "no" / "mine.json").string()));
  EXPECT_TRUE(w().messages().text().contains(QStringLiteral("/no/mine.json")));

  button(QStringLiteral("Co&mpare")).click();
  workbench::SplitView& split = w().controllers().errors->splitView();
  EXPECT_TRUE(split.overViewport());
  EXPECT_TRUE(waitFor([&] { return split.upToDate(); }, 180000)) << split.status().text().toStdString();
  const QList<QComboBox*> choices = split.findChildren<QComboBox*>();
  EXPECT_TRUE(std::any_of(choices.begin(), choices.end(), [](const QComboBox* box) {
    return box->currentText().startsWith(QStringLiteral("tuned-"));
  }));
  if (const QString folder = qEnvironmentVariable("TRIMTAB_SHOTS"); !folder.isEmpty())
    onDisplay(w()).save(folder + QStringLiteral("/search-compare.png"));
}

TEST_F(SearchPage, pausesAndGoesOnAndLeavesTheMachineToTheViewMeanwhile) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  run();
  EXPECT_TRUE(waitFor([&] { return labelSays(page(), "drawing samples"); }));
  EXPECT_TRUE(w().viewport().paused());
  ASSERT_EQ(searching().size(), 1u);
  const pid_t search = searching().front();
  button(QStringLiteral("&Pause")).click();
  EXPECT_TRUE(waitFor([&] { return labelSays(page(), "Paused"); }));
  EXPECT_TRUE(isStopped(search));
  EXPECT_FALSE(w().viewport().paused()) << "the machine is free";
  shoot(QStringLiteral("search-paused.png"));
  button(QStringLiteral("Go &on")).click();
  EXPECT_FALSE(isStopped(search));
  EXPECT_TRUE(w().viewport().paused());
  EXPECT_TRUE(ends()) << w().messages().text().toStdString();
  EXPECT_FALSE(button(QStringLiteral("&Pause")).isVisible());
}

TEST_F(SearchPage, isCancelledOrClosedWhilePausedAndLeavesNoProgramBehind) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  for (const bool closed : {false, true}) {
    run();
    EXPECT_TRUE(waitFor([&] { return labelSays(page(), "drawing samples"); }));
    ASSERT_EQ(searching().size(), 1u);
    button(QStringLiteral("&Pause")).click();
    ASSERT_TRUE(waitFor([&] { return labelSays(page(), "Paused"); }));
    if (closed) {
      w().draft().undoStack().setClean();
      window.reset();
    } else {
      page().cancel();
      EXPECT_FALSE(ends());
      EXPECT_TRUE(labelSays(page(), "goes on from what is there"));
    }
    EXPECT_TRUE(searching().empty());
  }
}

TEST_F(SearchPage, saysWhatIsWrongAndKeepsNothingRunningWhenCancelled) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  run();
  // From here on the folder holds its plan.
  EXPECT_TRUE(waitFor([&] { return labelSays(page(), "drawing samples"); }));
  page().cancel();
  EXPECT_FALSE(ends());
  EXPECT_FALSE(page().running());
  const auto free = [&](const QString& keys) {
    for (QLineEdit* line : page().findChildren<QLineEdit*>())
      if (line->text().startsWith(QStringLiteral("lod."))) line->setText(keys);
    run();
    return ends();
  };
  EXPECT_FALSE(free(QStringLiteral("lod.sclae")));
  EXPECT_TRUE(w().messages().text().contains(QStringLiteral("lod.sclae")));
  EXPECT_TRUE(free(QStringLiteral("lod.scale"))) << "another plan than that of the folder that was cancelled";
}

}  // namespace
}  // namespace trimtab::test
