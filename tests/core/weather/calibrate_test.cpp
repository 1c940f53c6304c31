#include "trimtab/weather/calibrate.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/table.h"

namespace trimtab::test {
namespace {

/// A machine on paper: terrain costs with the area in sight up to its edge, particles with their density.
struct Machine {
  double fixedMs = 2;
  double terrainMs = 10;  ///< all of it, out to edgeM
  double edgeM = 50000;
  double particlesMs = 4;  ///< at density 1
  double fogMs = 0;        ///< shading, once there is fog

  double terrainTo(double farM) const {
    const double part = std::min(farM / edgeM, 1.0);
    return terrainMs * part * part;
  }
  double operator()(const WeatherDecision& d) const {
    return fixedMs + terrainTo(d.farM) + particlesMs * d.density + (d.fogged ? fogMs : 0);
  }
};

MeasureFrame exactly(const Machine& machine) {
  return [machine](const WeatherDecision& d) { return std::optional(machine(d)); };
}

CalibrationSettings settings(double tolerance = 0.01) {
  CalibrationSettings s;
  s.tolerance = tolerance;
  s.farthestM = 50000;
  return s;
}

StepCalibration calibrated(WeatherStep step, const MeasureFrame& measure, double tolerance = 0.01,
                           const TuningParameters& parameters = {}) {
  const auto result = calibrateStep(step, parameters, measure, settings(tolerance));
  EXPECT_TRUE(result);
  return result.value_or(StepCalibration{});
}

TEST(Calibration, pushesTheFarPlaneOutUntilGainAndLossMatch) {
  // Heavy rain costs 4 of 12 ms; terrain to r costs 10 (r / 50 km)^2, so the cut wins 4 at r = 50 km
  // sqrt(0.6).
  const StepCalibration c = calibrated(WeatherStep::rain_heavy, exactly(Machine{}));
  EXPECT_EQ(c.outcome, CalibrationOutcome::matched);
  EXPECT_DOUBLE_EQ(c.clearMs, 12);
  EXPECT_DOUBLE_EQ(c.lossMs(), 4);
  EXPECT_NEAR(c.strongestGainMs(), 10 - 10 * 0.08 * 0.08, 1e-9) << "cut at 4 km of 50";
  EXPECT_NEAR(c.gainMs(), c.lossMs(), 0.12);
  const double exact = 50000 * std::sqrt(0.6);
  EXPECT_NEAR(c.farM, exact, 0.012 * exact) << "1 % of 12 ms is 1.2 % of this far plane";
  EXPECT_DOUBLE_EQ(c.nearFarRatio, 1 / c.farM);
  EXPECT_EQ(c.density, 1);
  EXPECT_FALSE(c.notMonotone);

  // What is written is what decides: the frame then takes as long as the clear one.
  TuningParameters p;
  apply(c, p);
  p.weather.step = WeatherStep::rain_heavy;
  EXPECT_TRUE(validate(p));
  EXPECT_NEAR(Machine{}(decideWeather(AircraftState{}, p)), 12, 0.12 + 0.01);
}

TEST(Calibration, matchesEveryStepOfAFastMachine) {
  for (int i = 1; i <= 6; ++i) {
    const auto step = static_cast<WeatherStep>(i);
    const StepCalibration c = calibrated(step, exactly(Machine{}));
    EXPECT_EQ(c.outcome, CalibrationOutcome::matched) << i;
    EXPECT_NEAR(c.matchedMs, 12, 0.12);
    EXPECT_GE(c.farM, c.visibilityM);
  }
}

TEST(Calibration, saysWhenNoCutIsEnoughAndWhichDensityFits) {
  // Particles of 15 ms against terrain of 10: at most (10 - 10 * 0.032^2) / 15 of them, and the tolerance.
  Machine machine;
  machine.particlesMs = 15;
  const StepCalibration c = calibrated(WeatherStep::snow_heavy, exactly(machine));
  EXPECT_EQ(c.outcome, CalibrationOutcome::cut_not_enough);
  EXPECT_EQ(c.farM, c.visibilityM) << "the strongest cut";
  const double fits = (10 - 10 * 0.032 * 0.032 + 0.12) / 15;
  EXPECT_LE(c.density, fits);
  EXPECT_GT(c.density, fits - 0.011);
  EXPECT_LE(c.matchedMs, 12.12);
  TuningParameters p;
  apply(c, p);
  EXPECT_LE(p.snowHeavy.density.value(), c.density);
  EXPECT_NEAR(p.snowHeavy.density.value(), c.density, 0.001);
  EXPECT_EQ(p.snowHeavy.farStretch.value(), 1);
  EXPECT_EQ(p.snowMedium.density.value(), 0.5) << "other steps stay";
}

TEST(Calibration, saysWhenEvenTheFogCostsMoreThanTheCutWins) {
  Machine machine;
  machine.fogMs = 11;
  const StepCalibration c = calibrated(WeatherStep::rain_light, exactly(machine));
  EXPECT_EQ(c.outcome, CalibrationOutcome::fog_not_enough);
  EXPECT_EQ(c.density, 0);
}

TEST(Calibration, cutsNothingWhereTheWeatherCostsNothing) {
  Machine machine;
  machine.particlesMs = 0.05;
  const StepCalibration c = calibrated(WeatherStep::rain_light, exactly(machine));
  EXPECT_EQ(c.outcome, CalibrationOutcome::costs_nothing);
  EXPECT_EQ(c.farM, 50000) << "all of the terrain";
  TuningParameters p;
  apply(c, p);
  EXPECT_EQ(p.rainLight.farStretch.value(), 2.5);
  EXPECT_EQ(p.rainLight.density.value(), 0.25);
}

TEST(Calibration, thinsOutWhereTheVisibilityReachesBeyondTheTerrain) {
  Machine machine;
  machine.edgeM = 5000;
  CalibrationSettings s = settings();
  s.farthestM = 5000;
  const auto c = calibrateStep(WeatherStep::rain_light, {}, exactly(machine), s);
  ASSERT_TRUE(c);
  EXPECT_EQ(c->outcome, CalibrationOutcome::cut_not_enough) << "a far plane at 20 km cuts nothing of 5 km";
  EXPECT_NEAR(c->density, 0.12 / 4, 0.01) << "what the tolerance leaves";
}

TEST(Calibration, settlesThroughNoise) {
  std::mt19937 random(11);
  for (int run = 0; run < 50; ++run) {
    std::normal_distribution<double> noise(1, 0.01);
    const Machine machine;
    const MeasureFrame noisy = [&](const WeatherDecision& d) {
      const double outlier = random() % 10 == 0 ? 1.5 : 1;  // another program ran
      return std::optional(machine(d) * noise(random) * outlier);
    };
    CalibrationSettings s = settings(0.05);
    s.repeats = 7;
    const auto c = calibrateStep(WeatherStep::rain_heavy, {}, noisy, s);
    ASSERT_TRUE(c);
    EXPECT_EQ(c->outcome, CalibrationOutcome::matched);
    TuningParameters p;
    apply(*c, p);
    p.weather.step = WeatherStep::rain_heavy;
    EXPECT_NEAR(machine(decideWeather(AircraftState{}, p)), 12, 12 * (0.05 + 0.04));
  }
}

TEST(Calibration, saysWhenAFartherCutIsFaster) {
  // Terrain that is cheaper the farther one sees: nothing that a search by halves may trust.
  const MeasureFrame falling = [](const WeatherDecision& d) {
    if (!d.fogged) return std::optional(12.0);
    return std::optional(std::isinf(d.farM) ? 20.0 : 11 - d.farM / 10000);
  };
  const StepCalibration c = calibrated(WeatherStep::rain_heavy, falling);
  EXPECT_TRUE(c.notMonotone);
  EXPECT_EQ(c.outcome, CalibrationOutcome::not_settled);
  const auto nearest = std::min_element(c.trials.begin(), c.trials.end(),
                                        [](const CalibrationTrial& a, const CalibrationTrial& b) {
                                          return std::abs(a.ms - 12) < std::abs(b.ms - 12);
                                        });
  EXPECT_EQ(c.matchedMs, nearest->ms) << "the trial nearest to the clear frame";
}

TEST(Calibration, takesTheNearestMatchWhereTilesComeAndGoAtOnce) {
  // A jump from 8 ms to 16 ms at 20 km: no far plane matches 12 ms.
  const MeasureFrame jumps = [](const WeatherDecision& d) {
    if (!d.fogged) return std::optional(12.0);
    return std::optional(d.farM < 20000 ? 9.0 : 16.0);
  };
  const StepCalibration c = calibrated(WeatherStep::rain_heavy, jumps);
  EXPECT_EQ(c.outcome, CalibrationOutcome::not_settled);
  EXPECT_EQ(c.matchedMs, 9);
  EXPECT_FALSE(c.notMonotone);
}

TEST(Calibration, saysWhenTheMachineBecameBusyMeanwhile) {
  for (const double busier : {1.0, 1.5}) {
    int calls = 0;
    const MeasureFrame measure = [&](const WeatherDecision& d) {
      return std::optional(Machine{}(d) * (++calls > 12 ? busier : 1));
    };
    const StepCalibration c = calibrated(WeatherStep::rain_heavy, measure, 0.05);
    EXPECT_EQ(c.drifted, busier > 1);
    EXPECT_DOUBLE_EQ(c.clearMs, 12);
    EXPECT_DOUBLE_EQ(c.clearAfterMs, 12 * busier);
  }
}

/// Results on which the calibration's own checks turn.
std::vector<StepCalibration> doubtful() {
  int calls = 0;
  const MeasureFrame busy = [&calls](const WeatherDecision& d) {
    return std::optional(Machine{}(d) * (++calls > 12 ? 1.5 : 1));
  };
  const MeasureFrame fartherIsFaster = [](const WeatherDecision& d) {
    if (!d.fogged) return std::optional(12.0);
    return std::optional(std::isinf(d.farM) ? 20.0 : 11 - d.farM / 10000);
  };
  // Slow without a far plane, and faster than clear air with any: a plane at the terrain's end removes
  // nothing.
  const MeasureFrame noCutIsSlower = [](const WeatherDecision& d) {
    return std::optional(!d.fogged ? 12.0 : std::isinf(d.farM) ? 20.0 : 6 + d.farM / 1e5);
  };
  const MeasureFrame noNumber = [](const WeatherDecision& d) {
    return std::optional(d.fogged ? std::nan("") : 12.0);
  };
  return {calibrated(WeatherStep::rain_heavy, busy, 0.05),
          calibrated(WeatherStep::rain_medium, fartherIsFaster),
          calibrated(WeatherStep::snow_light, noCutIsSlower), calibrated(WeatherStep::snow_heavy, noNumber)};
}

TEST(Calibration, whatItRejectsIsNotWrittenAndSaysWhy) {
  std::vector<StepCalibration> results = doubtful();
  const char* const reasons[] = {"clear air took 12.00 ms before and 18.00 ms after", "contradict each other",
                                 "contradict each other", "no number"};
  for (std::size_t i = 0; i < results.size(); ++i)
    EXPECT_THAT(whyRejected(results[i]), ::testing::HasSubstr(reasons[i])) << i;
  EXPECT_GT(results[2].farM, 0.9 * 50000) << "a far plane that no time speaks for";
  results.push_back(calibrated(WeatherStep::rain_light, exactly(Machine{})));
  EXPECT_EQ(whyRejected(results.back()), "");

  TuningParameters p;
  const std::vector<RejectedStep> rejected = applyAccepted(results, p);
  ASSERT_EQ(rejected.size(), 4u);
  EXPECT_EQ(rejected[2].step, WeatherStep::snow_light);
  EXPECT_EQ(rejected[2].why, whyRejected(results[2]));
  TuningParameters light;
  apply(results.back(), light);
  EXPECT_TRUE(differences(p, light).empty()) << "what is accepted is written beside them";
  EXPECT_FALSE(differences(p, {}).empty());
}

TEST(Calibration, aJumpBetweenTwoFarPlanesIsNoContradiction) {
  const MeasureFrame jumps = [](const WeatherDecision& d) {
    return std::optional(!d.fogged ? 12.0 : d.farM < 20000 ? 9.0 : 16.0);
  };
  EXPECT_EQ(whyRejected(calibrated(WeatherStep::rain_heavy, jumps)), "");
}

TEST(Calibration, endsWhenTheMeasuringStops) {
  for (int stopAfter = 0; stopAfter < 20; ++stopAfter) {
    int left = stopAfter;
    const MeasureFrame stops = [&left](const WeatherDecision& d) {
      return left-- > 0 ? std::optional(Machine{}(d)) : std::nullopt;
    };
    const auto c = calibrateStep(WeatherStep::rain_heavy, {}, stops, settings(1e-6));
    EXPECT_FALSE(c) << stopAfter;
    EXPECT_EQ(left, -1) << "and measures nothing more";
  }
}

TEST(Calibration, ofTimesThatAreNoNumbersWritesNothing) {
  for (const double bad : {std::nan(""), 0.0, -1.0, HUGE_VAL}) {
    for (const bool fromTheStart : {true, false}) {
      const MeasureFrame measure = [=](const WeatherDecision& d) {
        return std::optional(fromTheStart || std::isfinite(d.farM) ? bad : 12.0 + d.density * 4);
      };
      const StepCalibration c = calibrated(WeatherStep::snow_heavy, measure);
      EXPECT_EQ(c.outcome, CalibrationOutcome::not_a_number);
      TuningParameters p, before;
      apply(c, p);
      EXPECT_EQ(p.snowHeavy.farStretch, before.snowHeavy.farStretch);
      EXPECT_EQ(p.snowHeavy.density, before.snowHeavy.density);
    }
  }
}

TEST(Calibration, needsNoMoreTrialsForACloserToleranceThanItIsGiven) {
  std::size_t coarse = calibrated(WeatherStep::rain_heavy, exactly(Machine{}), 0.1).trials.size();
  std::size_t fine = calibrated(WeatherStep::rain_heavy, exactly(Machine{}), 0.001).trials.size();
  EXPECT_LT(coarse, fine);
  EXPECT_LE(fine, 2U + 12U);
}

}  // namespace
}  // namespace trimtab::test
