#include "flight_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cost_fit.h"
#include "flight_rows.h"
#include "lever_places.h"
#include "trimtab/decision/decide.h"
#include "trimtab/hold/arbiter.h"
#include "trimtab/hold/frame_hold.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/session/session.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::tune {
namespace {

/// Knows the ground below the row in hand, which is all that a decision asks for.
class GroundOfRow final : public GroundHeights {
 public:
  explicit GroundOfRow(std::optional<Metres> highest) : highest_(highest) {}
  void set(const FlightRow& row) { row_ = &row; }
  std::optional<Metres> heightAt(Degrees, Degrees) const override {
    return row_ ? row_->ground : std::nullopt;
  }
  std::optional<Metres> highest() const override { return highest_; }

 private:
  std::optional<Metres> highest_;
  const FlightRow* row_ = nullptr;
};

/// The part of the triangles and instances of objects that smallest size and farthest distance leave.
struct Kept {
  double triangles = 1, instances = 1;
};
Kept keptOf(const FlightRow& row, const FrameLevers& levers, Places& places) {
  const Place &small = places.of(Loss::small_feature, levers.smallFeaturePx),
              &far = places.of(Loss::object_distance, levers.objectFarM);
  return {small.in(row.smallKept, 1) * far.in(row.objectsKept, 1),
          small.in(row.smallInstances, 1) * far.in(row.farInstances, 1)};
}

/// Holds what a row's decision and signals are before any rule.
struct Flown {
  FrameDecision decision;
  SignalValues signals;  ///< unknown if nobody asked
  bool viewMoved = false;
};

/// Reports whether a parameter moves the levers or says what is lost by them, so that the decision of a row
/// does not depend on it until rules come.
bool onlyMovesLevers(const ParameterRow& row) {
  for (const char* group : {"lod.", "objects.", "hold.", "policy.", "measure."})
    if (row.key.starts_with(group)) return true;
  return false;
}

}  // namespace

struct FlightModel::Impl {
  explicit Impl(ErrorKind errors) : kind(errors) {}
  const ErrorKind kind;
  /// Reports whether a preset's ground is drawn in the form that was counted.
  bool counts(const TuningParameters& parameters) const;
  LevelRule ruleOf(const TuningParameters& parameters) const;
  CountedFlight flight;
  std::optional<Metres> highest;
  FittedCost cost;
  /// Holds the part by which the fitted costs miss the samples' times: its median and its 90th percentile.
  struct Fit {
    double median = 0, p90 = 0;
  };
  Fit fit;
  double errorP90 = 0;  ///< the part by which errors of several levers miss what is estimated of them
  double errorOff(const DrawnSamples& samples) const;

  struct Image {
    double ms = 0, triangles = 0, error = 0;
  };
  /// What the arbiter of the budget remembers, and what it decided last.
  struct Holding {
    HoldMemory memory;
    HeldLevers last;
  };
  Image imageOf(const FlightRow& row, const FrameLevers& levers, const FrameDecision& decision,
                const LevelRule& rule, Places& places) const;
  HeldLevers hold(const FlightRow& row, const FrameLevers& asked, const FrameDecision& decision,
                  const TuningParameters& parameters, const LevelRule& rule, Places& places,
                  Holding& holding) const;

  /// What the rows are before any rule, by the parameters of the last estimate: presets of which only levers
  /// and rules differ share it.
  std::optional<TuningParameters> flownWith;
  std::vector<Flown> flown;
  bool signalsFlown = false;
  void fly(const ValidatedParameters& parameters);
  static double particlesOf(const FrameDecision& decision) {
    return decision.weather.precipitation == Precipitation::none ? 0 : decision.weather.density;
  }
};

/// Returns what an image under these levers takes and loses.
FlightModel::Impl::Image FlightModel::Impl::imageOf(const FlightRow& row, const FrameLevers& levers,
                                                    const FrameDecision& decision, const LevelRule& rule,
                                                    Places& places) const {
  Image image;
  Losses losses(row.atRest);
  const double loses = LevelRule::loses(levers, row.spreadLoses, places);
  const double groundPx = rule.groundPx(levers), objectPx = rule.objectPx(levers);
  const auto lose = [&](Loss loss, double value) {
    losses.add(places.of(loss, value).in(row.error[static_cast<std::size_t>(loss)], row.atRest));
  };
  const Kept kept = keptOf(row, levers, places);
  const auto counted = [&](LeverPlace& place, double px, const Counted& ladder) {
    const double all = place.at(px, Places::ladderPlace).in(ladder);
    if (levers.levelSpread == 1) return all;
    return all * LevelRule::kept(levers, ladderSteps(px), row.spreadKept, places);
  };
  const double objects = counted(places.objects, objectPx, row.objects) * kept.triangles;
  lose(Loss::ground_error, groundPx * loses);
  if (objects > 0) {
    lose(Loss::object_error, objectPx * loses);
    lose(Loss::small_feature, levers.smallFeaturePx);
    lose(Loss::object_distance, levers.objectFarM);
  }
  if (levers.renderScale < 1) lose(Loss::render_scale, levers.renderScale);
  image.triangles = counted(places.ground, groundPx, row.tiles) + objects;
  image.triangles *= levers.occlusion ? row.drawnHidden : row.drawnOpen;
  if (std::isfinite(levers.farM)) {
    const double part = levers.farM / decision.weather.farM;
    image.triangles *= places.of(Loss::far_distance, part).in(row.airKept, 1);
    lose(Loss::far_distance, part);
  }
  const double particles = particlesOf(decision) * levers.particleShare;
  if (levers.particleShare < 1 && particlesOf(decision) > 0) lose(Loss::particles, levers.particleShare);
  if (levers.blurStrength > 0) lose(Loss::blur, levers.blurStrength);
  const double area = levers.renderScale * levers.renderScale;
  const FrameLoad load{image.triangles, row.groundMpx * area, row.imageMpx * area, particles,
                       levers.blurStrength > 0};
  image.ms = cost(load, row.instances * kept.instances, levers.occlusion.has_value()) * row.costs;
  image.error = std::min(losses.error(), rowOf(kind).greatest);
  return image;
}

bool FlightModel::Impl::counts(const TuningParameters& parameters) const {
  FrameRequest request;
  request.terrain = parameters.terrain;
  return formDrawn(request, flight.forms) == flight.form;
}

LevelRule FlightModel::Impl::ruleOf(const TuningParameters& parameters) const {
  LevelRule rule{flight.form == TerrainForm::static_trees};
  if (rule.trees && parameters.staticLod.rule == StaticDistanceRule::factor)
    rule.fixedPx = flight.pixelsPerRadian / parameters.staticLod.distancePerError.value();
  const double spread = parameters.lod.spread.value(), fromM = parameters.lod.spreadFrom.value();
  rule.fromTimes = std::pow(fromM / flight.spreadFromM, 1 - 1 / spread);
  return rule;
}

/// Returns the levers to which the arbiter of the budget lowers a row's image.
HeldLevers FlightModel::Impl::hold(const FlightRow& row, const FrameLevers& asked,
                                   const FrameDecision& decision, const TuningParameters& parameters,
                                   const LevelRule& rule, Places& places, Holding& holding) const {
  HoldGiven given;
  given.timeS = row.input.state.time;
  given.budgetMs = parameters.measure.budget.value();
  given.asked = {asked.errorPx, asked.renderScale, asked.particleShare, 1};
  given.particles = particlesOf(decision) * asked.particleShare;
  given.blurs = asked.blurStrength > 0;
  given.imageMpx = row.imageMpx;
  given.groundMpx = row.groundMpx;
  const double drawn = asked.occlusion ? row.drawnHidden : row.drawnOpen;
  const double tiles = ladderSteps(rule.groundPx(asked)), objects = ladderSteps(rule.objectPx(asked));
  const auto counted = [&](double steps, const Counted& ladder) {
    return onLadder(steps).in(ladder)*LevelRule::kept(asked, steps, row.spreadKept, places);
  };
  const double toNext = placesToNext(asked.errorPx);
  const Kept kept = keptOf(row, asked, places);
  for (std::size_t k = 0; k < kErrorSteps; ++k) {
    const double coarser = k == 0 ? 0 : toNext + static_cast<double>(k - 1);
    given.triangles[k] = drawn * (counted(rule.fixedPx ? tiles : tiles + coarser, row.tilesAhead) +
                                  counted(objects + coarser, row.objectsAhead) * kept.triangles);
  }
  static_cast<ClockCoefficients&>(given.cost) = cost.coefficients;
  // The arbiter knows no instances: what they cost does not follow its levers.
  given.cost.other +=
      (asked.occlusion ? cost.lookingMs : 0) + cost.perInstance * row.instances * kept.instances;
  for (double ClockCoefficients::*part :
       {&ClockCoefficients::fixed, &ClockCoefficients::perTriangle, &ClockCoefficients::perGroundMpx,
        &ClockCoefficients::perParticles, &ClockCoefficients::perWeatherMpx, &ClockCoefficients::perBlurMpx,
        &ClockCoefficients::other})
    given.cost.*part *= row.costs;
  given.cost.known = true;
  // As in flight, the band is that of an image as it is likely to be drawn: with the levers of the last one.
  // The first image follows others that stayed within the budget too.
  const HeldLevers& likely = holding.memory.begun ? holding.last : given.asked;
  const double triangles =
      trianglesAt(given.triangles, asked.errorPx, std::max(likely.errorPx, asked.errorPx));
  double ms = predict(given.cost, loadOf(given, likely, triangles)).total();
  if (!holding.memory.begun) ms = std::min(ms, given.budgetMs);
  given.cost.halfBandMs = fit.p90 * ms;
  given.cost.offMs = fit.median * ms;
  return holding.last = arbitrate(given, parameters.hold, holding.memory).held;
}

FlightModel::FlightModel(const Scene& scene, const Flight& flight, const ValidatedParameters& start,
                         std::size_t drawn, ErrorKind kind)
    : impl_(std::make_unique<Impl>(kind)) {
  impl_->highest = scene.terrain->highest();
  impl_->flight = countFlight(scene, flight, start, kMostRows, drawn);
}

FlightModel::~FlightModel() = default;
FlightModel::FlightModel(FlightModel&&) noexcept = default;

const std::vector<SampleRow>& FlightModel::toDraw() const {
  return impl_->flight.toDraw;
}

double FlightModel::emptyMs() const {
  double most = 0;
  for (const FlightRow& row : impl_->flight.rows)
    most = std::max(most, impl_->cost({}, 0, false) * row.costs);
  return most;
}

void FlightModel::learn(const DrawnSamples& samples) {
  impl_->cost = fitCost(samples.images);
  // What a row costs more or less than the fit, as with clouds of small objects, is the row's own.
  std::vector<double> costs(samples.rows.size(), 1.0), off;
  for (std::size_t r = 0; r < samples.rows.size(); ++r) {
    std::vector<double> ratios, ofRepeats;
    for (const TimedImage& image : samples.images) {
      if (image.row != samples.rows[r].row) continue;
      const double fitted = impl_->cost(image.load, image.instances, image.looksForHidden);
      ratios.push_back(image.ms / fitted);
      for (const double ms : image.repeatsMs) ofRepeats.push_back(ms / fitted);
    }
    if (ratios.empty()) continue;
    costs[r] = rankOf(ratios, 0.5);
    // A budget is held among times as they come, not among the quickest.
    for (const double ratio : ofRepeats) off.push_back(std::abs(ratio / costs[r] - 1));
  }
  if (!off.empty()) impl_->fit = {rankOf(off, 0.5), rankOf(off, 0.9)};
  takeSamples(impl_->flight, impl_->kind, samples, costs);
  impl_->errorP90 = impl_->errorOff(samples);
}

/// Returns the part by which nine of ten errors of several levers miss at most what is estimated of them.
double FlightModel::Impl::errorOff(const DrawnSamples& samples) const {
  Places places;
  std::vector<double> off;
  for (std::size_t r = 0; r < samples.rows.size(); ++r) {
    const SampleRow& sample = flight.toDraw[r];
    const auto row = std::ranges::find(flight.rows, sample.row, &FlightRow::row);
    for (std::size_t setting = 0; setting < kTogether; ++setting) {
      const FrameLevers levers = together(sample.request, setting).levers.drawn;
      const LevelRule rule{flight.form == TerrainForm::static_trees};
      const double estimated = imageOf(*row, levers, sample.request.decision, rule, places).error;
      if (estimated > 0) off.push_back(std::abs(samples.rows[r].together[setting] / estimated - 1));
    }
  }
  return off.empty() ? 0 : rankOf(off, 0.9);
}

/// Decides the rows without rules, unless the parameters that count for it are those of the last time.
void FlightModel::Impl::fly(const ValidatedParameters& parameters) {
  const bool known = flownWith && (signalsFlown || parameters.policy() == nullptr);
  const auto differs = [&](const ParameterRow& row) {
    return !onlyMovesLevers(row) && row.get(*flownWith) != row.get(*parameters);
  };
  if (known && std::ranges::none_of(parameterRows(), differs)) return;
  TuningParameters unruled = *parameters;
  unruled.policy.enabled = false;
  const Result<ValidatedParameters> valid = validate(unruled);
  const auto ground = std::make_shared<GroundOfRow>(highest);
  Decider decider(valid ? *valid : parameters);
  decider.setGround(ground);
  signalsFlown = parameters.policy() != nullptr;
  // A watched decider also knows the height above ground, for which a rule may ask.
  if (signalsFlown) decider.watchSignals();
  flown.clear();
  flown.reserve(flight.rows.size());
  for (const FlightRow& row : flight.rows) {
    ground->set(row);
    FrameInput input = row.input;
    input.aboveGround = decider.groundBelow(input.state);
    input.highestGround = decider.highestGround();
    decider.forImage(std::move(input));
    flown.push_back({decider.decision(), decider.signalValues(), decider.signalTracker().viewMoved()});
  }
  flownWith = *parameters;
}

Estimate FlightModel::estimate(const ValidatedParameters& parameters, std::vector<RowEstimate>* rows) const {
  if (!impl_->counts(*parameters)) return {kNan, kNan, kNan, kNan, kNan};
  impl_->fly(parameters);
  const CompiledPolicy* const policy = parameters.policy();
  const double budgetMs = parameters->measure.budget.value();
  // A load that nobody asks for is not worth its median.
  const bool timed = policy != nullptr && policy->asks(Signal::load);
  DecisionMemory memory;
  Impl::Holding holding;
  ImageSignals images;
  Places places;
  const LevelRule rule = impl_->ruleOf(*parameters);
  std::vector<double> ms, errors;
  ms.reserve(impl_->flight.rows.size());
  errors.reserve(impl_->flight.rows.size());
  double sumMs = 0;
  for (std::size_t i = 0; i < impl_->flight.rows.size(); ++i) {
    const FlightRow& row = impl_->flight.rows[i];
    const Flown& flown = impl_->flown[i];
    FrameDecision decision = flown.decision;
    if (policy != nullptr) {
      SignalValues signals = flown.signals;
      if (flown.viewMoved) images.viewMoved();
      images.writeTo(signals);
      followPolicy(row.input.state.time, signals, parameters, memory, decision);
    }
    if (!row.over) continue;
    FrameLevers levers = askedLevers(decision, *parameters);
    if (parameters->hold.enabled)
      levers = withBudget(levers, impl_->hold(row, levers, decision, *parameters, rule, places, holding));
    const Impl::Image image = impl_->imageOf(row, levers, decision, rule, places);
    if (policy != nullptr)
      images.finished(timed ? image.ms : kNan, budgetMs, static_cast<std::uint64_t>(image.triangles));
    ms.push_back(image.ms);
    sumMs += image.ms;
    errors.push_back(image.error);
    if (rows != nullptr) rows->push_back({row.row, image.ms, image.error});
  }
  if (ms.empty()) return {};
  const double count = static_cast<double>(ms.size());
  return {
      rankOf(ms, 0.5), rankOf(ms, 0.95), rankOf(ms, 0.99), sumMs / count, errorOfImages(impl_->kind, errors),
      impl_->fit.p90,  impl_->errorP90};
}

}  // namespace trimtab::tune
