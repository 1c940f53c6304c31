#pragma once

#include <string>

#include "trimtab/frame/hold_decision.h"
#include "trimtab/hold/cost_model.h"
#include "trimtab/hold/load_counter.h"
#include "trimtab/preset/parameters.h"
#include "trimtab/units/not_finite.h"

/// Keeps the predicted time of each image within the budget.
///
/// **Lower at once**, to the setting of the levers that loses least among those that fit. **Restore only**
/// after a finer setting has been predicted to fit, with a reserve, for hold.calm_ms without interruption,
/// and its meshes are built (Renderer::buildAhead), for which the allowed error waits at most two seconds.
/// Lowering leaves the same reserve, so there is nothing to go back and forth between. A setting with another
/// allowed error exchanges levels of detail, so it counts as losing more.
///
/// First, do no harm: while predictions are far off, and where lowering would win next to nothing, the levers
/// stay as they are asked for.
///
/// Prediction comes first and measurement only corrects the model: Funkhouser and Sequin, "Adaptive Display
/// Algorithm for Interactive Frame Rates During Visualization of Complex Virtual Environments", SIGGRAPH
/// 1993. Their benefit of an object is here the loss of the image, in the mean FLIP that leverage measures.
namespace trimtab {

/// Holds everything that an image's arbitration depends on beside its memory, as plain numbers.
struct HoldGiven {
  double timeS = 0;  ///< on the clock of the states
  double budgetMs = 0;
  HeldLevers asked;            ///< by preset and policy
  double particles = 0;        ///< amount of what falls (fallsNow) times asked.particleShare
  bool blurs = false;          ///< head motion asks for blur
  double imageMpx = 0;         ///< millions of pixels of the image
  double groundMpx = 0;        ///< of those, millions below the horizon; the most of the views counted
  TriangleLadder triangles{};  ///< by allowed error; the most of the views counted
  double meshesLeft = 0;       ///< named by FrameHold::nodesAhead, that there was no time to build
  CostCoefficients cost;
};

/// Says where the levers are. The allowed error is at what is asked for (0) or at a place of a fixed scale
/// (kFirstErrorPx), so that it rests while what is asked for moves below it. The others are steps down from
/// what is asked for.
struct HoldSteps {
  std::uint8_t error = 0, renderScale = 0, particles = 0, blur = 0;
  friend bool operator==(const HoldSteps&, const HoldSteps&) = default;
};

/// Holds what one image's arbitration remembers for the next.
struct HoldMemory {
  HoldSteps steps;
  double timeS = 0;   ///< of the last image
  double calmMs = 0;  ///< how long there has been head-room
  bool begun = false;
  bool distrusts = false;        ///< predictions have been too far off
  std::uint8_t wantedError = 0;  ///< the place of the allowed error that there is head-room for
  double waitedMs = 0;           ///< how long that has waited for its meshes
};

/// Decides the levers of one image. It is pure but for `memory`, and allocates nothing. If the budget or the
/// cost is unknown, the levers stay as they are asked for. Time that stands, goes back or is not a number
/// counts as no time.
HoldDecision arbitrate(const HoldGiven& given, const HoldParameters& parameters, HoldMemory& memory);

/// Returns how long an image may have an effect on later decisions, milliseconds.
double rememberedMs(const HoldParameters& parameters);

/// Returns the allowed error at a place of HoldSteps::error, pixels.
double errorAtPlace(std::uint8_t place, double askedPx);

/// Returns the triangles at an allowed error, exact on the ladder's steps. Between two steps they lie on a
/// straight line over the error's logarithm. Below and above the ladder they are those of its ends.
double trianglesAt(const TriangleLadder& ladder, double askedPx, double errorPx);

/// Returns the part of the loss from 1 to 16 px that lies between two errors, of which the first may not be
/// smaller. The power is that of FLIP over Kansai, which rises by 0.0025, 0.011 and 0.033 from 1 px to 2, 4
/// and 8 px.
double errorLoss(double errorPx, double freePx);

/// Returns the part of the loss from full scale to half. Any smaller scale blurs the finest detail at once:
/// 0.7 already loses two thirds of what 0.5 does.
double scaleLoss(double scale, double fullScale);

/// Returns the load of an image under these levers.
FrameLoad loadOf(const HoldGiven& given, const HeldLevers& levers, double triangles);

/// What lowering one lever takes off an image, and what the image loses by it.
struct LeverGain {
  double ms = 0;    ///< of the predicted time
  double loss = 0;  ///< mean FLIP, as the parameters rate the lever
  friend bool operator==(const LeverGain&, const LeverGain&) = default;
};

struct HoldGains {
  LeverGain error, renderScale, particles, blur;
  friend bool operator==(const HoldGains&, const HoldGains&) = default;
};

/// Returns what each lever of a decision gives; all 0 while none is lowered. The times of all levers add up
/// to askedMs - heldMs: each has a part of that by what it takes off alone. `given` and `parameters` are
/// those of the decision.
HoldGains gainsOf(const HoldGiven& given, const HoldDecision& decision, const HoldParameters& parameters);

/// Returns the decision in words and numbers, on one line.
std::string explain(const HoldDecision& decision);

}  // namespace trimtab
