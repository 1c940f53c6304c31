// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAccessible>
#include <QCommandLinkButton>
#include <QDockWidget>
#include <QLabel>
#include <QPushButton>
#include <QSignalSpy>
#include <QSlider>
#include <QTabBar>
#include <QWindow>
#include <algorithm>

#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/error_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/window/notice_bar.h"
#include "app/workbench/window/palette_entries.h"
#include "app/workbench/window/welcome.h"
#include "app/workbench/window/workspaces.h"
#include "gui_support.h"
#include "views/controls/parameter_line.h"
#include "views/controls/parameter_table.h"
#include "views/insets/depth_map_inset.h"
#include "views/panels/culling_panel.h"

namespace trimtab::test {
namespace {

class WorkbenchLayout : public Bench {
 protected:
  QPushButton* button(const QWidget& within, const QString& text) {
    for (QPushButton* each : within.findChildren<QPushButton*>())
      if (each->text().remove('&').contains(text) && each->isVisible()) return each;
    return nullptr;
  }
};

TEST_F(WorkbenchLayout, theDisplayShowsTheImageAndDocksAreSentWithoutOpenGl) {
  ASSERT_TRUE(settle());
  // The line of text at the bottom shows milliseconds, which differ from image to image.
  const auto upper = [](const QImage& image) { return image.copy(0, 0, image.width(), image.height() / 2); };
  const QImage drawn = w().viewport().grabFramebuffer().convertToFormat(QImage::Format_RGB32);
  EXPECT_TRUE(waitFor([&] { return upper(onDisplay(w().viewport())) == upper(drawn); }, 5000));
  EXPECT_EQ(w().windowHandle()->surfaceType(), QSurface::RasterSurface);
}

TEST_F(WorkbenchLayout, aQuestionLiesOverTheImageOnTheDisplay) {
  ASSERT_TRUE(settle());
  w().notices().ask("test", "Is this question seen?", {{"Yes", {}}});
  const auto seen = [&] {
    return onDisplay(w().notices()) == w().notices().grab().toImage().convertToFormat(QImage::Format_RGB32);
  };
  EXPECT_TRUE(waitFor(seen, 5000));
  const QImage question = onDisplay(w().notices());
  w().viewport().invalidate();
  ASSERT_TRUE(settle());
  EXPECT_EQ(onDisplay(w().notices()), question) << "the next image does not cover it";
  button(w().notices(), "Yes")->click();
  EXPECT_TRUE(waitFor([&] { return onDisplay(w().notices()) != question; }, 5000)) << "the image is back";
}

TEST_F(WorkbenchLayout, altAndANumberRaiseADockBehindAnother) {
  ASSERT_NO_FATAL_FAILURE(activate());
  QDockWidget &policy = *w().dock("policy"), &front = *w().dock("culling");
  QTest::keyClick(&w(), Qt::Key_1, Qt::AltModifier);
  ASSERT_TRUE(policy.isAncestorOf(QApplication::focusWidget()));
  front.raise();
  ASSERT_TRUE(waitFor([&] { return workbench::isInFront(front) && !workbench::isInFront(policy); }));
  QTest::keyClick(&w(), Qt::Key_1, Qt::AltModifier);
  EXPECT_TRUE(comesToFront("policy")) << "it was behind, so the key raises it";
  QTest::keyClick(&w(), Qt::Key_1, Qt::AltModifier);
  EXPECT_TRUE(policy.isHidden()) << "from inside, the key closes it";
}

TEST_F(WorkbenchLayout, afterARestartTabsHaveWholeTitles) {
  ASSERT_NO_FATAL_FAILURE(restart());
  const auto bars = [&] { return w().findChildren<QTabBar*>(QString(), Qt::FindDirectChildrenOnly); };
  ASSERT_TRUE(waitFor([&] { return !bars().isEmpty(); }));
  for (const QTabBar* bar : bars()) EXPECT_EQ(bar->elideMode(), Qt::ElideNone);
}

TEST_F(WorkbenchLayout, aSizeThatIsAskedForHoldsThoughTheLastWindowWasMaximised) {
  w().setWindowState(Qt::WindowMaximized);
  ASSERT_NO_FATAL_FAILURE(restart(QSize(1000, 700)));
  EXPECT_TRUE(waitFor([&] { return !w().isMaximized() && w().size() == QSize(1000, 700); }, 20000))
      << w().width() << " x " << w().height();
}

TEST_F(WorkbenchLayout, aQuestionMovesNoControl) {
  ASSERT_TRUE(settle());
  const QRect before = w().viewport().geometry();
  w().notices().ask("test", "Shall this question move the image?", {{"No", {}}});
  QCoreApplication::processEvents();  // layouts that the question may ask for
  EXPECT_TRUE(w().notices().isVisible());
  EXPECT_EQ(w().viewport().geometry(), before);
  EXPECT_TRUE(w().viewport().parentWidget()->rect().contains(w().notices().geometry()));
  button(w().notices(), "No")->click();
  EXPECT_FALSE(w().notices().isVisible());
}

TEST_F(WorkbenchLayout, anEmptyDepthMapSaysWhoServesInstead) {
  workbench::raiseDock(*w().panels().culling);
  const auto* const inset = w().panels().culling->findChild<views::DepthMapInset*>();
  const auto says = [&](const char* what) {
    return waitFor([&] { return inset->accessibleDescription().contains(what); });
  };
  ASSERT_TRUE(w().draft().setText("culling.case", "view_frustum").empty());
  EXPECT_TRUE(says("Culling case")) << inset->accessibleDescription().toStdString();
  ASSERT_TRUE(w().draft().setText("culling.case", "proposed").empty());
  ASSERT_TRUE(w().draft().setText("culling.occlusion", "horizon").empty());
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  w().feed().seekHere(climbsThrough(*readFlight(sampleFlight()), 2000));
  EXPECT_TRUE(says("the horizon serves")) << inset->accessibleDescription().toStdString();
  EXPECT_TRUE(says("What it covers of the view")) << inset->accessibleDescription().toStdString();
  // A change right after a reading of the map is the last image: its map is read too, a moment later.
  ASSERT_TRUE(settle());
  const std::uint64_t before = paints();
  w().viewport().invalidate();
  ASSERT_TRUE(waitFor([&] { return paints() > before; }));
  ASSERT_TRUE(w().draft().setText("culling.case", "view_frustum").empty());
  EXPECT_TRUE(says("Culling case")) << inset->accessibleDescription().toStdString();
}

TEST_F(WorkbenchLayout, aNumberBoxLeavesCtrlEToTheProgram) {
  ASSERT_NO_FATAL_FAILURE(activate());
  workbench::openParameter(*w().panels().parameters, "lod.scale");
  QWidget* const box = w().panels().parameters->line("lod.scale")->editor();
  ASSERT_TRUE(waitFor([&] { return box->isVisible(); }, 5000));
  box->setFocus();
  DialogCloser dialogs;
  QSignalSpy exported(command("Export again"), &QAction::triggered);
  QTest::keyClick(box, Qt::Key_E, Qt::ControlModifier);
  EXPECT_EQ(exported.size(), 1);
}

TEST_F(WorkbenchLayout, theMenuOfDocksTicksThoseThatAreShown) {
  auto* const menu = w().findChild<QMenu*>("docks");
  for (int i = 0; i < 5; ++i) {
    w().workspaces().show(i);
    w().workspaces().reset();
    emit menu->aboutToShow();
    for (const QAction* action : menu->actions())
      for (const QDockWidget* dock : w().findChildren<QDockWidget*>()) {
        if (action->text() != dock->windowTitle()) continue;
        EXPECT_EQ(action->isChecked(), !dock->isHidden()) << dock->windowTitle().toStdString() << " in " << i;
      }
  }
}

TEST_F(WorkbenchLayout, aClickOnTheTimelineOfAFlightSeeks) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  workbench::raiseDock(*w().panels().flight);
  ASSERT_TRUE(comesToFront(*w().panels().flight));
  auto* const line = w().panels().flight->findChild<QSlider*>();
  QTest::mouseClick(line, Qt::LeftButton, Qt::NoModifier, QPoint(line->width() * 3 / 4, line->height() / 2));
  const double whole = w().feed().playback().duration();
  EXPECT_NEAR(w().feed().playback().position(), 0.75 * whole, 0.03 * whole);
}

TEST_F(WorkbenchLayout, theNumbersOfAPickedNodeGoWhenTheViewIsNoLongerFrozen) {
  const auto says = [&](const QString& text) {
    const auto labels = w().panels().culling->findChildren<QLabel*>();
    return std::any_of(labels.begin(), labels.end(),
                       [&](const QLabel* label) { return label->text().contains(text); });
  };
  w().controllers().observer->setFrozen(true);
  views::PickedNode node;
  node.form = "tile";
  w().panels().culling->showPicked(node);
  EXPECT_TRUE(says("tile"));
  w().controllers().observer->setFrozen(false);
  EXPECT_TRUE(says("Nothing is picked"));
}

TEST_F(WorkbenchLayout, theWelcomePageOffersTheLastTerrainsAndFlights) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  trigger("Welcome page");
  auto* page = w().findChild<workbench::Welcome*>();
  ASSERT_NE(page, nullptr);
  const auto ways = page->findChildren<QCommandLinkButton*>();
  for (const char* name : {"terrain: ", "flight: "})
    EXPECT_TRUE(std::any_of(ways.begin(), ways.end(), [&](const QCommandLinkButton* way) {
      return way->toolTip().startsWith(QLatin1String(name));
    })) << name;
  page->close();
}

TEST_F(WorkbenchLayout, aScreenReaderHasANameForWhateverTheKeyboardReaches) {
  QStringList nameless;
  for (QWidget* each : w().findChildren<QWidget*>()) {
    if ((each->focusPolicy() & Qt::TabFocus) == 0 || each->focusProxy() != nullptr || each->isHidden())
      continue;
    // The line of a spin box and the list of a combo box are parts of it.
    if (each->objectName().startsWith(QLatin1String("qt_spinbox")) || each->inherits("QComboBoxListView"))
      continue;
    const QAccessibleInterface* const spoken = QAccessible::queryAccessibleInterface(each);
    if (spoken == nullptr || !spoken->text(QAccessible::Name).trimmed().isEmpty()) continue;
    const QWidget* dock = each;
    while (dock != nullptr && qobject_cast<const QDockWidget*>(dock) == nullptr) dock = dock->parentWidget();
    nameless << QStringLiteral("%1 in %2")
                    .arg(QString::fromLatin1(each->metaObject()->className()),
                         dock != nullptr ? dock->windowTitle() : QStringLiteral("the window"));
  }
  EXPECT_TRUE(nameless.isEmpty()) << nameless.join("\n").toStdString();
}

TEST_F(WorkbenchLayout, measuringWithoutAFlightIsRefusedBeforeItAsksAnything) {
  const int messages = w().messages().count();
  DialogCloser dialogs;
  w().controllers().errors->askAndMeasure();
  EXPECT_TRUE(comesToFront("errors"));
  EXPECT_EQ(dialogs.closed(), 0) << "no dialog whose answers would be thrown away";
  EXPECT_EQ(QApplication::activeModalWidget(), nullptr);
  EXPECT_EQ(w().messages().count(), messages);
  QDockWidget& dock = *w().dock("errors");
  EXPECT_TRUE(waitFor([&] { return button(dock, "Open a flight") != nullptr; }))
      << "the dock says how to get one";
  const auto labels = dock.findChildren<QLabel*>();
  EXPECT_TRUE(std::any_of(labels.begin(), labels.end(),
                          [](const QLabel* label) { return label->text().contains("needs a flight"); }));
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  dock.raise();
  ASSERT_TRUE(comesToFront("errors"));
  EXPECT_TRUE(waitFor([&] { return button(dock, "Open a flight") == nullptr; }));
}

}  // namespace
}  // namespace trimtab::test
