#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "quad.h"
#include "table.h"
#include "trimtab/decision/decide.h"
#include "trimtab/fuzzy/bands.h"
#include "trimtab/host/decoder.h"
#include "trimtab/host/ground_velocity.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/motion/head_motion.h"

namespace trimtab::stress {
namespace {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  double signedUnit() { return 2 * unit() - 1; }
  bool one(double chance) { return unit() < chance; }
  int below(int n) { return static_cast<int>(unit() * n); }

 private:
  std::mt19937_64 random_;
};

/// Document C's optimizer once more, from its description: whole milliseconds, so that no time rounds.
struct MotionTwin {
  const MotionParameters& p;
  long long timeMs = 0, blurMs = 0, restoreMs = 0, blurRemainingMs = 0;
  bool known = false;
  Quad heading = 0, pitch = 0, blurDeg = 0, restoreDeg = 0;
  unsigned blurFrames = 0, restoreFrames = 0, level = 0;

  unsigned coarsest() const {
    unsigned steps = 0;
    for (Quad scale = 1; scale < p.lodMaximum.value(); scale *= p.lodStep.value()) ++steps;
    return steps;
  }
  void clearBlur() { blurFrames = 0, blurMs = 0, blurDeg = 0; }
  void clearRestore() { restoreFrames = 0, restoreMs = 0, restoreDeg = 0; }

  void next(long long ms, double headingDeg, double pitchDeg) {
    const long long step = ms - timeMs;
    if (known && step == 0) return;
    const bool anew = !known || step < 0;
    const Quad turn =
        std::max(fabsq(remainderq(Quad{headingDeg} - heading, 360)), fabsq(Quad{pitchDeg} - pitch));
    known = true, timeMs = ms, heading = headingDeg, pitch = pitchDeg;
    if (anew) {
      clearBlur(), clearRestore();
      level = 0, blurRemainingMs = 0;
      return;
    }
    blurRemainingMs = std::max(blurRemainingMs - step, 0LL);
    if (Quad(step) > p.gap.value()) return clearBlur(), clearRestore();
    const bool inFrames = p.dwell == MotionDwell::frames;
    if (turn * 1000 > Quad((p.leftFov + p.rightFov).value()) * step) {
      clearRestore();
      ++blurFrames, blurMs += step, blurDeg += turn;
      if (inFrames ? blurFrames < p.blurFrames.value() : Quad(blurMs) < p.blurDwell.value()) return;
      clearBlur();
      blurRemainingMs = static_cast<long long>(p.blurDuration.value());
      level = std::min(level + 1, coarsest());
      return;
    }
    clearBlur();
    if (p.control != MotionControl::with_restoration) return clearRestore();
    ++restoreFrames, restoreMs += step, restoreDeg += turn;
    if (inFrames ? restoreFrames <= p.restoreFrames.value() : Quad(restoreMs) <= p.restoreDwell.value())
      return;
    clearRestore();
    blurRemainingMs = 0;
    if (level > 0) --level;
  }
};

MotionParameters randomMotion(Dice& dice) {
  MotionParameters p;
  p.control = dice.one(0.7) ? MotionControl::with_restoration : MotionControl::lod_scale_and_blur;
  p.dwell = dice.one(0.5) ? MotionDwell::frames : MotionDwell::milliseconds;
  p.leftFov = Degrees{1.0 + dice.below(90)}, p.rightFov = Degrees{1.0 * dice.below(90)};
  p.blurFrames = Ratio{1.0 + dice.below(12)}, p.restoreFrames = Ratio{1.0 * dice.below(12)};
  p.blurDwell = Milliseconds{1.0 * dice.below(150)}, p.restoreDwell = Milliseconds{1.0 * dice.below(150)};
  p.lodStep = Ratio{1.01 + 3 * dice.unit()}, p.lodMaximum = Ratio{1 + 20 * dice.unit()};
  p.blurDuration = Milliseconds{1.0 * dice.below(900)};
  p.gap = Milliseconds{60.0 + dice.below(400)};
  return p;
}

TEST(ControllerStress, headMotionFollowsItsTwinUnderRandomLoad) {
  Dice dice(31);
  const std::size_t runs = samples(20, 400), steps = 50000;
  Case states("head motion", "level and stacks against the twin, 1e6 states", 0, "differences",
              "the same counts: no time and no angle of the load lies within the stated slack of a limit");
  Case times("head motion", "time in stacks and of the blur against the twin", 1e-6, "ms",
             "1,000 sums of steps of which each is off by two roundings of a time below 1e5 s; "
             "head_motion.cpp allows 1e-6 ms");
  Case scale("head motion", "LOD scale within 1 and its maximum", 0, "violations",
             "steps away from full detail, held at the maximum");
  Case angles("head motion", "angle in stacks against the twin", 1e-9, "deg",
              "1,000 sums of up to 180 degrees, each good to 2^-45 of a degree");
  for (std::size_t run = 0; run < runs; ++run) {
    const MotionParameters p = randomMotion(dice);
    MotionTwin twin{p};
    MotionMemory memory;
    long long ms = 0;
    double rate = 0, heading = 0, pitch = 0;
    for (std::size_t i = 0; i < steps; ++i) {
      if (dice.one(0.03)) rate = dice.one(0.5) ? 0 : dice.signedUnit() * 3 * (p.leftFov + p.rightFov).value();
      const long long step = dice.one(0.002)  ? -dice.below(1000)
                             : dice.one(0.01) ? dice.below(1000)
                                              : 1 + dice.below(40);
      ms = std::max(ms + step, 0LL);
      // Tenths of a degree a second away from the threshold, so that rounding decides nothing.
      const double limit = (p.leftFov + p.rightFov).value();
      if (std::abs(std::abs(rate) - limit) < 0.1) rate += 0.5;
      heading = wrapped180(Degrees{heading + rate * static_cast<double>(std::max(step, 0LL)) * 1e-3}).value();
      if (dice.one(0.1)) pitch = std::clamp(pitch + 0.001 * dice.signedUnit(), -89.0, 89.0);
      AircraftState s;
      s.time = static_cast<double>(ms) * 1e-3;
      s.attitude = {Degrees{heading}, Degrees{pitch}, Degrees{0}};
      const MotionDecision d = decideMotion(s, p, memory);
      twin.next(ms, heading, pitch);
      states.require(
          memory.level == twin.level && memory.blurStack.frames == twin.blurFrames &&
              memory.restoreStack.frames == twin.restoreFrames,
          [&] { return "run " + std::to_string(run) + ", state " + std::to_string(i) + ": " + explain(d); });
      times.see(std::abs(memory.blurRemainingMs - static_cast<double>(twin.blurRemainingMs)));
      times.see(std::abs(memory.blurStack.ms - static_cast<double>(twin.blurMs)));
      times.see(std::abs(memory.restoreStack.ms - static_cast<double>(twin.restoreMs)));
      angles.see(distance(memory.blurStack.variationDeg, twin.blurDeg));
      angles.see(distance(memory.restoreStack.variationDeg, twin.restoreDeg));
      scale.require(d.lodScale >= 1 && d.lodScale <= p.lodMaximum.value());
    }
  }
}

TEST(ControllerStress, constantInputSettles) {
  Dice dice(32);
  Case level("controllers", "changes of level and LOD scale under a constant turn, once settled", 0,
             "changes", "no limit cycle: one decision for one input");
  Case scheme("controllers", "changes of band and weather under a constant state, once settled", 0, "changes",
              "no limit cycle: one decision for one input");
  Case noise("controllers", "changes of band under noise of less than the hysteresis, once settled", 0,
             "changes",
             "from the edge + h that made the band, noise of 2h cannot reach the edge - h below it");
  for (std::size_t run = 0; run < samples(300, 5000); ++run) {
    TuningParameters t;
    t.motion = randomMotion(dice);
    const double limit = (t.motion.leftFov + t.motion.rightFov).value();
    const double rate =
        dice.one(0.5) ? limit * (1 + 0.01 * dice.unit()) + 1e-3 : limit * (0.99 * dice.unit());
    const double begin = dice.one(0.5) ? 0 : 1e6 * dice.unit(), altitude = 12000 * dice.unit();
    const auto parameters = validate(t);
    ASSERT_TRUE(parameters) << toString(parameters.findings());
    DecisionMemory memory;
    std::optional<FrameDecision> last;
    for (int i = 0; i < 3000; ++i) {
      FrameInput in;
      in.state.time = begin + i / 60.0;
      in.state.position.height = Feet{altitude}.as<Metres>();
      in.state.attitude = {wrapped360(Degrees{rate * i / 60.0}), Degrees{altitude / 200 - 30}, Degrees{0}};
      const FrameDecision d = decide(in, *parameters, memory);
      if (i > 2500) {
        level.require(d.motion.level == last->motion.level && d.motion.lodScale == last->motion.lodScale,
                      [&] { return "rate " + digits(rate) + " against " + digits(limit); });
        scheme.require(d.band == last->band && d.scheme == last->scheme && d.weather == last->weather);
      }
      last = d;
    }
    const double h = 0.001 + 0.04 * dice.unit(), centre = 0.05 + 1.9 * dice.unit();
    std::optional<int> band;
    int changes = 0, settled = 0;
    for (int i = 0; i < 4000; ++i) {
      const int next = nextBand(kDepthMapBands, h, centre + 0.99 * h * dice.signedUnit(), band).band;
      if (i > 2000 && next != *band) ++changes;
      settled += i > 2000;
      band = next;
    }
    noise.require(settled > 0 && changes == 0, [&] { return digits(centre); });
  }
}

TEST(ControllerStress, statisticsAreThoseOfTheLastFrames) {
  Dice dice(33);
  constexpr std::size_t kWindow = 600;
  Case mean("statistics", "mean of a window after 1e6 frames, relative", (kWindow + 1) * kU, "",
            "600 sums of positive terms and the quotient: no sum runs on from window to window");
  Case order("statistics", "median, p95, p99 and largest", 0, "differences",
             "they are samples: nearest rank of the last 600");
  SampleWindow window(kWindow);
  std::vector<double> all;
  for (std::size_t i = 0; i < samples(1000000, 20000000); ++i) {
    double cost = 16.7 * std::pow(10, 3 * dice.signedUnit());
    if (dice.one(0.01)) cost = dice.one(0.5) ? std::nan("") : HUGE_VAL;
    window.add(cost);
    if (std::isfinite(cost)) all.push_back(cost);
    // Fewer have no 99th percentile.
    if (i % 5003 != 0 || all.size() < 100) continue;
    if (all.size() > 4 * kWindow) all.erase(all.begin(), all.end() - kWindow);
    std::vector<double> last(all.size() > kWindow ? all.end() - kWindow : all.begin(), all.end());
    Quad sum = 0;
    for (const double x : last) sum += x;
    mean.see(relative(window.mean(), sum / static_cast<Quad>(last.size())));
    std::sort(last.begin(), last.end());
    const auto rank = [&](int percent) {
      return last[(last.size() * static_cast<std::size_t>(percent) + 99) / 100 - 1];
    };
    order.require(window.median() == rank(50) && window.quantile(0.95) == rank(95) &&
                  window.quantile(0.99) == rank(99) && window.largest() == last.back());
  }
}

TEST(ControllerStress, theEyeStaysWhereAnAircraftCanBe) {
  Dice dice(34);
  Case eye("extrapolation", "pose of the eye is finite, angles in range", 0, "violations",
           "whatever times and places come, what is drawn is a place and an attitude");
  Case reach("extrapolation", "distance of the eye from the last state", 1400 * 0.5 + 20 / 0.005 * 0.5, "m",
             "half a second of the load's 1,400 m/s, and of 20 m of noise in height over the shortest "
             "baseline, 5 ms");
  Case still("extrapolation", "drift of the eye of an aircraft at rest", 1e-8, "m",
             "a place there and back: 10 nm (geodesy.h)");
  Extrapolator moving, resting;
  GroundVelocity velocity;
  AircraftState state;
  state.position = {Degrees{89.9}, Degrees{179.99}, Metres{3000}};
  const AircraftState rest = state;
  double speed = 100;
  for (std::size_t i = 0; i < samples(100000, 5000000); ++i) {
    if (dice.one(0.01)) speed = 1400 * dice.unit();
    const double step = dice.one(0.02)   ? 0
                        : dice.one(0.02) ? -dice.unit()
                        : dice.one(0.01) ? 10 * dice.unit()
                                         : 0.004 + 0.03 * dice.unit();
    state.time += step;
    const LocalFrame here(state.position);
    state.position = here.toGeodetic({0.7 * speed * step, 0.7 * speed * step, 0});
    state.position.height = Metres{3000 + 10 * dice.signedUnit()};
    state.attitude = {Degrees{360 * dice.unit()}, Degrees{90 * dice.signedUnit()},
                      Degrees{180 * dice.signedUnit()}};
    if (dice.one(0.3))
      state.head = Attitude{Degrees{180 * dice.signedUnit()}, Degrees{90 * dice.signedUnit()}, Degrees{0}};
    moving.push(state);
    velocity.push(state);
    const AircraftState at = moving.at(state.time + 2 * dice.unit(), 0.5);
    const double moved = length(toEcef(at.position) - toEcef(state.position));
    reach.see(moved);
    eye.require(std::isfinite(moved) && at.attitude.heading.value() >= 0 &&
                at.attitude.heading.value() < 360 && std::abs(at.attitude.pitch.value()) <= 90 &&
                std::abs(at.attitude.roll.value()) <= 180);
    if (const auto v = velocity.velocity())
      eye.require(std::isfinite(v->north.value() + v->east.value() + v->down.value()));
    AircraftState same = rest;
    same.time = static_cast<double>(i) / 60;
    resting.push(same);
    still.see(length(toEcef(resting.at(same.time + 0.5, 0.5).position) - toEcef(rest.position)));
  }
}

}  // namespace
}  // namespace trimtab::stress
