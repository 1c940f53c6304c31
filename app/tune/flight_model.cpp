#include "flight_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cost_fit.h"
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

/// Holds what the model knows of one row of a flight.
struct Row {
  std::size_t row = 0;  ///< of the flight
  /// Its state, with the velocity that follows from those before; the ground is asked for by each preset.
  FrameInput input;
  std::optional<Metres> ground;  ///< height of the ground below
  bool over = false;             ///< lies above the terrain, so that its image counts
  double groundMpx = 0, imageMpx = 0;
  Counted tiles{}, objects{};            ///< triangles of the ground and of objects
  Counted tilesAhead{}, objectsAhead{};  ///< the most of this row and of those that a budget looks ahead to
  // From the drawn rows before and after it.
  double drawnHidden = 1, drawnOpen = 1;
  double costs = 1;  ///< over the fitted cost
  double flipAtRest = 0;
  std::array<Steps, kLosses> flip{};  ///< that a lever adds
  Steps smallKept{}, objectsKept{}, airKept{}, smallInstances{}, farInstances{};
  double instances = 0;
};

/// Knows the ground below the row in hand, which is all that a decision asks for.
class GroundOfRow final : public GroundHeights {
 public:
  explicit GroundOfRow(std::optional<Metres> highest) : highest_(highest) {}
  void set(const Row& row) { row_ = &row; }
  std::optional<Metres> heightAt(Degrees, Degrees) const override {
    return row_ ? row_->ground : std::nullopt;
  }
  std::optional<Metres> highest() const override { return highest_; }

 private:
  std::optional<Metres> highest_;
  const Row* row_ = nullptr;
};

/// Returns the start without whatever moves a lever.
ValidatedParameters plain(const ValidatedParameters& start) {
  TuningParameters p = *start;
  p.policy.enabled = p.hold.enabled = false;
  p.motion.control = MotionControl::off;
  p.lod.scale = Ratio{1};
  const Result<ValidatedParameters> valid = validate(p);
  return valid ? *valid : start;
}

/// Counts a request's triangles over the ladder, and the ground's pixels.
class Counter {
 public:
  explicit Counter(const std::shared_ptr<const terrain::Database>& terrain) {
    hold_.setIndex(scene::loadIndexOf(terrain));
  }
  void count(const FrameRequest& request, Row& row) {
    for (const double from : {kLeastPx, 16 * kLeastPx}) {
      const HoldGiven all = look(request, from, WeatherDecision::kUnlimited);
      const HoldGiven ground = look(request, from, -1);  // no object is so near
      const std::size_t first = from == kLeastPx ? 0 : 4 * kPlacesPerOctave;
      for (std::size_t k = 0; k < kErrorSteps && first + k < kCounted; ++k) {
        row.tiles[first + k] = static_cast<float>(ground.triangles[k]);
        row.objects[first + k] = static_cast<float>(all.triangles[k] - ground.triangles[k]);
      }
      row.groundMpx = all.groundMpx;
      row.imageMpx = all.imageMpx;
    }
  }

 private:
  HoldGiven look(FrameRequest request, double errorPx, double objectFarM) {
    FrameLevers& levers = request.levers.policy;
    levers.errorPx = levers.objectErrorPx = errorPx;
    levers.lodScale = 1;
    levers.smallFeaturePx = 0;
    levers.objectFarM = objectFarM;
    request.levers.drawn = levers;
    return hold_.look(request, {}, 0);
  }
  FrameHold hold_;
};

template <class Array>
void mostOf(Array& most, const Array& other) {
  for (std::size_t i = 0; i < most.size(); ++i) most[i] = std::max(most[i], other[i]);
}

/// Returns the nearest rank, whatever the number of samples.
double rankOf(std::vector<double>& samples, double fraction) {
  const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(samples.size())));
  const auto at =
      samples.begin() + static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(rank, 1, samples.size()) - 1);
  std::nth_element(samples.begin(), at, samples.end());
  return *at;
}

/// Returns the part of the way from one drawn row to the next, and their numbers.
struct Between {
  std::size_t before = 0, after = 0;
  double part = 0;
};
Between betweenOf(const std::vector<DrawnRow>& drawn, std::size_t row) {
  const auto after = std::lower_bound(drawn.begin(), drawn.end(), row,
                                      [](const DrawnRow& d, std::size_t r) { return d.row < r; });
  const auto at = static_cast<std::size_t>(after - drawn.begin());
  if (at == drawn.size()) return {at - 1, at - 1, 0};
  if (at == 0 || drawn[at].row == row) return {at, at, 0};
  const double from = static_cast<double>(drawn[at - 1].row), to = static_cast<double>(drawn[at].row);
  return {at - 1, at, (static_cast<double>(row) - from) / (to - from)};
}

/// The places of the levers in what the rows say.
struct Places {
  LeverPlace ground, objects;  ///< on the ladder
  std::array<LeverPlace, kLosses> losses;

  const Place& of(Loss loss, double value) {
    return losses[static_cast<std::size_t>(loss)].at(value, [loss](double v) { return onSteps(loss, v); });
  }
  static Place ladderPlace(double errorPx) { return onLadder(ladderSteps(errorPx)); }
};

/// The part of the triangles and instances of objects that smallest size and farthest distance leave.
struct Kept {
  double triangles = 1, instances = 1;
};
Kept keptOf(const Row& row, const FrameLevers& levers, Places& places) {
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
  std::vector<Row> rows;
  std::vector<SampleRow> toDraw;
  std::optional<Metres> highest;
  FittedCost cost;
  /// Holds the part by which the fitted costs miss the samples' times: its median and its 90th percentile.
  struct Fit {
    double median = 0, p90 = 0;
  };
  Fit fit;

  struct Image {
    double ms = 0, triangles = 0, flip = 0;
  };
  /// What the arbiter of the budget remembers, and what it decided last.
  struct Holding {
    HoldMemory memory;
    HeldLevers last;
  };
  Image imageOf(const Row& row, const FrameLevers& levers, const FrameDecision& decision,
                Places& places) const;
  HeldLevers hold(const Row& row, const FrameLevers& asked, const FrameDecision& decision,
                  const TuningParameters& parameters, Places& places, Holding& holding) const;

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
FlightModel::Impl::Image FlightModel::Impl::imageOf(const Row& row, const FrameLevers& levers,
                                                    const FrameDecision& decision, Places& places) const {
  Image image;
  image.flip = row.flipAtRest;
  const double groundPx = levers.errorPx * levers.lodScale, objectPx = levers.objectErrorPx * levers.lodScale;
  const auto lose = [&](Loss loss, double value) {
    image.flip += places.of(loss, value).in(row.flip[static_cast<std::size_t>(loss)], 0);
  };
  const Kept kept = keptOf(row, levers, places);
  const double objects = places.objects.at(objectPx, Places::ladderPlace).in(row.objects) * kept.triangles;
  lose(Loss::ground_error, groundPx);
  if (objects > 0) {
    lose(Loss::object_error, objectPx);
    lose(Loss::small_feature, levers.smallFeaturePx);
    lose(Loss::object_distance, levers.objectFarM);
  }
  if (levers.renderScale < 1) lose(Loss::render_scale, levers.renderScale);
  image.triangles = places.ground.at(groundPx, Places::ladderPlace).in(row.tiles) + objects;
  image.triangles *= levers.occlusion ? row.drawnHidden : row.drawnOpen;
  if (std::isfinite(levers.farM)) {
    const double part = levers.farM / decision.weather.farM;
    image.triangles *= places.of(Loss::far_distance, part).in(row.airKept, 1);
    lose(Loss::far_distance, part);
  }
  const double particles = particlesOf(decision) * levers.particleShare;
  if (levers.particleShare < 1 && particlesOf(decision) > 0) lose(Loss::particles, levers.particleShare);
  const double area = levers.renderScale * levers.renderScale;
  const FrameLoad load{image.triangles, row.groundMpx * area, row.imageMpx * area, particles, false};
  image.ms = cost(load, row.instances * kept.instances, levers.occlusion.has_value()) * row.costs;
  image.flip = std::min(image.flip, 1.0);
  return image;
}

/// Returns the levers to which the arbiter of the budget lowers a row's image.
HeldLevers FlightModel::Impl::hold(const Row& row, const FrameLevers& asked, const FrameDecision& decision,
                                   const TuningParameters& parameters, Places& places,
                                   Holding& holding) const {
  HoldGiven given;
  given.timeS = row.input.state.time;
  given.budgetMs = parameters.measure.budget.value();
  given.asked = {asked.errorPx, asked.renderScale, asked.particleShare, 1};
  given.particles = particlesOf(decision) * asked.particleShare;
  given.imageMpx = row.imageMpx;
  given.groundMpx = row.groundMpx;
  const double drawn = asked.occlusion ? row.drawnHidden : row.drawnOpen;
  const double tiles = ladderSteps(asked.errorPx * asked.lodScale);
  const double objects = ladderSteps(asked.objectErrorPx * asked.lodScale);
  const double toNext = placesToNext(asked.errorPx);
  const Kept kept = keptOf(row, asked, places);
  for (std::size_t k = 0; k < kErrorSteps; ++k) {
    const double coarser = k == 0 ? 0 : toNext + static_cast<double>(k - 1);
    given.triangles[k] = drawn * (onLadder(tiles + coarser).in(row.tilesAhead) +
                                  onLadder(objects + coarser).in(row.objectsAhead) * kept.triangles);
  }
  static_cast<ClockCoefficients&>(given.cost) = cost.coefficients;
  // The arbiter knows no instances: what they cost does not follow its levers.
  given.cost.other +=
      (asked.occlusion ? cost.lookingMs : 0) + cost.perInstance * row.instances * kept.instances;
  for (double ClockCoefficients::*part :
       {&ClockCoefficients::fixed, &ClockCoefficients::perTriangle, &ClockCoefficients::perGroundMpx,
        &ClockCoefficients::perParticles, &ClockCoefficients::perWeatherMpx, &ClockCoefficients::other})
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
                         std::size_t drawn)
    : impl_(std::make_unique<Impl>()) {
  impl_->highest = scene.terrain->highest();
  const ValidatedParameters parameters = plain(start);
  Session session(parameters);
  session.setGround(scene.terrain);
  Counter counter(scene.terrain);
  const std::size_t count = std::min(flight.states.size(), kMostRows);
  std::vector<FrameRequest> requests;
  for (std::size_t i = 0; i < count; ++i) {
    Row row;
    row.row = i * flight.states.size() / count;
    const AircraftState& state = flight.states[row.row];
    session.fly(state, state.time);
    row.input.state = session.input().state;
    row.ground = scene.terrain->heightAt(state.position.latitude, state.position.longitude);
    row.over = scene::liesOver(scene.terrain->info(), state.position);
    // Only a session without a state has none.
    requests.push_back(*session.request(state.time, scene.widthPx, scene.heightPx));
    row.input.state.velocity = requests.back().velocity;
    if (row.over) counter.count(requests.back(), row);
    impl_->rows.push_back(std::move(row));
  }
  std::vector<Row>& rows = impl_->rows;
  const auto ahead = static_cast<std::size_t>(start->hold.lookAhead.value());
  std::vector<std::size_t> over;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].over) over.push_back(i);
    rows[i].tilesAhead = rows[i].tiles;
    rows[i].objectsAhead = rows[i].objects;
    for (std::size_t j = i + 1; j < rows.size() && rows[j].row <= rows[i].row + ahead; ++j) {
      mostOf(rows[i].tilesAhead, rows[j].tiles);
      mostOf(rows[i].objectsAhead, rows[j].objects);
    }
  }
  const std::size_t samples = std::min(drawn, over.size());
  for (std::size_t k = 0; k < samples; ++k) {
    const std::size_t i = over[(2 * k + 1) * over.size() / (2 * samples)];
    SampleRow sample{rows[i].row, requests[i], std::nullopt, rows[i].groundMpx, {}};
    if (i > 0) sample.before = requests[i - 1];
    sample.counted = [tiles = rows[i].tiles, objects = rows[i].objects](double groundPx, double objectPx) {
      return Places::ladderPlace(groundPx).in(tiles) + Places::ladderPlace(objectPx).in(objects);
    };
    impl_->toDraw.push_back(std::move(sample));
  }
}

FlightModel::~FlightModel() = default;
FlightModel::FlightModel(FlightModel&&) noexcept = default;

const std::vector<SampleRow>& FlightModel::toDraw() const {
  return impl_->toDraw;
}

double FlightModel::emptyMs() const {
  double most = 0;
  for (const Row& row : impl_->rows) most = std::max(most, impl_->cost({}, 0, false) * row.costs);
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
  const auto mix = [](const auto& a, const auto& b, double part, Steps& into) {
    for (std::size_t s = 0; s < kLossSteps; ++s) into[s] = static_cast<float>(std::lerp(a[s], b[s], part));
  };
  for (Row& row : impl_->rows) {
    if (samples.rows.empty()) break;
    const Between at = betweenOf(samples.rows, row.row);
    const DrawnRow &a = samples.rows[at.before], &b = samples.rows[at.after];
    row.costs = std::lerp(costs[at.before], costs[at.after], at.part);
    row.drawnHidden = std::lerp(a.drawnHidden, b.drawnHidden, at.part);
    row.drawnOpen = std::lerp(a.drawnOpen, b.drawnOpen, at.part);
    // Where little ground is in the image, little of it is seen to be coarse.
    const double sampled = std::lerp(a.groundMpx, b.groundMpx, at.part);
    const double ground = sampled > 0 ? row.groundMpx / sampled : 0;
    row.flipAtRest = std::lerp(a.flipAtRest, b.flipAtRest, at.part) * ground;
    for (std::size_t l = 0; l < kLosses; ++l) {
      mix(a.flip[l], b.flip[l], at.part, row.flip[l]);
      if (static_cast<Loss>(l) == Loss::particles) continue;
      for (float& flip : row.flip[l]) flip *= static_cast<float>(ground);
    }
    mix(a.smallKept, b.smallKept, at.part, row.smallKept);
    mix(a.objectsKept, b.objectsKept, at.part, row.objectsKept);
    mix(a.airKept, b.airKept, at.part, row.airKept);
    mix(a.smallInstances, b.smallInstances, at.part, row.smallInstances);
    mix(a.farInstances, b.farInstances, at.part, row.farInstances);
    row.instances = std::lerp(a.instances, b.instances, at.part);
  }
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
  flown.reserve(rows.size());
  for (const Row& row : rows) {
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
  impl_->fly(parameters);
  const CompiledPolicy* const policy = parameters.policy();
  const double budgetMs = parameters->measure.budget.value();
  // A load that nobody asks for is not worth its median.
  const bool timed = policy != nullptr && policy->asks(Signal::load);
  DecisionMemory memory;
  Impl::Holding holding;
  ImageSignals images;
  Places places;
  std::vector<double> ms;
  ms.reserve(impl_->rows.size());
  double flip = 0, sumMs = 0;
  for (std::size_t i = 0; i < impl_->rows.size(); ++i) {
    const Row& row = impl_->rows[i];
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
      levers = withBudget(levers, impl_->hold(row, levers, decision, *parameters, places, holding));
    const Impl::Image image = impl_->imageOf(row, levers, decision, places);
    if (policy != nullptr)
      images.finished(timed ? image.ms : kNan, budgetMs, static_cast<std::uint64_t>(image.triangles));
    ms.push_back(image.ms);
    sumMs += image.ms;
    flip += image.flip;
    if (rows != nullptr) rows->push_back({row.row, image.ms, image.flip});
  }
  if (ms.empty()) return {};
  const double count = static_cast<double>(ms.size());
  return {rankOf(ms, 0.5), rankOf(ms, 0.95), rankOf(ms, 0.99), sumMs / count, flip / count};
}

}  // namespace trimtab::tune
