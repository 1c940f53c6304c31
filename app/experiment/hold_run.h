#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exposed_error.h"
#include "stage.h"
#include "trimtab/scene/error_meter.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/session/session.h"

/// Declares what the experiment and the benchmark of the budget share: flights that strain the frame, drawn
/// in four modes.
namespace trimtab::experiment {

/// States one image apart, with head and weather in them.
struct Strain {
  std::string name;
  std::vector<AircraftState> states;
  /// Images from here to `to` are those of the strain; those before warm up and those after rest.
  std::size_t from = 0, to = 0;
};

/// Returns the strain of a head that rests, turns 180 degrees in one second in steps of 1/200 s, and rests.
Strain sweepStrain(const GeodeticPosition& eye);
/// Returns a piece of the flight at 60 images a second, from its middle on, with the head of a log. Returns
/// nothing if the flight is not over the terrain there.
std::optional<Strain> headStrain(const Setup& setup, const HeadLog& head, double seconds);
/// Returns the same while the host turns the weather from clear to light rain, heavy rain, heavy snow and
/// clear again.
std::optional<Strain> weatherStrain(const Setup& setup, const HeadLog& head, double seconds);
/// Returns the same flight in clear air and with a head that rests.
std::optional<Strain> steadyStrain(const Setup& setup, double seconds);

enum class HoldMode { off, as_published, policy, hold };
inline constexpr std::array<const char*, 4> kHoldModes{"off", "as_published", "policy", "hold"};

/// Returns the preset in one mode: without head motion, far cut and policy; with documents C and D as
/// published, the effect for what falls included; with its policy, or that of the preset helmet-search if it
/// has none; and with the arbiter on top of its own policy, if it has one.
Result<ValidatedParameters> inMode(const TuningParameters& preset, HoldMode mode, double budgetMs);

/// Sets what the arbiter loses by each lever to what images of the strain show: the mean FLIP lost at 16 px
/// of allowed error, at half the render scale and without particles, as an engineer sets them by leverage
/// over the terrain in use. `asked` asks for the images.
void measureLosses(scene::ErrorMeter& meter, const Setup& setup, const ValidatedParameters& asked,
                   const Strain& strain, HoldParameters& hold);

/// Images between two questions whether to go on.
inline constexpr std::size_t kAskedStates = 40;

/// The error meter of an experiment that draws with several renderers, in a GL context of its own.
class Referee {
 public:
  static Result<std::unique_ptr<Referee>> open(const Setup& setup);
  ~Referee();
  Referee(const Referee&) = delete;
  Referee& operator=(const Referee&) = delete;
  /// Returns the meter with its context current.
  scene::ErrorMeter& meter();

 private:
  Referee() = default;
  std::unique_ptr<scene::Offscreen> offscreen_;
  scene::ErrorMeter meter_;
};

/// Holds what one mode drew, by image.
struct HoldRun {
  std::vector<double> ms;  ///< work time
  std::vector<double> errorPx, renderScale, particles;
  std::vector<double> limitMs;        ///< what the arbiter let a prediction reach; 0 without it
  std::vector<HoldOutcome> outcomes;  ///< of predictions three images ahead, of the strain's images
  std::vector<ExposedError> error;    ///< of the strain's images that were measured
  double lookMs = 0;                  ///< median time of session.request(), counting included
};

/// One way to fly a strain.
struct HoldFlight {
  ValidatedParameters parameters;
  std::optional<HeldLevers> fixed;  ///< in place of what the preset asks for
  std::size_t flipEvery = 0;        ///< of so many images of the strain one is measured; 0: none
};

/// Flies a strain in one mode, image by image, with a session of its own. Between two images it builds meshes
/// for coming ones, as the image generator does.
class HoldPilot {
 public:
  /// `stage` draws this mode alone, so that no other mode has built its levels. What is passed lives longer.
  HoldPilot(Stage& stage, Referee& referee, const Setup& setup, const HoldFlight& flight,
            const Strain& strain, const CostModel& model);
  /// Draws the next image of the strain.
  void drawNext();
  /// Measures the image that was drawn last, if its turn has come. It takes so long that it is for after all
  /// pilots of an image.
  void measure();
  /// Returns what was drawn so far.
  HoldRun run() const;
  /// Returns the model, which a later flight may begin with, as a program would load it.
  const CostModel& model() const { return session_.hold().model(); }

 private:
  Stage& stage_;
  Referee& referee_;
  const Setup& setup_;
  HoldFlight flight_;
  const Strain& strain_;
  Session session_;
  HoldRun run_;
  std::vector<double> lookMs_;
  std::vector<FrameRequest> drawn_;  ///< the last ones
  bool measures_ = false;            ///< the last one
  std::size_t next_ = 0;
};

/// Draws a whole strain with several pilots in turns, image by image, so that what else the machine does
/// meets all of them. Each has a stage of its own. Returns nothing if `go`, which is asked every kAskedStates
/// images, returns false.
std::optional<std::vector<HoldRun>> flyInTurns(std::span<HoldPilot* const> pilots, const Strain& strain,
                                               const std::function<bool(double part)>& go);
/// Does the same with one pilot.
std::optional<HoldRun> fly(HoldPilot& pilot, const Strain& strain,
                           const std::function<bool(double part)>& go);

}  // namespace trimtab::experiment
