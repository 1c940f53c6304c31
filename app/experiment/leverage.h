#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "experiment.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/policy/levers.h"
#include "trimtab/policy/signals.h"

/// Measures what each lever of a policy is worth over a flight: milliseconds won against image lost.
namespace trimtab::experiment {

/// A median over the frames with the interval that holds the true one with 95 % confidence; ends that are NaN
/// say that the frames are too few for one.
struct Estimate {
  double median = 0, low = 0, high = 0;
};

/// One end of a lever's usual range, over all frames.
struct LeverEnd {
  double value = 0;
  double ms = 0;  ///< median
  double flipMedian = 0, flipP95 = 0;
  double geometricPx = 0;  ///< the largest of any frame
};

/// One lever, moved from the end that costs more time to the other, with all others at rest. A lever of
/// which neither end costs more by definition (CostOf::either) moves from its low end to its high one.
struct LeverageRow {
  Lever lever = Lever::occlusion;
  std::string condition;  ///< what was added so that the lever has something to do; empty: nothing
  LeverEnd from, to;
  Estimate wonMs, wonPercent;          ///< of the frame at `from`; negative where time is lost
  Estimate flipLost, geometricPxLost;  ///< of a frame
  double flipLostPerMs = 0;            ///< of the medians; NaN unless it is sure that time is won
};

struct Leverage {
  std::vector<LeverageRow> rows;  ///< the most milliseconds won first
  std::string machine, flight, terrain, preset;
  std::size_t frames = 0;
  int widthPx = 0, heightPx = 0, repeats = 0;
  /// Share of the machine that other programs used meanwhile, 0 to 1; NaN: unknown.
  double othersShare = std::numeric_limits<double>::quiet_NaN();
};

/// Returns the request with one lever set to a value, as a rule with that target would leave it.
FrameRequest withLever(FrameRequest request, Lever lever, double value, const TuningParameters& parameters);

/// A moment of a flight as a session asks for it, with the requests of the images before it, 1/60 s apart:
/// one, or as many as a blur can have traces of.
struct Moment {
  FrameRequest request;
  std::vector<FrameRequest> before;
};

/// Returns the moments at even rows of the flight above the terrain, each with a session of its own that has
/// flown the second and a half before it at 60 images a second. With `headSweeps`, the head turns 180 degrees
/// a second from side to side. No image is drawn, so a policy knows neither load nor triangles. Returns an
/// empty list if no row lies above the terrain.
std::vector<Moment> momentsOf(const Setup& setup, const ValidatedParameters& parameters, bool headSweeps);

/// Measures all levers over `setup.frames` frames of the flight. Each frame is drawn at both ends in turns,
/// `setup.repeats` times. A lever that has nothing to do in this flight is measured under the condition that
/// it is for, which its row names: medium rain, fog, a sweeping head.
Result<Leverage> measureLeverage(const Setup& setup);

/// Sets what the arbiter loses by each lever that it moves to the median FLIP that was lost; where nothing
/// was lost, to 0.
void takeLosses(const Leverage& leverage, HoldParameters& hold);

/// Returns `{leverage: [rows], machine, flight, terrain, preset, frames, ...}`; and the inverse.
std::string toJson(const Leverage& leverage);
Result<Leverage> parseLeverage(std::string_view json, const std::string& where);
/// Returns the rows as a table of people's words, with plots, for whoever shows experiments.
Report toReport(const Leverage& leverage);
/// Returns a page with the rows and, as bars with intervals, the milliseconds won, the FLIP lost and the
/// geometric pixels lost.
std::string pageOf(const Leverage& leverage);
/// Writes leverage.json, leverage.csv and leverage.html, each atomically.
Result<Done> writeLeverage(const std::filesystem::path& folder, const Leverage& leverage);

}  // namespace trimtab::experiment
