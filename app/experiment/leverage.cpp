#include "leverage.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "stage.h"
#include "trimtab/decision/decide.h"
#include "trimtab/fuzzy/bands.h"
#include "trimtab/measure/machine_watch.h"
#include "trimtab/measure/paired_ratio.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/error_meter.h"
#include "trimtab/session/session.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::experiment {
namespace {

constexpr double kImageS = 1.0 / 60;
/// Each moment has a lead of this length, seconds: head motion needs ten fast images for its first blur.
constexpr double kLeadS = 1.5;
constexpr double kSweepDegPerS = 180, kSweepToDeg = 90;
constexpr double kFogVisibilityM = 10000;

/// Returns the attitude of a head that turns from side to side at a constant rate.
Attitude sweptHead(double time) {
  const double turn = std::fmod(std::max(time, 0.0) * kSweepDegPerS, 4 * kSweepToDeg);
  return {Degrees{turn < 2 * kSweepToDeg ? turn - kSweepToDeg : 3 * kSweepToDeg - turn}, {}, {}};
}

Moment momentAt(const Setup& setup, const ValidatedParameters& parameters, double time, bool headSweeps) {
  Session session(parameters);
  session.setGround(setup.terrain);
  const double lead = std::min(kLeadS, time - setup.flight->beginS());
  const int images = static_cast<int>(std::floor(lead / kImageS));
  Moment moment;
  std::deque<FrameRequest> before;
  for (int i = images; i >= 0; --i) {
    AircraftState state = stateAt(*setup.flight, time - i * kImageS);
    if (headSweeps) state.head = sweptHead(state.time);
    session.fly(state, state.time);
    FrameRequest request = *session.request(state.time, setup.widthPx, setup.heightPx);
    if (i == 0) {
      const bool traces = blurs(request) || (!before.empty() && blurs(before.back()));
      const std::size_t kept = std::min<std::size_t>(before.size(), traces ? kLongestTrace : 1);
      moment.before.assign(before.end() - static_cast<std::ptrdiff_t>(kept), before.end());
      moment.request = std::move(request);
      break;
    }
    before.push_back(std::move(request));
    if (before.size() > kLongestTrace) before.pop_front();
  }
  return moment;
}

/// Moments in which a lever has something to do, and what was added so that it has.
struct Condition {
  std::string name;
  TuningParameters parameters;
  std::vector<Moment> moments;
};

/// An interval of too few frames is NaN, which is no number in a file either.
Estimate estimate(double median, double low, double high) {
  if (std::isfinite(low) && std::isfinite(high)) return {median, low, high};
  return {median, kNan, kNan};
}

Estimate estimate(const PairedDifference& d) {
  return estimate(d.median, d.low, d.high);
}

bool movesObjects(Lever lever) {
  return lever == Lever::object_error || lever == Lever::small_feature || lever == Lever::object_distance;
}

template <class Has>
bool any(const std::vector<Moment>& moments, const Has& has) {
  return std::any_of(moments.begin(), moments.end(), [&](const Moment& m) { return has(m.request); });
}

/// The measurement of one run.
class Run {
 public:
  Run(const Setup& setup, Stage& stage, scene::ErrorMeter& meter)
      : setup_(setup), stage_(stage), meter_(meter) {}

  Result<std::vector<LeverageRow>> all() {
    Condition plain{"", setup_.parameters, {}};
    plain.parameters.policy.enabled = false;
    if (Findings failed = make(plain, false); !failed.empty()) return failed;
    std::vector<LeverageRow> rows;
    for (const LeverRow& lever : kLeverRows) {
      // Nothing moves where nothing stands on the ground.
      if (movesObjects(lever.lever) && !setup_.terrain->objects()) continue;
      Condition own;
      if (Findings failed = conditionFor(lever.lever, plain, own); !failed.empty()) return failed;
      rows.push_back(measure(lever, own.moments.empty() ? plain : own));
      if (cancelled_) return cancelled();
      ++done_;
    }
    std::stable_sort(rows.begin(), rows.end(), [](const LeverageRow& a, const LeverageRow& b) {
      return a.wonMs.median > b.wonMs.median;
    });
    return rows;
  }

 private:
  Findings make(Condition& condition, bool headSweeps) {
    const Result<ValidatedParameters> valid = validate(condition.parameters);
    if (!valid) return valid.findings();
    condition.moments = momentsOf(setup_, *valid, headSweeps);
    if (condition.moments.empty()) return {notOverTerrain(setup_)};
    return {};
  }

  /// Leaves `own` without moments if the lever has something to do as it is.
  Findings conditionFor(Lever lever, const Condition& plain, Condition& own) {
    own.parameters = plain.parameters;
    WeatherParameters& weather = own.parameters.weather;
    MotionParameters& motion = own.parameters.motion;
    if (lever == Lever::particle_density &&
        !any(plain.moments, [](const auto& r) { return r.decision.weather.density > 0; })) {
      own.name = "medium rain";
      weather.source = WeatherSource::preset;
      weather.step = WeatherStep::rain_medium;
      return make(own, false);
    }
    if (lever == Lever::far_distance &&
        !any(plain.moments, [](const auto& r) { return std::isfinite(r.levers.weather.farM); })) {
      own.name = "fog, visibility 10 km";
      weather.source = WeatherSource::preset;
      weather.visibilityFrom = VisibilitySource::typed;
      weather.typedVisibility = Metres{kFogVisibilityM};
      weather.ratioMode = RatioMode::adaptive;
      return make(own, false);
    }
    if (lever == Lever::blur_strength && !any(plain.moments, blurs)) {
      own.name = "head sweeping at 180 deg/s";
      if (motion.control == MotionControl::off) motion.control = MotionControl::with_restoration;
      return make(own, true);
    }
    return {};
  }

  LeverageRow measure(const LeverRow& lever, const Condition& condition) {
    LeverageRow row;
    row.lever = lever.lever;
    row.condition = condition.name;
    row.from.value = lever.larger == CostOf::rises ? lever.usual.high : lever.usual.low;
    row.to.value = lever.larger == CostOf::rises ? lever.usual.low : lever.usual.high;
    Ends ends;
    for (std::size_t i = 0; i < condition.moments.size(); ++i) {
      const double part = (double(done_) + double(i) / double(condition.moments.size())) / double(kLevers);
      cancelled_ = setup_.progress && !setup_.progress(part, std::string(lever.label));
      if (cancelled_) return row;
      const auto at = [&](const FrameRequest& request, double value) {
        return withLever(request, lever.lever, value, condition.parameters);
      };
      measure(
          condition.moments[i], [&](const FrameRequest& r) { return at(r, row.from.value); }, ends.from);
      measure(
          condition.moments[i], [&](const FrameRequest& r) { return at(r, row.to.value); }, ends.to);
      time(condition.moments[i], at, row, i, ends);
    }
    finish(ends.from, row.from);
    finish(ends.to, row.to);
    row.wonMs = estimate(pairedDifference(ends.to.ms, ends.from.ms));
    const PairedRatio ratio = pairedRatio(ends.from.ms, ends.to.ms);
    row.wonPercent = estimate(100 * (1 - ratio.median), 100 * (1 - ratio.high), 100 * (1 - ratio.low));
    row.flipLost = estimate(pairedDifference(ends.from.flip, ends.to.flip));
    row.geometricPxLost = estimate(pairedDifference(ends.from.pixels, ends.to.pixels));
    row.flipLostPerMs = row.wonMs.low > 0 ? row.flipLost.median / row.wonMs.median : kNan;
    return row;
  }

  struct Series {
    std::vector<double> ms, flip, pixels;  ///< by frame
  };
  struct Ends {
    Series from, to;
  };

  /// Returns the error of a moment; what is left of earlier images counts only if it blurs.
  template <class Set>
  void measure(const Moment& moment, const Set& set, Series& series) {
    std::vector<FrameRequest> before;
    if (moment.before.size() > 1)
      for (const FrameRequest& request : moment.before) before.push_back(set(request));
    const FrameError error = meter_.measure(set(moment.request), before, nullptr);
    series.flip.push_back(error.flip);
    series.pixels.push_back(error.geometricMaxPx);
  }

  /// Both ends take turns, and each frame follows the one before it, so that it does the work that a flight
  /// asks of it.
  template <class At>
  void time(const Moment& moment, const At& at, const LeverageRow& row, std::size_t frame, Ends& ends) {
    const auto inFlight = [&](double value) {
      if (!moment.before.empty()) stage_.draw(at(moment.before.back(), value));
      return stage_.draw(at(moment.request, value)).cost.total;
    };
    inFlight(row.from.value);
    inFlight(row.to.value);
    std::vector<double> from, to;
    for (int repeat = 0; repeat < std::max(setup_.repeats, 1); ++repeat) {
      const bool swapped = (frame + static_cast<std::size_t>(repeat)) % 2 == 1;
      if (swapped) to.push_back(inFlight(row.to.value));
      from.push_back(inFlight(row.from.value));
      if (!swapped) to.push_back(inFlight(row.to.value));
    }
    ends.from.ms.push_back(quantileOf(from, 0.5));
    ends.to.ms.push_back(quantileOf(to, 0.5));
  }

  static void finish(const Series& series, LeverEnd& end) {
    end.ms = quantileOf(series.ms, 0.5);
    end.flipMedian = quantileOf(series.flip, 0.5);
    end.flipP95 = quantileOf(series.flip, 0.95);
    end.geometricPx = quantileOf(series.pixels, 1);
  }

  const Setup& setup_;
  Stage& stage_;
  scene::ErrorMeter& meter_;
  std::size_t done_ = 0;
  bool cancelled_ = false;
};

}  // namespace

FrameRequest withLever(FrameRequest request, Lever lever, double value, const TuningParameters& parameters) {
  FrameDecision& decision = request.decision;
  decision.policy.moved |= 1u << indexOf(lever);
  decision.policy.value[indexOf(lever)] = value;
  const BandList& bands = parameters.scheme.bands;
  if (lever == Lever::occlusion) setBand(decision, bands, bandOf(bands, value));
  request.levers = leversOf(decision, parameters);
  return request;
}

std::vector<Moment> momentsOf(const Setup& setup, const ValidatedParameters& parameters, bool headSweeps) {
  std::vector<double> over;
  for (const AircraftState& state : setup.flight->states)
    if (scene::liesOver(setup.terrain->info(), state.position)) over.push_back(state.time);
  const std::size_t count = std::min(over.size(), setup.frames);
  std::vector<Moment> moments;
  for (std::size_t k = 0; k < count; ++k)
    moments.push_back(momentAt(setup, parameters, over[(2 * k + 1) * over.size() / (2 * count)], headSweeps));
  return moments;
}

Result<Leverage> measureLeverage(const Setup& setup) {
  const MachineWatch watch;
  if (!setup.flight || setup.flight->states.empty())
    return Finding{Severity::error, "leverage", {}, "a flight over the terrain", "none"};
  auto stage = Stage::open(setup);
  if (!stage) return stage.findings();
  scene::ErrorMeter meter;
  if (const scene::GlReport gl = meter.initialize(); !gl.usable)
    return Finding{Severity::error, "OpenGL", {}, "what the renderer needs", gl.missing};
  meter.setTerrain(setup.terrain);
  auto rows = Run(setup, **stage, meter).all();
  meter.release();
  if (!rows) return rows.findings();
  Leverage leverage;
  leverage.rows = std::move(*rows);
  leverage.machine = (*stage)->machine();
  leverage.flight = setup.flight->name;
  leverage.terrain = setup.terrainName;
  leverage.preset = setup.presetName;
  leverage.frames = setup.frames;
  leverage.widthPx = setup.widthPx;
  leverage.heightPx = setup.heightPx;
  leverage.repeats = std::max(setup.repeats, 1);
  leverage.othersShare = watch.othersShare();
  return leverage;
}

void takeLosses(const Leverage& leverage, HoldParameters& hold) {
  for (const LeverageRow& row : leverage.rows) {
    Ratio* const loss = row.lever == Lever::screen_space_error ? &hold.lossError
                        : row.lever == Lever::render_scale     ? &hold.lossRenderScale
                        : row.lever == Lever::particle_density ? &hold.lossParticles
                        : row.lever == Lever::blur_strength    ? &hold.lossBlur
                                                               : nullptr;
    if (loss != nullptr && std::isfinite(row.flipLost.median))
      *loss = Ratio{std::clamp(row.flipLost.median, 0.0, 1.0)};
  }
}

}  // namespace trimtab::experiment
