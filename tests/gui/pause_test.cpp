// SPDX-License-Identifier: GPL-3.0-or-later

#include "app/workbench/dialogs/bench_dialog.h"
#include "app/workbench/dialogs/weather_wizard.h"
#include "app/workbench/docks/error_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/leverage_page.h"
#include "app/workbench/jobs/child_run.h"
#include "app/workbench/jobs/view_pause.h"
#include "app/workbench/viewport/split_view.h"
#include "gui_support.h"
#include "views/panels/budget_strip.h"
#include "views/panels/weather_panel.h"

namespace trimtab::test {
namespace {

TEST(ViewPause, lastsUntilAllWhoMeasureHaveEndedOrAreGone) {
  workbench::ViewPause pause;
  int changes = 0;
  QObject::connect(&pause, &workbench::ViewPause::changed, &pause, [&] { ++changes; });
  QObject one;
  auto two = std::make_unique<QObject>();
  pause.begin(one, {});
  EXPECT_TRUE(pause.on());
  EXPECT_FALSE(pause.onBut(one));
  EXPECT_EQ(pause.text(), "") << "it says so itself";
  pause.begin(*two, "presets are measured");
  EXPECT_TRUE(pause.onBut(one));
  EXPECT_TRUE(pause.text().startsWith("PAUSED: presets are measured")) << pause.text().toStdString();
  pause.end(one);
  EXPECT_TRUE(pause.on());
  two.reset();
  EXPECT_FALSE(pause.on());
  EXPECT_EQ(changes, 4);
  pause.end(one);
  EXPECT_EQ(changes, 4);
}

TEST(ViewPause, endsWithARunHoweverItEnds) {
  for (const bool cancelled : {true, false}) {
    workbench::ViewPause pause;
    workbench::ChildRun run;
    pause.follow(run, &workbench::ChildRun::workingChanged, "an experiment runs");
    run.start({cancelled ? "terrain" : "no-such-command"});
    EXPECT_TRUE(pause.on());
    if (cancelled) run.cancel();
    EXPECT_TRUE(waitFor([&] { return !run.running(); }));
    EXPECT_FALSE(pause.on());
  }
}

/// A flight plays, so that the view would be drawn all the time.
class Pause : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
    w().panels().flight->play();
    ASSERT_TRUE(goesOn());
  }
  bool goesOn() {
    const std::uint64_t before = paints();
    return waitFor([&] { return paints() > before + 3; });
  }
  QString banner() { return w().viewport().overlayContents().banner; }
  /// Whether the view stands still, and says why, for as long as `running` holds.
  void expectPaused(const std::function<bool()>& running, const QString& why) {
    ASSERT_TRUE(w().viewport().paused());
    const std::size_t images = w().strip().minute().images();
    EXPECT_TRUE(waitFor([&] { return banner().contains(why); })) << banner().toStdString();
    // The banner itself is painted over the last image.
    waitFor([] { return false; }, 200);
    const std::uint64_t before = paints();
    if (const QString shots = qEnvironmentVariable("TRIMTAB_SHOTS"); !shots.isEmpty())
      onDisplay(w()).save(shots + "/paused.png");
    EXPECT_FALSE(waitFor([&] { return !running(); }, 300));
    EXPECT_TRUE(running());
    EXPECT_EQ(paints(), before);
    EXPECT_EQ(w().strip().minute().images(), images);
  }
  void expectGoesOn() {
    EXPECT_FALSE(w().viewport().paused());
    EXPECT_TRUE(goesOn());
    EXPECT_EQ(banner(), "");
  }
};

TEST_F(Pause, theViewStandsStillWhileLeverageIsMeasuredAndGoesOnWhenItIsCancelled) {
  workbench::LeveragePage& page = *w().panels().leverage;
  page.run();
  expectPaused([&] { return page.running(); }, "leverage is measured");
  page.cancel();
  ASSERT_TRUE(waitFor([&] { return !page.running(); }));
  expectGoesOn();
}

TEST_F(Pause, theViewGoesOnWhileAMeasurementIsPaused) {
  const ScratchDir dir;
  workbench::LeveragePage& leverage = *w().panels().leverage;
  workbench::ErrorDock& errors = w().controllers().errors->dock();
  workbench::BenchChoice choice;
  choice.folder = QString::fromStdString((dir / "out").string());
  const auto tryOut = [&](QWidget& page, const workbench::ChildRun& run, const auto& start,
                          const auto& cancel) {
    start();
    QPushButton* pause = nullptr;
    for (QPushButton* button : page.findChildren<QPushButton*>())
      if (button->text() == "&Pause") pause = button;
    ASSERT_NE(pause, nullptr);
    // Asked before the program can hold the signal, it stops at once.
    for (int i = 0; i < 2; ++i) {
      pause->click();
      ASSERT_TRUE(waitFor([&] { return labelSays(page, "Paused"); }));
      expectGoesOn();
      pause->click();
      EXPECT_TRUE(w().viewport().paused());
      EXPECT_FALSE(labelSays(page, "Paused"));
    }
    cancel();
    ASSERT_TRUE(waitFor([&] { return !run.running(); }));
  };
  tryOut(
      leverage, leverage.child(), [&] { leverage.run(); }, [&] { leverage.cancel(); });
  tryOut(
      errors, errors.child(), [&] { errors.measure(choice); }, [&] { errors.cancel(); });
  expectGoesOn();
}

TEST_F(Pause, theViewStandsStillWhilePresetsAreMeasuredAndGoesOnWhenThatFails) {
  const ScratchDir dir;
  workbench::ErrorDock& dock = w().controllers().errors->dock();
  workbench::BenchChoice choice;
  choice.presets = {workbench::BenchChoice::kDraft, "as-published"};
  choice.cases = {"proposed"};
  choice.size = "640x360";
  choice.frames = 20;
  choice.folder = QString::fromStdString((dir / "out").string());
  dock.measure(choice);
  expectPaused([&] { return dock.running(); }, "presets are measured");
  dock.cancel();
  ASSERT_TRUE(waitFor([&] { return !dock.running(); }));
  expectGoesOn();
  choice.presets = {"/no/such/preset.json"};
  dock.measure(choice);
  EXPECT_TRUE(w().viewport().paused());
  ASSERT_TRUE(waitFor([&] { return !dock.running(); }));
  EXPECT_TRUE(w().messages().text().contains("preset.json"));
  expectGoesOn();
}

TEST_F(Pause, theViewStandsStillWhileTheWeatherIsCalibrated) {
  bool measured = false;
  QTimer::singleShot(0, &w(), [&] {
    auto* wizard = w().findChild<workbench::WeatherWizard*>();
    ASSERT_NE(wizard, nullptr);
    QTimer::singleShot(0, wizard, [&, wizard] {
      EXPECT_TRUE(wizard->running());
      EXPECT_TRUE(w().viewport().paused());
      const std::uint64_t before = paints();
      QObject::connect(wizard, &workbench::WeatherWizard::measuringChanged, wizard, [&, before](bool on) {
        measured = !on;
        EXPECT_EQ(paints(), before);
      });
      QTimer::singleShot(300, wizard, &workbench::WeatherWizard::reject);
    });
    wizard->start();
  });
  w().findChild<views::WeatherPanel*>()->calibrateButton().click();
  EXPECT_TRUE(measured);
  expectGoesOn();
}

TEST_F(Pause, theViewWaitsWhileCompareDrawsAndGoesOnInBetween) {
  workbench::SplitView& split = w().controllers().errors->splitView();
  workbench::raiseDock(split);
  // The first numbers change the size of the dock, and with it that of the image.
  ASSERT_TRUE(waitFor([&] { return split.comparisons() >= 2; }));
  std::uint64_t before = paints(), drawnMeanwhile = 0, comparisons = 0;
  QObject ends;
  QObject::connect(&split, &workbench::SplitView::busyChanged, &ends, [&](bool busy) {
    if (busy)
      before = paints();
    else
      drawnMeanwhile += paints() - before, ++comparisons;
  });
  ASSERT_TRUE(waitFor([&] { return comparisons >= 4; }));
  EXPECT_EQ(drawnMeanwhile, 0u);
  w().dock("errors")->hide();
  ASSERT_TRUE(waitFor([&] { return !split.busy(); }));
  expectGoesOn();
}

}  // namespace
}  // namespace trimtab::test
