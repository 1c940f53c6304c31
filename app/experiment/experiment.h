#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "report.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/head_log.h"
#include "trimtab/preset/table.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/weather/calibrate.h"

/// The published experiments over any terrain, flight and preset. Each needs no window; it makes a GL context
/// of its own, current on the calling thread.
namespace trimtab::experiment {

/// Holds what the experiment on the budget flies.
struct HoldSetup {
  std::optional<HeadLog> head;     ///< if unset, a scripted sweep
  std::optional<double> budgetMs;  ///< if unset, 0.6 of the median image of mode *off*
  double flightS = 6;              ///< seconds of the flight, from its middle
  /// A word from the name of the one strain to fly: "sweep", "head log", "weather" or "steady". If empty, all
  /// strains are flown.
  std::string strain;
  bool fixedSettings = false;  ///< also flies fixed settings, in turns with mode *hold*
};

struct Setup {
  std::shared_ptr<const terrain::Database> terrain;
  std::string terrainName;
  std::optional<Flight> flight;  ///< the places to look from; if unset, the experiment chooses them
  TuningParameters parameters;
  std::string presetName;
  int widthPx = 1280, heightPx = 720;
  HoldSetup hold;
  int repeats = 3;          ///< frames per view, of which the median counts; passes, for head motion
  std::size_t frames = 24;  ///< moments of the flight, for leverage
  double hostRateHz = 200;  ///< states a second, for the experiments on head motion
  /// Called now and then; returning false cancels.
  std::function<bool(double fraction, const std::string& what)> progress;
};

/// Documents A and B: none, view frustum and proposed (by the depth map) at 2,000 to 8,000 ft, and the fourth
/// case *ours*: the same decision, served by the horizon. All draw tiles. The named altitude feeds the
/// decision; the eye is that far above the highest ground within 2 km. Triangles and vertices are means
/// over the views, milliseconds medians. Every image is compared with the unculled one.
Result<Report> runCulling(const Setup& setup);

/// Document A's loop over nodes (Figure 2), in which each is decided by its distance from the eye, beside the
/// one decision a frame that the program makes: over tiles, and over static trees where the database has
/// them.

/// Document C: 180 degrees in one second at 200 images a second, as it was, with LOD scale and blur, and with
/// restoration. It runs over the preset's form of the terrain, over tiled levels, and over static trees where
/// the database has them, and says for each whether the gain holds.
Result<Report> runHeadMotion(const Setup& setup);
/// Document C, Figures 9 and 10: the same for a motion of varying speed, in heading and in pitch.
Result<Report> runHeadMotionVarying(const Setup& setup);

/// Document D: three vertex counts in view, reached within 5 % by the screen-space error, times four
/// densities of rain and of snow; the fixed ratio against the calibrated one.
Result<Report> runWeather(const Setup& setup);

/// Document D as it was published: ratios calibrated at 140,000 vertices and applied at 140,000, 120,000 and
/// 100,000, and those of 100,000 applied at 140,000, so that shortfall and over-frame appear.
Result<Report> runWeatherProtocol(const Setup& setup);

/// Document D's four steps without a window: calibrates steps of the preset on one view.
struct WeatherCalibration {
  std::vector<WeatherStep> steps;  ///< none of them clear
  std::optional<double>
      vertices;         ///< in view, reached by the screen-space error; if unset, as the preset draws
  int mostTrials = 12;  ///< far planes or densities tried for each step
};
struct CalibratedWeather {
  std::vector<StepCalibration> steps;
  double vertices = 0;  ///< in view in clear air
};
Result<CalibratedWeather> calibrateWeather(const Setup& setup, const WeatherCalibration& wanted);

/// Measures what documents C and D leave open: a head sweep, a flight with a head log, one through changing
/// weather and a steady one, in the modes *off*, *as published*, *policy* and *hold*, under a budget of 0.6
/// of the median image of *off*.
Result<Report> runHold(const Setup& setup);

/// Document E: the tile nearest to the published triangles, built with the published n. Needs scenery.
Result<Report> runStaticLod(const Setup& setup);

}  // namespace trimtab::experiment
