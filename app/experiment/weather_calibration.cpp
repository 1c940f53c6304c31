#include <cmath>

#include "stage.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/units/number.h"
#include "weather_view.h"

namespace trimtab::experiment {

Result<CalibratedWeather> calibrateWeather(const Setup& setup, const WeatherCalibration& wanted) {
  const auto opened = WeatherView::open(setup);
  if (!opened) return opened.findings();
  WeatherView& view = **opened;

  CalibratedWeather calibrated;
  calibrated.vertices = view.vertices();
  if (wanted.vertices) {
    const double error = view.reach(*wanted.vertices, calibrated.vertices);
    if (std::abs(calibrated.vertices / *wanted.vertices - 1) > WeatherView::kWithin)
      return Finding{Severity::error, setup.terrainName, "--vertices",
                     numberText(*wanted.vertices) + " vertices in view",
                     numberText(calibrated.vertices) + " at " + numberText(error) + " px"};
  }
  for (const WeatherStep step : wanted.steps) {
    const std::string what(findRow("weather.step")->choices[static_cast<std::size_t>(step)].label);
    const double fraction = double(calibrated.steps.size()) / double(wanted.steps.size());
    const auto found = calibrateOn(view, setup, view.preset(), step, wanted.mostTrials,
                                   [&] { return !setup.progress || setup.progress(fraction, what); });
    if (!found) return cancelled();
    calibrated.steps.push_back(*found);
  }
  return calibrated;
}

}  // namespace trimtab::experiment
