#include "trimtab/motion/head_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "trimtab/motion/line_of_sight.h"

namespace trimtab {
namespace {

/// A turn at exactly the threshold is slow, and ten steps of 10 ms are 100 ms, whatever rounding says.
constexpr double kRateSlack = 1e-9, kTimeSlackMs = 1e-6;

struct Direction {
  double headingDeg = 0, pitchDeg = 0;
};

Direction directionOf(const Attitude& aircraft, const std::optional<Attitude>& head,
                      MotionReference reference) {
  const Attitude a =
      reference == MotionReference::head ? head.value_or(Attitude{}) : lineOfSight(aircraft, head);
  return {a.heading.value(), a.pitch.value()};
}

/// Returns the larger of heading and pitch change, degrees; heading the short way round.
double changeBetween(const MotionMemory& before, const Direction& now) {
  double heading = now.headingDeg - before.headingDeg;
  // Nearly always it does not wrap, and the remainder takes longer than all else here.
  if (!(std::abs(heading) <= 180)) heading = wrapped180(Degrees{heading}).value();
  return std::max(std::abs(heading), std::abs(now.pitchDeg - before.pitchDeg));
}

void remember(MotionMemory& memory, double timeS, const Direction& direction) {
  memory.known = true;
  memory.timeS = timeS;
  memory.headingDeg = direction.headingDeg;
  memory.pitchDeg = direction.pitchDeg;
}

void push(MotionStack& stack, double ms, double changeDeg) {
  ++stack.frames;
  stack.ms += ms;
  stack.variationDeg += changeDeg;
}

bool blurStackIsFull(const MotionStack& stack, const MotionParameters& p) {
  return p.dwell == MotionDwell::frames ? stack.frames >= p.blurFrames.value()
                                        : stack.ms >= p.blurDwell.value() - kTimeSlackMs;
}

bool restoreStackIsFull(const MotionStack& stack, const MotionParameters& p) {
  return p.dwell == MotionDwell::frames ? stack.frames > p.restoreFrames.value()
                                        : stack.ms > p.restoreDwell.value() + kTimeSlackMs;
}

/// Returns the average rate of images that Eq. (1) divides by; unset if frames are states or the rate is not
/// known.
std::optional<double> drawnPerS(const MotionParameters& p, const DrawnLoad& drawn) {
  if (p.frames != MotionFrames::drawn || !drawn.framesPerS) return std::nullopt;
  return std::isfinite(*drawn.framesPerS) && *drawn.framesPerS > 0 ? drawn.framesPerS : std::nullopt;
}

/// Reports whether time and vertices ask for a coarser level. An unknown one does.
bool asksForCoarser(const MotionParameters& p, const DrawnLoad& drawn) {
  if (p.frames != MotionFrames::drawn) return true;
  const double ms = p.lodOverTime.value(), vertices = p.lodOverVertices.value();
  const std::optional<double> rate = drawnPerS(p, drawn);
  if (ms > 0 && rate && 1e3 / *rate <= ms) return false;
  return !(vertices > 0 && drawn.vertices && static_cast<double>(*drawn.vertices) <= vertices);
}

/// The share of its strength that a blur has which this run of fast frames starts. "The blur effect is
/// applied according to the change amount of the position values and the movement of the field of view speed"
/// (document C, section 3.2): the stack has accumulated the change, and over the run's time that is the
/// speed.
double blurShareOf(const MotionStack& run, const MotionParameters& p) {
  const double fullAtDegPerS = p.blurFullRate.value();
  if (!(fullAtDegPerS > 0)) return 1;
  return std::min(1.0, run.variationDeg / (run.ms * 1e-3) / fullAtDegPerS);
}

/// Counts a fast frame on BlurStack; a full one lowers the level and starts the blur.
MotionReason fastFrame(const MotionParameters& p, double ms, double changeDeg, const DrawnLoad& drawn,
                       MotionMemory& memory) {
  memory.restoreStack = {};
  push(memory.blurStack, ms, changeDeg);
  if (!blurStackIsFull(memory.blurStack, p)) return MotionReason::fast;
  memory.blurShare = blurShareOf(memory.blurStack, p);
  memory.blurStack = {};
  memory.blurRemainingMs = p.blurDuration.value();
  if (!asksForCoarser(p, drawn)) return MotionReason::kept;
  std::uint32_t lower = memory.level + 1;
  motionLodScale(p, lower);
  if (lower == memory.level) return MotionReason::lowest;
  memory.level = lower;
  return MotionReason::lowered;
}

/// Counts a slow frame on LODRestoreStack; a full one raises the level and stops the blur.
MotionReason slowFrame(const MotionParameters& p, double ms, double changeDeg, MotionMemory& memory) {
  memory.blurStack = {};
  if (p.control != MotionControl::with_restoration) {
    memory.restoreStack = {};
    return MotionReason::slow;
  }
  push(memory.restoreStack, ms, changeDeg);
  if (!restoreStackIsFull(memory.restoreStack, p)) return MotionReason::slow;
  memory.restoreStack = {};
  const bool blurred = memory.blurRemainingMs > 0;
  memory.blurRemainingMs = 0;
  if (memory.level > 0) {
    --memory.level;
    return MotionReason::raised;
  }
  return blurred ? MotionReason::blur_stopped : MotionReason::slow;
}

MotionReason nextFrame(const AircraftState& state, const MotionParameters& p, MotionMemory& memory,
                       const DrawnLoad& drawn, MotionDecision& decision) {
  const double timeS = drawn.eye ? drawn.eye->timeS : state.time;
  const Direction now = drawn.eye ? directionOf(drawn.eye->attitude, drawn.eye->head, p.reference)
                                  : directionOf(state.attitude, state.head, p.reference);
  if (!std::isfinite(timeS) || !std::isfinite(now.headingDeg) || !std::isfinite(now.pitchDeg))
    return MotionReason::invalid_input;
  const double seconds = timeS - memory.timeS;
  if (!memory.known || seconds < 0) {
    const bool first = !memory.known;
    memory = {};
    remember(memory, timeS, now);
    return first ? MotionReason::first_frame : MotionReason::time_back;
  }
  if (seconds == 0) return MotionReason::same_time;

  const double ms = seconds * 1e3;
  const bool blurred = memory.blurRemainingMs > 0;
  memory.blurRemainingMs = memory.blurRemainingMs > ms + kTimeSlackMs ? memory.blurRemainingMs - ms : 0;
  const double change = changeBetween(memory, now);
  remember(memory, timeS, now);
  if (ms > p.gap.value() + kTimeSlackMs) {
    memory.blurStack = memory.restoreStack = {};
    return MotionReason::gap;
  }
  const std::optional<double> average = drawnPerS(p, drawn);
  decision.rateDegPerS = average ? change * *average : change / seconds;
  decision.fast = decision.rateDegPerS > decision.thresholdDegPerS * (1 + kRateSlack);
  const MotionReason reason =
      decision.fast ? fastFrame(p, ms, change, drawn, memory) : slowFrame(p, ms, change, memory);
  const bool ended = blurred && memory.blurRemainingMs == 0;
  return ended && !changesState(reason) ? MotionReason::blur_ended : reason;
}

}  // namespace

double motionLodScale(const MotionParameters& parameters, std::uint32_t& level) {
  double scale = 1;
  std::uint32_t steps = 0;
  for (; steps < level && scale < parameters.lodMaximum.value(); ++steps) scale *= parameters.lodStep.value();
  level = steps;
  return std::min(scale, parameters.lodMaximum.value());
}

MotionDecision decideMotion(const AircraftState& state, const MotionParameters& p, MotionMemory& memory,
                            const DrawnLoad& drawn) {
  MotionDecision decision;
  if (p.control == MotionControl::off) {
    memory = {};
    return decision;
  }
  const bool inFrames = p.dwell == MotionDwell::frames;
  decision.thresholdDegPerS = (p.leftFov + p.rightFov).value();
  decision.limitsInMs = !inFrames;
  decision.blurLimit = inFrames ? p.blurFrames.value() : p.blurDwell.value();
  if (p.control == MotionControl::with_restoration)
    decision.restoreLimit = inFrames ? p.restoreFrames.value() : p.restoreDwell.value();

  decision.reason = nextFrame(state, p, memory, drawn, decision);
  decision.lodScale = motionLodScale(p, memory.level);
  decision.level = memory.level;
  decision.blurStack = memory.blurStack;
  decision.restoreStack = memory.restoreStack;
  const double strength = p.blurStrength.value() * memory.blurShare;
  if (memory.blurRemainingMs > 0 && strength > 0) decision.blur = {strength, memory.blurRemainingMs};
  return decision;
}

std::string_view toText(MotionReason reason) {
  switch (reason) {
    case MotionReason::off:
      return "off";
    case MotionReason::first_frame:
      return "first_frame";
    case MotionReason::invalid_input:
      return "invalid_input";
    case MotionReason::same_time:
      return "same_time";
    case MotionReason::slow:
      return "slow";
    case MotionReason::fast:
      return "fast";
    case MotionReason::time_back:
      return "time_back";
    case MotionReason::gap:
      return "gap";
    case MotionReason::lowered:
      return "lowered";
    case MotionReason::lowest:
      return "lowest";
    case MotionReason::kept:
      return "kept";
    case MotionReason::raised:
      return "raised";
    case MotionReason::blur_stopped:
      return "blur_stopped";
    case MotionReason::blur_ended:
      return "blur_ended";
  }
  return "";
}

bool changesState(MotionReason reason) {
  return reason > MotionReason::fast;
}

std::string explain(const MotionDecision& d) {
  const char* unit = d.limitsInMs ? "ms" : "frames";
  char text[200] = "";
  const auto write = [&](const char* format, auto... values) {
    std::snprintf(text, sizeof text, format, values...);
    return std::string(text);
  };
  const std::string rate = write("%.1f deg/s against %.1f", d.rateDegPerS, d.thresholdDegPerS);
  switch (d.reason) {
    case MotionReason::off:
      return "head motion is off";
    case MotionReason::first_frame:
      return "first state: nothing to compare with";
    case MotionReason::invalid_input:
      return "time or line of sight is not a number: passed over";
    case MotionReason::same_time:
      return "no time has gone by: passed over";
    case MotionReason::slow:
      return "slow: " + rate;
    case MotionReason::fast:
      return "fast: " + rate;
    case MotionReason::time_back:
      return "the host's clock went back: full detail, no blur, stacks empty";
    case MotionReason::gap:
      return "gap between states: stacks empty";
    case MotionReason::lowered:
      return write("fast for %g %s (", d.blurLimit, unit) + rate +
             write("): detail lowered, LOD scale %g, blur for %.0f ms", d.lodScale, d.blur.remainingMs);
    case MotionReason::lowest:
      return write("fast for %g %s (", d.blurLimit, unit) + rate +
             write("): LOD scale stays at its largest, %g, blur for %.0f ms", d.lodScale, d.blur.remainingMs);
    case MotionReason::kept:
      return write("fast for %g %s (", d.blurLimit, unit) + rate +
             write("): LOD scale stays at %g because of the load, blur for %.0f ms", d.lodScale,
                   d.blur.remainingMs);
    case MotionReason::raised:
      return write("slow for more than %g %s (", d.restoreLimit, unit) + rate +
             write("): detail raised, LOD scale %g, no blur", d.lodScale);
    case MotionReason::blur_stopped:
      return write("slow for more than %g %s (", d.restoreLimit, unit) + rate + "): blur stopped";
    case MotionReason::blur_ended:
      return "the blur's time is over: " + rate;
  }
  return "";
}

}  // namespace trimtab
