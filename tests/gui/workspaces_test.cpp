// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAbstractButton>
#include <QAction>
#include <QComboBox>
#include <QDockWidget>
#include <QHeaderView>
#include <QLabel>
#include <QScrollArea>
#include <QScrollBar>
#include <QStyleOptionComboBox>
#include <QTabBar>
#include <QTabWidget>
#include <QTextDocument>
#include <algorithm>

#include "app/workbench/docks/dock_of.h"
#include "app/workbench/window/workspaces.h"
#include "gui_support.h"
#include "tests/views/policy/policy_flight.h"
#include "views/panels/plots_panel.h"
#include "views/plots/time_plot.h"
#include "views/policy/policy_panel.h"
#include "views/policy/signals_list.h"

namespace trimtab::test {
namespace {

QString plainText(const QLabel& label) {
  if (!Qt::mightBeRichText(label.text())) return QString(label.text()).remove('&');
  QTextDocument document;
  document.setHtml(label.text());
  return document.toPlainText();
}

/// Words in sight that their own widget cuts off.
QStringList cutWords(const QWidget& window) {
  QStringList cut;
  const auto seen = [](const QWidget* each) { return each->isVisible() && !each->visibleRegion().isEmpty(); };
  for (const QLabel* label : window.findChildren<QLabel*>()) {
    if (!seen(label) || label->text().isEmpty()) continue;
    int widest = 0;
    const QStringList parts =
        plainText(*label).split(label->wordWrap() ? QLatin1Char(' ') : QLatin1Char('\n'));
    for (const QString& part : parts) widest = std::max(widest, label->fontMetrics().horizontalAdvance(part));
    if (widest > label->contentsRect().width() + 1) cut << "label: " + label->text();
  }
  for (const QAbstractButton* button : window.findChildren<QAbstractButton*>()) {
    if (!seen(button) || button->text().isEmpty()) continue;
    const int wanted = button->fontMetrics().horizontalAdvance(QString(button->text()).remove('&'));
    if (wanted > button->width()) cut << "button: " + button->text();
  }
  for (const QTabBar* bar : window.findChildren<QTabBar*>()) {
    if (!seen(bar) || bar->count() == 0) continue;
    int whole = 0;
    for (int i = 0; i < bar->count(); ++i) whole += bar->tabRect(i).width();
    if (whole > bar->width())
      cut << QString("tabs from %1 on: %2 of %3 px").arg(bar->tabText(0)).arg(bar->width()).arg(whole);
  }
  for (const QHeaderView* header : window.findChildren<QHeaderView*>()) {
    if (!seen(header) || header->orientation() != Qt::Horizontal || header->model() == nullptr) continue;
    for (int i = 0; i < header->count(); ++i) {
      const QString text = header->model()->headerData(i, Qt::Horizontal).toString();
      if (!header->isSectionHidden(i) &&
          header->fontMetrics().horizontalAdvance(text) > header->sectionSize(i))
        cut << "heading: " + text;
    }
  }
  for (const QComboBox* box : window.findChildren<QComboBox*>()) {
    if (!seen(box)) continue;
    QStyleOptionComboBox option;
    option.initFrom(box);
    const int room =
        box->style()->subControlRect(QStyle::CC_ComboBox, &option, QStyle::SC_ComboBoxEditField, box).width();
    if (box->fontMetrics().horizontalAdvance(box->currentText()) > room)
      cut << "choice: " + box->currentText();
  }
  return cut;
}

/// What scrolls up and down within a place that does so as well.
QStringList nestedScrolls(const QWidget& window) {
  QStringList nested;
  const auto scrolls = [](const QAbstractScrollArea* each) {
    return each != nullptr && !each->visibleRegion().isEmpty() && each->verticalScrollBar()->maximum() > 0;
  };
  for (const auto* area : window.findChildren<QAbstractScrollArea*>())
    for (const QWidget* holder = area->parentWidget(); holder != nullptr && scrolls(area);
         holder = holder->parentWidget())
      if (scrolls(qobject_cast<const QAbstractScrollArea*>(holder)))
        nested << area->accessibleName() + " in " + holder->accessibleName();
  return nested;
}

class WorkbenchWorkspaces : public Bench {
 protected:
  workbench::Workspaces& spaces() { return w().workspaces(); }
  bool front(const char* name) { return workbench::isInFront(*w().dock(name)); }
  void press(Qt::Key key) { QTest::keyClick(&w(), key, Qt::ControlModifier); }
  void SetUp() override {
    Bench::SetUp();
    if (HasFatalFailure()) return;
    w().resize(1280, 720);
    ASSERT_NO_FATAL_FAILURE(activate());
    for (int i = 0; i < 5; ++i) {
      spaces().show(i);
      spaces().reset();
    }
  }
};

TEST_F(WorkbenchWorkspaces, twelveDocksEachAnswerOneQuestion) {
  QStringList names;
  for (const QDockWidget* dock : w().findChildren<QDockWidget*>(QString(), Qt::FindDirectChildrenOnly)) {
    names << dock->objectName();
    EXPECT_EQ(dock->toolTip().count('?'), 1) << dock->windowTitle().toStdString();
  }
  names.sort();
  EXPECT_EQ(names.join(' ').toStdString(),
            "budget culling decision errors flight host messages plots policy preset terrain weather");
}

TEST_F(WorkbenchWorkspaces, ctrlAndANumberShowWhatEachJobNeedsWithoutACutWordAndLeaveHalfToTheImage) {
  const std::vector<std::vector<const char*>> needed = {{"decision", "flight"},
                                                        {"policy", "budget"},
                                                        {"errors", "flight"},
                                                        {"terrain", "messages"},
                                                        {"host", "flight"}};
  const QString shots = qEnvironmentVariable("TRIMTAB_SHOTS");
  for (const QSize size : {QSize(1280, 720), QSize(1920, 1080)}) {
    w().resize(size);
    for (int i = 0; i < 5; ++i) {
      press(Qt::Key(Qt::Key_1 + i));
      spaces().reset();
      EXPECT_EQ(spaces().current(), i);
      const std::string name = spaces().names()[i].toStdString();
      for (const char* dock : needed[std::size_t(i)])
        EXPECT_TRUE(comesToFront(dock)) << dock << " in " << name;
      EXPECT_TRUE(waitFor([&] { return cutWords(w()).isEmpty(); }, 5000))
          << name << " at " << size.width() << '\n'
          << cutWords(w()).join("\n").toStdString();
      EXPECT_EQ(w().size(), size) << "nothing widens the window";
      EXPECT_TRUE(nestedScrolls(w()).isEmpty()) << nestedScrolls(w()).join("\n").toStdString();
      const QSize image = w().viewport().size();
      EXPECT_GE(2 * image.width() * image.height(), size.width() * size.height())
          << name << ": " << image.width() << " x " << image.height();
      if (!shots.isEmpty()) w().grab().save(QString("%1/%2-%3.png").arg(shots).arg(size.width()).arg(i + 1));
    }
  }
}

TEST_F(WorkbenchWorkspaces, aLayoutOfAnEarlierVersionOpensWithoutTheDocksThatAreGone) {
  const ScratchDir dir;
  auto* const gone = new QDockWidget("Depth map", &w());
  gone->setObjectName("depth_map");
  w().addDockWidget(Qt::RightDockWidgetArea, gone);
  w().dock("weather")->hide();
  w().dock("host")->show();
  const QByteArray state = w().saveState(5).toBase64();
  delete gone;
  press(Qt::Key_1);
  const QString file = QString::fromStdString((dir / "old.workspace.json").string());
  writeFile(dir / "old.workspace.json",
            "{\"trimtab_workspace\": 5, \"name\": \"Old\", \"docks\": \"" + state.toStdString() + "\"}");
  const int messages = w().messages().count();
  w().openAny(file);
  EXPECT_EQ(w().messages().count(), messages) << w().messages().text().toStdString();
  EXPECT_EQ(spaces().names().last(), "Old");
  EXPECT_FALSE(w().dock("host")->isHidden());
  EXPECT_TRUE(w().dock("weather")->isHidden());
  EXPECT_EQ(w().dock("depth_map"), nullptr);
  spaces().remove(spaces().current());
}

TEST_F(WorkbenchWorkspaces, aWorkspaceKeepsHowItWasLeftUntilItIsReset) {
  press(Qt::Key_2);
  w().dock("budget")->close();
  press(Qt::Key_1);
  EXPECT_TRUE(waitFor([&] { return !front("policy"); }));
  press(Qt::Key_2);
  EXPECT_TRUE(comesToFront("policy"));
  EXPECT_TRUE(w().dock("budget")->isHidden());
  ASSERT_NO_FATAL_FAILURE(restart());
  EXPECT_EQ(spaces().current(), 1) << "over a restart too";
  EXPECT_TRUE(w().dock("budget")->isHidden());
  spaces().reset();
  EXPECT_TRUE(comesToFront("budget"));
}

TEST_F(WorkbenchWorkspaces, policyDoesNotScrollSidewaysBesideTheDetailsOfPlots) {
  w().resize(1280, 720);
  press(Qt::Key_2);
  spaces().reset();
  test::setLargePolicy(w().draft());
  views::PolicyPanel& panel = *w().panels().policy;
  panel.parts().signalsList->choose(Signal::speed);
  workbench::raiseDock(*w().panels().plots);
  for (QAction* action : w().panels().plots->actions())
    if (action->text() == "Details") action->setChecked(true);
  workbench::raiseDock(panel);
  ASSERT_TRUE(comesToFront(panel) && comesToFront("plots"));
  QTabWidget& pages = *panel.parts().tabs;
  ASSERT_TRUE(waitFor([&] { return pages.isVisible(); }));
  for (int page = 0; page < pages.count(); ++page) {
    pages.setCurrentIndex(page);
    QTest::qWait(50);
    const auto* const area = qobject_cast<const QScrollArea*>(panel.parentWidget()->parentWidget());
    ASSERT_NE(area, nullptr);
    EXPECT_EQ(area->horizontalScrollBar()->maximum(), 0) << pages.tabText(page).toStdString();
    EXPECT_GE(pages.currentWidget()->visibleRegion().boundingRect().height(),
              6 * panel.fontMetrics().height())
        << pages.tabText(page).toStdString();
    EXPECT_TRUE(nestedScrolls(w()).isEmpty()) << nestedScrolls(w()).join("\n").toStdString();
    const QString shots = qEnvironmentVariable("TRIMTAB_SHOTS");
    if (!shots.isEmpty()) w().grab().save(QString("%1/policy-%2.png").arg(shots).arg(page));
  }
}

TEST_F(WorkbenchWorkspaces, docksKeepTheirShareOfAWindowThatBecomesSmallAndLargeAgain) {
  const auto policyIs = [&](int widthPx) {
    return waitFor([&] { return std::abs(w().dock("policy")->width() - widthPx) <= 4; }, 5000);
  };
  w().resize(1600, 960);
  press(Qt::Key_2);
  spaces().reset();
  const int whole = 616;  // 0.385 of the window
  EXPECT_TRUE(policyIs(whole)) << w().dock("policy")->width();
  w().resize(1100, 640);
  EXPECT_TRUE(policyIs(whole * 1100 / 1600)) << w().dock("policy")->width();
  w().resize(1600, 960);
  EXPECT_TRUE(policyIs(whole)) << w().dock("policy")->width();
  // So does a workspace that was left in a window of another size.
  w().resize(1280, 768);
  EXPECT_TRUE(policyIs(whole * 1280 / 1600)) << w().dock("policy")->width();
  press(Qt::Key_1);
  w().resize(1600, 960);
  press(Qt::Key_2);
  EXPECT_TRUE(policyIs(whole)) << w().dock("policy")->width();
  // What a person has dragged is kept as well.
  const QPoint handle = w().dock("policy")->geometry().topLeft() + QPoint(-2, 100);
  QTest::mousePress(&w(), Qt::LeftButton, {}, handle);
  for (int x = 20; x <= 100; x += 20) {
    QTest::mouseMove(&w(), handle + QPoint(x, 0));
    QTest::qWait(20);
  }
  QTest::mouseRelease(&w(), Qt::LeftButton, {}, handle + QPoint(100, 0));
  EXPECT_TRUE(policyIs(whole - 100)) << w().dock("policy")->width();
  w().resize(1300, 800);
  EXPECT_TRUE(policyIs((whole - 100) * 1300 / 1600)) << w().dock("policy")->width();
  w().resize(1600, 960);
  EXPECT_TRUE(policyIs(whole - 100)) << w().dock("policy")->width();
}

TEST_F(WorkbenchWorkspaces, aDockThatIsAskedForAppearsWhereItIsAtHome) {
  press(Qt::Key_1);
  ASSERT_TRUE(w().dock("messages")->isHidden());
  w().messages().add("Something failed", {{Severity::error, "here", "", "this", "that"}});
  EXPECT_TRUE(comesToFront("messages")) << "an error is never out of sight";
  EXPECT_FALSE(w().tabifiedDockWidgets(w().dock("messages")).isEmpty());
}

TEST_F(WorkbenchWorkspaces, ownWorkspacesAreSavedRemovedAndSharedAsFiles) {
  const ScratchDir dir;
  press(Qt::Key_4);
  w().dock("host")->show();
  EXPECT_FALSE(spaces().saveAs("Tune").empty()) << "a name that ships";
  ASSERT_TRUE(spaces().saveAs("Night").empty());
  EXPECT_EQ(spaces().current(), 5);
  w().dock("host")->close();
  spaces().reset();
  EXPECT_FALSE(w().dock("host")->isHidden()) << "as it was saved";
  const QString file = QString::fromStdString((dir / "night.workspace.json").string());
  EXPECT_TRUE(spaces().writeTo(file).empty());
  spaces().remove(5);
  EXPECT_EQ(spaces().names().size(), 5);
  EXPECT_EQ(spaces().current(), 0);
  w().openAny(file);
  EXPECT_EQ(spaces().names().last(), "Night");
  EXPECT_FALSE(w().dock("host")->isHidden());
  spaces().remove(5);
}

TEST_F(WorkbenchWorkspaces, eachKeepsItsPlots) {
  views::TimePlot& plot = w().panels().plots->plot();
  press(Qt::Key_2);
  const auto usual = plot.lanes();
  plot.setLanes({{{views::Trace::triangles}}});
  press(Qt::Key_1);
  plot.setLanes(usual);
  press(Qt::Key_2);
  ASSERT_EQ(plot.lanes().size(), 1u);
  EXPECT_EQ(plot.lanes().front().traces, std::vector{views::Trace::triangles});
  ASSERT_NO_FATAL_FAILURE(restart());
  EXPECT_EQ(w().panels().plots->plot().lanes().size(), 1u) << "over restarts too";
  spaces().show(0);
  EXPECT_EQ(w().panels().plots->plot().lanes().size(), usual.size());
}

TEST_F(WorkbenchWorkspaces, aFileThatIsNoneIsRefusedAndChangesNothing) {
  const ScratchDir dir;
  press(Qt::Key_3);
  for (const char* text : {"", "{}", "[1, 2]", "{\"trimtab_workspace\": 5, \"docks\": \"AAAA\"}",
                           "{\"trimtab_workspace\": 4000, \"docks\": \"AAAA\"}"}) {
    const QString file = QString::fromStdString((dir / "bad.workspace.json").string());
    writeFile(dir / "bad.workspace.json", text);
    EXPECT_FALSE(spaces().readFrom(file).empty()) << text;
    EXPECT_EQ(spaces().names().size(), 5) << text;
    EXPECT_TRUE(comesToFront("errors")) << text;
  }
}

}  // namespace
}  // namespace trimtab::test
