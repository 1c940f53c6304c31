// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/panels/weather_panel.h"

#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSignalSpy>
#include <QTableWidget>

#include "application.h"
#include "tests/support.h"
#include "trimtab/weather/weather.h"
#include "views/controls/number_box.h"
#include "views/controls/parameter_line.h"
#include "views/controls/parameter_slider.h"

namespace trimtab::views {
namespace {

class WeatherPanelTest : public testing::Test {
 protected:
  void SetUp() override { test::expose(panel_, {480, 640}); }
  void fly(const AircraftState& state = {}) {
    LiveFrame frame;
    frame.decision.weather = decideWeather(state, *draft_.active());
    frame.input.state = state;
    panel_.showFrame(frame);
  }
  bool says(const QString& text) {
    return test::eventually([&] {
      for (const QLabel* label : panel_.findChildren<QLabel*>())
        if (label->isVisible() && label->text() == text) return true;
      return false;
    });
  }
  QString step(int row, int column) { return panel_.steps().item(row, column)->text(); }

  Draft draft_;
  WeatherPanel panel_{draft_};
};

TEST_F(WeatherPanelTest, saysWhatFallsHowFarOneSeesAndWhy) {
  fly();
  EXPECT_TRUE(says("Clear"));
  EXPECT_TRUE(says("unlimited"));
  draft_.setText("weather.step", "snow_heavy");
  fly();
  EXPECT_TRUE(says("Snow and haze"));
  EXPECT_TRUE(says("1,600 m (0.86 NM)"));
  EXPECT_TRUE(says("0.000625"));
  EXPECT_EQ(panel_.reason().toStdString(), explain(decideWeather({}, *draft_.active())));
  draft_.setText("weather.clear_visibility_m", "20000");
  fly();
  EXPECT_TRUE(says("Snow and fog")) << "800 m";
}

TEST_F(WeatherPanelTest, saysWhatTheHostSaysWhoeverDecides) {
  fly();
  EXPECT_TRUE(says("nothing of weather"));
  AircraftState state;
  state.weather = HostWeather{Precipitation::rain, 4, Metres{5000}};
  state.visibility = Metres{9260};
  fly(state);
  EXPECT_TRUE(says("rain of severity 4, 5,000 m (2.7 NM) in it, visibility 9,260 m (5 NM)"));
  EXPECT_TRUE(says("Clear")) << "the preset decides";
  draft_.setText("weather.source", "host");
  fly(state);
  EXPECT_TRUE(says("Rain and haze"));
}

TEST_F(WeatherPanelTest, listsWhatEachStepMeansAsTheDraftStands) {
  EXPECT_EQ(step(0, 1), "unlimited");
  EXPECT_EQ(step(0, 3), "0") << "a density of nothing is a number too";
  EXPECT_EQ(step(0, 4), "no cut");
  EXPECT_EQ(step(3, 1), "4,000");
  EXPECT_EQ(step(3, 2), "2.16");
  EXPECT_EQ(step(3, 3), "1");
  EXPECT_EQ(step(3, 4), "4,000");
  EXPECT_EQ(step(3, 5), "0.00025");
  draft_.setText("weather.rain_heavy.far_stretch", "2");
  draft_.setText("weather.source", "host");
  EXPECT_EQ(step(3, 4), "8,000");
  draft_.setText("weather.visibility_from", "typed");
  EXPECT_EQ(step(0, 1), "10,000") << "the typed visibility holds for all";
  EXPECT_EQ(step(3, 1), "10,000");
}

TEST_F(WeatherPanelTest, showsTheLinesThatCount) {
  EXPECT_NE(panel_.line("weather.clear_visibility_m"), nullptr);
  EXPECT_EQ(panel_.line("weather.typed_visibility_m"), nullptr);
  EXPECT_EQ(panel_.line("weather.fixed_ratio"), nullptr);
  EXPECT_EQ(panel_.line("weather.rain_light.density"), nullptr);
  draft_.setText("weather.step", "rain_light");
  EXPECT_NE(panel_.line("weather.rain_light.density"), nullptr);
  EXPECT_NE(panel_.line("weather.rain_light.far_stretch"), nullptr);
  EXPECT_EQ(panel_.line("weather.snow_light.density"), nullptr);
  draft_.setText("weather.ratio_mode", "fixed");
  EXPECT_EQ(panel_.line("weather.rain_light.far_stretch"), nullptr);
  EXPECT_NE(panel_.line("weather.fixed_ratio"), nullptr);
}

TEST_F(WeatherPanelTest, itsSliderIsExponentialAndOneStepADrag) {
  draft_.setText("weather.visibility_from", "typed");
  ParameterLine* line = panel_.line("weather.typed_visibility_m");
  ASSERT_NE(line, nullptr);
  ParameterSlider* slider = line->editor()->parentWidget()->findChild<ParameterSlider*>();
  ASSERT_NE(slider, nullptr);
  const int undos = draft_.undoStack().count();
  slider->setSliderDown(true);
  double last = 0, ratio = 0;
  for (const double part : {0.25, 0.5, 0.75}) {
    slider->setValue(slider->minimum() + static_cast<int>(part * (slider->maximum() - slider->minimum())));
    const double now = draft_.parameters().weather.typedVisibility.value();
    if (ratio > 0) {
      EXPECT_NEAR(now / last, ratio, 0.1 * ratio) << "equal ways, equal ratios";
    }
    ratio = last > 0 ? now / last : 0;
    last = now;
  }
  slider->setSliderDown(false);
  EXPECT_EQ(draft_.undoStack().count(), undos + 1);
}

TEST_F(WeatherPanelTest, refusesATypedVisibilityOutsideItsRange) {
  draft_.setText("weather.visibility_from", "typed");
  for (const char* const bad : {"0", "-100", "nan", "inf", "2000000"})
    EXPECT_FALSE(draft_.setText("weather.typed_visibility_m", bad).empty()) << bad;
  EXPECT_EQ(draft_.parameters().weather.typedVisibility.value(), 10000);
}

TEST_F(WeatherPanelTest, choosesAStepFromTheTableAndAsksForTheWizard) {
  emit panel_.steps().cellActivated(5, 0);
  EXPECT_EQ(draft_.parameters().weather.step, WeatherStep::snow_medium);
  EXPECT_TRUE(panel_.steps().item(5, 0)->font().bold());
  QSignalSpy asked(&panel_, &WeatherPanel::calibrationAsked);
  panel_.calibrateButton().click();
  EXPECT_EQ(asked.count(), 1);
}

}  // namespace
}  // namespace trimtab::views
