// SPDX-License-Identifier: GPL-3.0-or-later
#include <QCheckBox>
#include <QDialog>
#include <QDockWidget>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTextBrowser>
#include <QTimer>
#include <QTreeWidget>
#include <QWhatsThis>

#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/window/appearance.h"
#include "app/workbench/window/fuzzy_match.h"
#include "app/workbench/window/palette.h"
#include "app/workbench/window/reference.h"
#include "app/workbench/window/status_strip.h"
#include "gui_support.h"
#include "views/controls/number_box.h"
#include "views/controls/parameter_of.h"
#include "views/model/theme.h"
#include "views/panels/budget_strip.h"
#include "views/panels/plots_panel.h"
#include "views/plots/time_plot.h"

namespace trimtab::test {
namespace {

using workbench::fuzzyScore;

TEST(FuzzyMatch, findsLettersInTheirOrderAndPrefersWordsThatBeginWithThem) {
  EXPECT_FALSE(fuzzyScore(u"xyz", u"Wireframe"));
  EXPECT_FALSE(fuzzyScore(u"fw", u"Wireframe")) << "their order counts";
  EXPECT_TRUE(fuzzyScore(u"WF", u"Wireframe")) << "case does not";
  EXPECT_TRUE(fuzzyScore(u"", u"anything"));
  EXPECT_TRUE(fuzzyScore(u"dep map", u"Depth map"));
  EXPECT_GT(*fuzzyScore(u"dm", u"Depth map"), *fuzzyScore(u"dm", u"Admit"));
  EXPECT_GT(*fuzzyScore(u"plots", u"Plots"), *fuzzyScore(u"plots", u"Policy lots"));
  EXPECT_GT(*fuzzyScore(u"host", u"Host"), *fuzzyScore(u"host", u"Host protocol of a packet"));
}

class WorkbenchFind : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    if (HasFatalFailure()) return;
    ASSERT_NO_FATAL_FAILURE(activate());
    palette_ = w().findChild<workbench::Palette*>();
    ASSERT_NE(palette_, nullptr);
  }
  void find(const char* typed) {
    ASSERT_NO_FATAL_FAILURE(activate());
    QTest::keyClick(&w(), Qt::Key_K, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return palette_->isVisible() && palette_->input().hasFocus(); }));
    QTest::keyClicks(&palette_->input(), typed);
  }
  /// Runs the current entry. The palette stays where there is none; else the window has the keys again.
  void run() {
    QTest::keyClick(&palette_->input(), Qt::Key_Return);
    EXPECT_TRUE(
        waitFor([&] { return palette_->isVisible() || QApplication::activeWindow() == window.get(); }));
  }
  /// Returns a cell of the row that Return would take; nothing if nothing is found.
  QString row(int column) {
    const QTreeWidgetItem* const item = palette_->list().currentItem();
    return item != nullptr ? item->text(column) : QString();
  }

  workbench::Palette* palette_ = nullptr;
};

TEST_F(WorkbenchFind, ctrlKFindsCommandsParametersDocksAndPresetsByKeysAlone) {
  ASSERT_NO_FATAL_FAILURE(find("wirefr"));
  EXPECT_TRUE(row(0).endsWith("Wireframe")) << row(0).toStdString();
  EXPECT_EQ(row(2), "Ctrl+Shift+1") << "with its shortcut";
  run();
  EXPECT_FALSE(palette_->isVisible());
  EXPECT_TRUE(w().controllers().frame->overlays().wireframe);

  ASSERT_NO_FATAL_FAILURE(find("fuzzy.hyst"));
  EXPECT_EQ(row(1), "parameter");
  run();
  EXPECT_TRUE(comesToFront("preset"));
  EXPECT_TRUE(waitFor(
      [] { return views::parameterOf(QApplication::focusWidget()) == QLatin1String("fuzzy.hysteresis"); }));

  w().dock("host")->close();
  ASSERT_NO_FATAL_FAILURE(find("host"));
  while (row(1) != "dock") {
    const auto* before = palette_->list().currentItem();
    QTest::keyClick(&palette_->input(), Qt::Key_Down);
    ASSERT_NE(palette_->list().currentItem(), before);
  }
  run();
  EXPECT_TRUE(comesToFront("host"));

  ASSERT_NO_FATAL_FAILURE(find("as-publ"));
  EXPECT_EQ(row(1), "preset");
  run();
  EXPECT_EQ(w().controllers().document->document().title(), "as-published");

  ASSERT_NO_FATAL_FAILURE(find("zzzzqqq"));
  EXPECT_EQ(palette_->list().topLevelItemCount(), 0);
  run();
  EXPECT_TRUE(palette_->isVisible()) << "nothing to run";
  QTest::keyClick(&palette_->input(), Qt::Key_Escape);
  EXPECT_FALSE(palette_->isVisible());
}

TEST_F(WorkbenchFind, aLeverHasOneNameThatFindsItsKnob) {
  ASSERT_NO_FATAL_FAILURE(find("allowed error"));
  EXPECT_EQ(row(0), "Allowed error (lod.screen_space_error_px)");
  QTest::keyClick(&palette_->input(), Qt::Key_Escape);
  ASSERT_NO_FATAL_FAILURE(activate());
  emit w().strip().knobAsked("lod.screen_space_error_px");
  EXPECT_TRUE(comesToFront("preset"));
  EXPECT_TRUE(waitFor([] {
    return views::parameterOf(QApplication::focusWidget()) == QLatin1String("lod.screen_space_error_px");
  })) << "the strip opens the knob that it names";
}

TEST_F(WorkbenchFind, ctrlKOpensTheFlightsThatShip) {
  ASSERT_NO_FATAL_FAILURE(find("yecheon-circ"));
  EXPECT_EQ(row(0), "yecheon-circuit.csv");
  EXPECT_EQ(row(2), "ships");
  run();
  EXPECT_TRUE(waitFor([&] { return !w().feed().playback().flight().states.empty(); }));
}

TEST_F(WorkbenchFind, f1OnAControlShowsItsEntryAndTheReferenceIsSearched) {
  QDockWidget& dock = *w().dock("preset");
  dock.show();
  dock.raise();
  views::NumberBox* box = nullptr;
  for (views::NumberBox* each : dock.findChildren<views::NumberBox*>())
    if (views::parameterOf(each) == "fuzzy.hysteresis") box = each;
  ASSERT_NE(box, nullptr);
  box->setFocus();
  QTest::keyClick(&w(), Qt::Key_F1);
  auto* const reference = w().findChild<workbench::Reference*>();
  ASSERT_NE(reference, nullptr);
  EXPECT_TRUE(reference->isVisible());
  EXPECT_TRUE(reference->text().toPlainText().contains("fuzzy.hysteresis"));
  EXPECT_FALSE(reference->text().toPlainText().contains("weather.visibility"));
  reference->search().setText("visibility weather");
  EXPECT_FALSE(reference->text().toPlainText().contains("fuzzy.hysteresis"));
  EXPECT_TRUE(reference->text().toPlainText().contains("visibility", Qt::CaseInsensitive));
  reference->search().setText("no such words at all");
  EXPECT_TRUE(reference->text().toPlainText().contains("No parameter"));
  reference->close();
  w().activateWindow();
  w().viewport().setFocus();
}

TEST_F(WorkbenchFind, f1SaysWhatAnyControlDoesInADialogToo) {
  auto* const reference = w().findChild<workbench::Reference*>();
  w().viewport().setFocus();
  ASSERT_TRUE(reference->explain(&w().viewport()));
  EXPECT_TRUE(reference->text().toPlainText().contains("Terrain view"));
  auto* const plots = w().findChild<views::PlotsPanel*>();
  ASSERT_TRUE(reference->explain(plots->findChild<views::TimePlot*>()));
  EXPECT_TRUE(reference->text().toPlainText().contains("In the dock Plots"))
      << reference->text().toPlainText().toStdString();
  EXPECT_GT(reference->text().toPlainText().size(), 60) << "more than its name";
  reference->close();

  QDialog dialog(&w());
  auto* const box = new QCheckBox("Keep it", &dialog);
  box->setToolTip("Keeps what is there.");
  QString said;
  QTimer::singleShot(0, &dialog, [&] {
    box->setFocus();
    QTest::keyClick(box, Qt::Key_F1);
    for (QWidget* each : QApplication::topLevelWidgets())
      if (each->isVisible() && each->inherits("QWhatsThat")) said = "shown";
    QWhatsThis::hideText();
    dialog.reject();
  });
  dialog.exec();
  EXPECT_EQ(said, "shown");
  EXPECT_FALSE(reference->isVisible());
}

TEST_F(WorkbenchFind, theStripSaysWorkspaceBudgetRecordingAndHostWithoutMovingOneAnother) {
  auto* const strip = w().findChild<workbench::StatusStrip*>();
  ASSERT_NE(strip, nullptr);
  const auto place = [&](const char* name) { return labelNamed(*strip, QLatin1String(name)); };
  QLabel *recording = place("Recording"), *source = place("Who moves the aircraft");
  ASSERT_TRUE(recording && source && place("Workspace"));
  ASSERT_TRUE(waitFor([&] { return place("Frame time and budget")->text().contains("ms"); }));
  const QRect before = source->geometry();
  const ScratchDir dir;
  auto& trace = *w().controllers().trace;
  ASSERT_TRUE(trace.start(QString::fromStdString((dir / "trace.csv").string())));
  EXPECT_TRUE(recording->text().contains("trace"));
  trace.stop();
  EXPECT_EQ(recording->text(), "");
  listen();
  EXPECT_TRUE(waitFor([&] { return source->text().contains("listening"); }));
  w().feed().closeHost();
  EXPECT_EQ(source->geometry(), before);
}

/// Measures how far a check box that is off, and the symbols of the buttons to play, stand out from what is
/// around them: the largest difference of their grey values, 0..255.
int contrastOf(QWidget& widget, QRect area) {
  const QImage picture = widget.grab(area).toImage().convertToFormat(QImage::Format_Grayscale8);
  int least = 255, most = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const int grey = qGray(picture.pixel(x, y));
      least = std::min(least, grey);
      most = std::max(most, grey);
    }
  return most - least;
}

class Colours : public Bench {
 protected:
  void TearDown() override {
    workbench::apply(workbench::Appearance::system);
    Bench::TearDown();
  }
};

TEST_F(Colours, boxesAndSymbolsAreSeenInBothThemes) {
  w().dock("flight")->raise();
  ASSERT_TRUE(comesToFront("flight"));
  for (const auto theme : {workbench::Appearance::dark, workbench::Appearance::light}) {
    workbench::apply(theme);
    QCoreApplication::processEvents();
    auto* const box = w().panels().flight->findChild<QCheckBox*>();
    ASSERT_FALSE(box->isChecked());
    EXPECT_GE(contrastOf(*box, {0, 0, box->height(), box->height()}), 60) << int(theme);
    for (auto* button : w().panels().flight->findChildren<QPushButton*>()) {
      if (button->icon().isNull()) continue;
      // Beside a text, the symbol is left of the middle.
      const int side = button->height() - 8;
      const int left = button->text().isEmpty() ? button->width() / 2 - side / 2 : side / 2;
      EXPECT_GE(contrastOf(*button, {left, 4, side, side}), 60) << int(theme);
    }
  }
}

TEST_F(WorkbenchFind, lightAndDarkAreChosenWithinTheProgram) {
  workbench::apply(workbench::Appearance::dark);
  EXPECT_TRUE(waitFor([&] { return views::isDark(w().palette()); }));
  workbench::apply(workbench::Appearance::light);
  EXPECT_TRUE(waitFor([&] { return !views::isDark(w().palette()); }));
  workbench::apply(workbench::Appearance::system);
}

TEST_F(WorkbenchFind, theNextRunHasTheColoursThatWereChosen) {
  trigger("Dark");
  EXPECT_TRUE(waitFor([&] { return views::isDark(w().palette()); }));
  workbench::apply(workbench::Appearance::system);  // as a new program begins
  ASSERT_NO_FATAL_FAILURE(restart());
  EXPECT_TRUE(waitFor([&] { return views::isDark(w().palette()); }));
  EXPECT_TRUE(command("Dark")->isChecked());
  for (const QLabel* label : w().findChildren<QLabel*>())
    EXPECT_GT(label->palette().color(label->foregroundRole()).lightness(), 120)
        << "dark text: " << label->accessibleName().toStdString() << label->text().toStdString();
  trigger("As the desktop");
}

}  // namespace
}  // namespace trimtab::test
