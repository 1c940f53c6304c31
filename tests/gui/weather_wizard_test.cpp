// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/workbench/dialogs/weather_wizard.h"

#include <QDockWidget>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QSpinBox>
#include <QTabWidget>
#include <QTableWidget>
#include <QTimer>
#include <cmath>

#include "gui_support.h"
#include "views/panels/weather_panel.h"

namespace trimtab::test {
namespace {

using workbench::WeatherStage;
using workbench::WeatherWizard;

/// An invented machine: 12 ms in clear air, of which the terrain up to 50 km costs 10 ms, and particles.
WeatherStage paper(double particlesMs, std::function<void(const WeatherDecision&)> drawn = {}) {
  WeatherStage stage;
  stage.farthestM = 50000;
  stage.conditions = "a machine on paper";
  stage.draw = [=](const WeatherDecision& d) -> std::optional<WeatherStage::Frame> {
    if (drawn) drawn(d);
    const double part = std::min(d.farM / 50000, 1.0);
    return WeatherStage::Frame{2 + 10 * part * part + particlesMs * d.density, 7};
  };
  return stage;
}

QString cell(WeatherWizard& wizard, int row, int column) {
  return wizard.findChild<QTableWidget*>()->item(row, column)->text();
}

TEST(WeatherWizardTest, writesAllStepsAsOneUndoStep) {
  views::Draft draft;
  WeatherWizard wizard(draft, paper(4));
  wizard.start();
  ASSERT_EQ(wizard.results().size(), 6u);
  EXPECT_EQ(draft.undoStack().count(), 0) << "nothing is written yet";
  wizard.write();
  EXPECT_EQ(draft.undoStack().count(), 1);
  for (int i = 1; i <= 6; ++i) {
    TuningParameters p = draft.parameters();
    p.weather.step = static_cast<WeatherStep>(i);
    const WeatherDecision d = decideWeather({}, p);
    const double part = std::min(d.farM / 50000, 1.0);
    EXPECT_NEAR(2 + 10 * part * part + 4 * d.density, 12, 12 * 0.05 + 0.01) << i;
  }
  draft.undoStack().undo();
  EXPECT_EQ(draft.parameters().rainHeavy.farStretch.value(), 1);
}

TEST(WeatherWizardTest, saysWhenNoCutIsEnough) {
  views::Draft draft;
  WeatherWizard wizard(draft, paper(40));
  wizard.start();
  ASSERT_EQ(wizard.results().size(), 6u);
  EXPECT_TRUE(cell(wizard, 5, 1).contains("Costs more than any cut can win (9.99 of 40 ms): density"))
      << cell(wizard, 5, 1).toStdString();
  wizard.write();
  EXPECT_LT(draft.parameters().snowHeavy.density.value(), 0.28);
  EXPECT_GT(draft.parameters().snowHeavy.density.value(), 0.2);
}

QPushButton* writeButton(WeatherWizard& wizard) {
  for (auto* button : wizard.findChildren<QPushButton*>())
    if (button->text() == QLatin1String("&Write to the preset")) return button;
  return nullptr;
}

QString rejectedText(WeatherWizard& wizard) {
  const QLabel* const label = labelNamed(wizard, "What is not written, and why");
  return label != nullptr && label->isVisibleTo(&wizard) ? label->text() : QString();
}

/// Another program takes half of the machine from a step on.
TEST(WeatherWizardTest, whatIsRejectedIsNotOfferedAndSaysWhyInThePlaceOfTheButton) {
  for (const Precipitation from : {Precipitation::rain, Precipitation::snow}) {
    views::Draft draft;
    double busier = 1;
    WeatherStage stage = paper(4);
    const auto idle = stage.draw;
    bool fell = false;
    stage.draw = [&, idle](const WeatherDecision& d) {
      auto frame = idle(d);
      fell = fell || d.precipitation == from;
      // Each time that clear air is measured after it began.
      if (fell && !d.fogged) busier += 0.5;
      frame->ms *= busier;
      return frame;
    };
    WeatherWizard wizard(draft, stage);
    wizard.start();
    ASSERT_EQ(wizard.results().size(), 6u);
    ASSERT_NE(writeButton(wizard), nullptr);
    const bool some = from == Precipitation::snow;
    EXPECT_EQ(writeButton(wizard)->isVisibleTo(&wizard), some);
    EXPECT_TRUE(
        rejectedText(wizard).startsWith(some ? "Not written with the others:" : "Nothing can be written:"))
        << rejectedText(wizard).toStdString();
    EXPECT_TRUE(rejectedText(wizard).contains("Heavy snow: the machine was busy"))
        << rejectedText(wizard).toStdString();
    wizard.write();
    EXPECT_EQ(draft.undoStack().count(), some ? 1 : 0);
    EXPECT_EQ(draft.parameters().snowHeavy.farStretch.value(), 1);
    EXPECT_EQ(draft.parameters().rainHeavy.farStretch.value() > 1, some);
    if (const QString shots = qEnvironmentVariable("TRIMTAB_SHOTS"); !shots.isEmpty())
      wizard.grab().save(shots + (some ? "/weather-some-rejected.png" : "/weather-all-rejected.png"));
  }
}

TEST(WeatherWizardTest, measuresTheStepsThatAreChosen) {
  views::Draft draft;
  WeatherWizard wizard(draft, paper(4));
  QListWidget* steps = wizard.findChild<QListWidget*>();
  for (int i = 0; i < steps->count(); ++i)
    steps->item(i)->setCheckState(i == 4 ? Qt::Checked : Qt::Unchecked);
  wizard.start();
  ASSERT_EQ(wizard.results().size(), 1u);
  EXPECT_EQ(wizard.results()[0].step, WeatherStep::snow_medium);
}

TEST(WeatherWizardTest, cancelsBetweenTwoPicturesAndKeepsWhatIsMeasured) {
  views::Draft draft;
  int drawn = 0;
  WeatherWizard* cancelled = nullptr;
  WeatherWizard wizard(draft, paper(4, [&](const WeatherDecision& d) {
                         ++drawn;
                         if (d.precipitation == Precipitation::snow) cancelled->cancel();
                       }));
  cancelled = &wizard;
  wizard.start();
  EXPECT_EQ(wizard.results().size(), 3u);
  EXPECT_FALSE(wizard.running());
  const int before = drawn;
  wizard.write();
  EXPECT_EQ(drawn, before);
  EXPECT_GT(draft.parameters().rainHeavy.farStretch.value(), 1);
  EXPECT_EQ(draft.parameters().snowHeavy.farStretch.value(), 1);
}

TEST(WeatherWizardTest, closedWhileItMeasuresStopsFirst) {
  views::Draft draft;
  WeatherWizard* closed = nullptr;
  WeatherWizard wizard(draft, paper(4, [&](const WeatherDecision&) { closed->reject(); }));
  closed = &wizard;
  wizard.show();
  wizard.start();
  EXPECT_FALSE(wizard.isVisible());
  EXPECT_TRUE(wizard.results().empty());
}

TEST(WeatherWizardTest, saysWhenNothingCanBeDrawn) {
  views::Draft draft;
  WeatherStage stage;
  stage.draw = [](const WeatherDecision&) { return std::optional<WeatherStage::Frame>(); };
  WeatherWizard wizard(draft, stage);
  wizard.start();
  EXPECT_TRUE(wizard.results().empty());
  wizard.write();
  EXPECT_EQ(draft.undoStack().count(), 0);
}

class WeatherOnTheBench : public Bench {
 protected:
  bool drawnIn(Precipitation falls) {
    return waitFor([this, falls] { return session().decision().weather.precipitation == falls; }) && settle();
  }
};

/// Saves a screenshot to look at if TRIMTAB_SHOTS names a folder.
void shoot(QWidget& widget, const char* name) {
  const QString folder = qEnvironmentVariable("TRIMTAB_SHOTS");
  if (folder.isEmpty()) return;
  QTest::qWait(300);
  widget.grab().save(folder + "/" + name + ".png");
}

TEST_F(WeatherOnTheBench, anEditChangesThePictureAndItsCounters) {
  ASSERT_TRUE(settle());
  const auto before = last();
  EXPECT_EQ(before.counters.precipitationPasses, 0u) << "no precipitation in clear air";
  w().draft().setText("weather.step", "rain_heavy");
  ASSERT_TRUE(drawnIn(Precipitation::rain));
  EXPECT_GT(last().counters.precipitationPasses, 0u);
  EXPECT_LT(last().visible.triangles, before.visible.triangles) << "cut at 4 km";
  w().dock("weather")->raise();
  shoot(w(), "weather-rain-heavy");
  w().draft().setText("weather.step", "snow_medium");
  ASSERT_TRUE(drawnIn(Precipitation::snow));
  shoot(w(), "weather-snow-medium");
  w().draft().setText("weather.step", "clear");
  ASSERT_TRUE(drawnIn(Precipitation::none));
  EXPECT_EQ(last().visible.triangles, before.visible.triangles);
}

TEST_F(WeatherOnTheBench, theWizardMeasuresThePictureAtHand) {
  ASSERT_TRUE(settle());
  std::size_t measured = 0;
  QTimer::singleShot(0, &w(), [&] {
    auto* wizard = w().findChild<WeatherWizard*>();
    ASSERT_NE(wizard, nullptr);
    QListWidget* steps = wizard->findChild<QListWidget*>();
    const bool all = !qEnvironmentVariable("TRIMTAB_SHOTS").isEmpty();
    for (int i = 0; i < steps->count(); ++i)
      steps->item(i)->setCheckState(all || i == 2 ? Qt::Checked : Qt::Unchecked);
    wizard->findChild<QSpinBox*>()->setValue(all ? 5 : 1);
    wizard->start();
    measured = wizard->results().size();
    for (const StepCalibration& c : wizard->results()) {
      EXPECT_GT(c.clearMs, 0);
      EXPECT_GT(c.uncutMs, 0);
      EXPECT_GE(c.farM, c.visibilityM);
      EXPECT_FALSE(c.trials.empty());
    }
    shoot(*wizard, "weather-wizard");
    wizard->findChild<QTabWidget*>()->setCurrentIndex(1);
    shoot(*wizard, "weather-wizard-plot");
    wizard->write();
    wizard->reject();
  });
  w().findChild<views::WeatherPanel*>()->calibrateButton().click();
  EXPECT_GT(measured, 0u);
  EXPECT_TRUE(settle());
}

}  // namespace
}  // namespace trimtab::test
