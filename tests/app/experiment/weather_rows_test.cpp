#include <gtest/gtest.h>

#include "app/experiment/weather_view.h"
#include "trimtab/preset/preset.h"

namespace trimtab::experiment {
namespace {

TEST(WeatherRows, sayWhereBothSchemesAreOneSetting) {
  const TuningParameters p = loadPreset("as-published")->parameters;
  const auto isOne = [&p](WeatherStep step) {
    return isOneSetting(weatherOf(p, step, RatioMode::fixed), weatherOf(p, step, RatioMode::adaptive));
  };
  EXPECT_TRUE(isOne(WeatherStep::rain_light)) << "both far planes lie at 20 km";
  EXPECT_FALSE(isOne(WeatherStep::rain_medium));
  EXPECT_FALSE(isOne(WeatherStep::clear)) << "one is cut, one is not";
  EXPECT_TRUE(isOneSetting({}, {}));
}

}  // namespace
}  // namespace trimtab::experiment
