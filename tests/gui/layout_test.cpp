// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAccessible>
#include <QCommandLinkButton>
#include <QDockWidget>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QRegularExpression>
#include <QSignalSpy>
#include <QSlider>
#include <QTabBar>
#include <QWindow>
#include <algorithm>
#include <cmath>

#include "app/workbench/dialogs/notice_bar.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/error_dock.h"
#include "app/workbench/docks/flight_dock.h"
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

/// Relative luminance, as the Web Content Accessibility Guidelines define it.
double luminance(const QColor& colour) {
  const auto linear = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(colour.redF()) + 0.7152 * linear(colour.greenF()) + 0.0722 * linear(colour.blueF());
}

/// Texts, shown or not, that their background hides. Three to one is what the guidelines ask for large text;
/// what was coloured for the other theme is below it.
QStringList paleTexts(const QWidget& window) {
  QStringList pale;
  const auto look = [&](const QWidget& on, const QColor& ink, const QString& text) {
    const double a = luminance(ink), b = luminance(on.palette().color(on.backgroundRole()));
    if (on.isEnabled() && !text.isEmpty() && (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05) < 3)
      pale << ink.name() + ": " + text;
  };
  static const QRegularExpression coloured(QStringLiteral("color:(#[0-9a-f]{6})"));
  for (const QLabel* label : window.findChildren<QLabel*>()) {
    look(*label, label->palette().color(label->foregroundRole()), label->text());
    for (auto found = coloured.globalMatch(label->text()); found.hasNext();)
      look(*label, QColor(found.next().captured(1)), label->text());
  }
  for (const QLineEdit* line : window.findChildren<QLineEdit*>())
    look(*line, line->palette().color(line->foregroundRole()), line->text());
  return pale;
}

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

TEST_F(WorkbenchLayout, aThemeThatIsChosenLaterColoursEveryText) {
  trigger("Light");
  ASSERT_TRUE(w().draft().setText("fuzzy.hysteresis", "0.9").empty())
      << "breaks a rule, which several docks say";
  ASSERT_TRUE(w().draft().isBroken());
  ASSERT_TRUE(w().draft().setText("lod.scale", "2").empty());
  const auto mark = [this] { return w().panels().parameters->line("lod.scale")->label().text(); };
  const QString before = mark();
  EXPECT_TRUE(paleTexts(w()).isEmpty()) << paleTexts(w()).join("\n").toStdString();
  for (const char* theme : {"Dark", "Light"}) {
    trigger(theme);
    QCoreApplication::processEvents();
    EXPECT_TRUE(paleTexts(w()).isEmpty()) << theme << '\n' << paleTexts(w()).join("\n").toStdString();
    EXPECT_EQ(mark() == before, theme == std::string_view("Light"))
        << "the mark of a change has its own colour";
  }
  trigger("As the desktop");
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
  w().controllers().observer->setFrozen(true);
  views::PickedNode node;
  node.form = "tile";
  w().panels().culling->showPicked(node);
  EXPECT_TRUE(labelSays(*w().panels().culling, "tile"));
  w().controllers().observer->setFrozen(false);
  EXPECT_TRUE(labelSays(*w().panels().culling, "Nothing is picked"));
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
  EXPECT_TRUE(labelSays(dock, "needs a flight"));
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  dock.raise();
  ASSERT_TRUE(comesToFront("errors"));
  EXPECT_TRUE(waitFor([&] { return button(dock, "Open a flight") == nullptr; }));
}

}  // namespace
}  // namespace trimtab::test
