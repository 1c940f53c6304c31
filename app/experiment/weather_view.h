#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stage.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/hold/frame_hold.h"
#include "trimtab/measure/paired_ratio.h"
#include "trimtab/weather/calibrate.h"
#include "trimtab/weather/weather.h"

/// Declares what the experiments of document D share: a view whose weather and vertices are set, and the rows
/// of its table.
namespace trimtab::experiment {

/// Rain or snow, with its steps by density.
struct Fall {
  const char* name;
  std::array<WeatherStep, 4> steps;
};
inline constexpr std::array<const char*, 4> kDensities{"clear", "light", "medium", "heavy"};
inline constexpr std::array<Fall, 2> kFalls{
    {{"rain",
      {WeatherStep::clear, WeatherStep::rain_light, WeatherStep::rain_medium, WeatherStep::rain_heavy}},
     {"snow",
      {WeatherStep::clear, WeatherStep::snow_light, WeatherStep::snow_medium, WeatherStep::snow_heavy}}}};

/// A view from 2,000 ft above the highest ground around the experiment's place, of the preset without head
/// motion.
class WeatherView {
 public:
  static constexpr double kEyeFt = 2000;
  /// The vertices in view are reached within this share.
  static constexpr double kWithin = 0.05;

  static Result<std::unique_ptr<WeatherView>> open(const Setup& setup);

  /// Returns the preset without head motion.
  const TuningParameters& preset() const { return preset_; }
  std::string machine() const { return stage_->machine(); }

  /// Sets the screen-space error, in pixels, at which so many vertices are in view in clear air, and returns
  /// it. `reached` receives the vertices that the terrain gives there.
  double reach(double vertices, double& reached);
  /// Sets the screen-space error of tiled levels and of static trees, in pixels.
  void setError(double px);
  /// Returns the median work time of a frame with this weather, milliseconds.
  double ms(const WeatherDecision& weather);
  /// Draws frames of each weather in turns, so often that pairs of turns have an interval. No weather is
  /// always first. Returns the medians of the turns for each weather, milliseconds of work.
  std::vector<std::vector<double>> inTurns(std::span<const WeatherDecision> weathers);
  /// Holds what the arbiter made of a frame.
  struct Held {
    PairedRatio ofClear;  ///< its work time over that of the clear frame
    HeldLevers levers;
    HoldReason reason = HoldReason::off;  ///< of the last image
  };
  /// Lets the arbiter hold the median frame of this weather to `overClear` times the clear frame. Once it has
  /// settled, some held and some clear frames are drawn in turns and compared. Either kind has a renderer of
  /// its own, so that neither finds the other's levels.
  Held held(const WeatherDecision& weather, double overClear);
  /// Returns the vertices in view in clear air.
  double vertices();
  /// Returns what the far cut of the weather changes in the image.
  scene::CutError cutError(const WeatherDecision& weather);

 private:
  WeatherView() = default;
  void setWeather(const WeatherDecision& weather);
  /// Draws so many frames with this weather, and some before that do not count; returns their work times.
  std::vector<double> drawn(const WeatherDecision& weather, int frames);

  TuningParameters preset_;
  std::unique_ptr<Stage> stage_, heldStage_;
  int repeats_ = 1;
  FrameRequest request_;
  FrameHold hold_;
};

/// Calibrates one step of the preset on the view (document D's steps 1 to 4); nothing if `go` returns false.
std::optional<StepCalibration> calibrateOn(WeatherView& view, const Setup& setup,
                                           const TuningParameters& parameters, WeatherStep step,
                                           int mostTrials, const std::function<bool()>& go);
/// Reports whether no cut wins back what falls.
bool costsTooMuch(const StepCalibration& found);
/// Returns the parameters with the calibrated far plane; where no cut is enough, with the strongest one at
/// the preset's density.
TuningParameters tunedBy(const StepCalibration& found, const TuningParameters& parameters);

/// Returns the length of the terrain from corner to corner, metres: a cut there cuts nothing.
double farthestM(const Setup& setup);

/// Returns the decision for a weather step of the preset.
WeatherDecision weatherOf(const TuningParameters& parameters, WeatherStep step, RatioMode mode);

/// Reports whether two decisions for one step draw the same, so that their times differ by noise alone: one
/// far plane, to a millimetre, and as many particles.
bool isOneSetting(const WeatherDecision& a, const WeatherDecision& b);

}  // namespace trimtab::experiment
