#include "flight_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "trimtab/hold/frame_hold.h"
#include "trimtab/motion/line_of_sight.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/session/session.h"

namespace trimtab::tune {
namespace {

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
  explicit Counter(std::shared_ptr<const LoadIndex> index) { hold_.setIndex(std::move(index)); }
  void count(const FrameRequest& request, FlightRow& row, double spread = 1) {
    for (const double from : {kLeastPx, 16 * kLeastPx}) {
      const HoldGiven all = look(request, from, spread, WeatherDecision::kUnlimited);
      const HoldGiven ground = look(request, from, spread, -1);  // no object is so near
      const std::size_t first = from == kLeastPx ? 0 : 4 * kPlacesPerOctave;
      for (std::size_t k = 0; k < kErrorSteps && first + k < kCounted; ++k) {
        row.tiles[first + k] = static_cast<float>(ground.triangles[k]);
        row.objects[first + k] = static_cast<float>(all.triangles[k] - ground.triangles[k]);
      }
      row.groundMpx = all.groundMpx;
      row.imageMpx = all.imageMpx;
    }
  }
  /// Returns the part of a row's triangles, which are counted, that each spread leaves.
  SpreadKept keptBySpreads(const FrameRequest& request, const FlightRow& row) {
    SpreadKept kept;
    for (std::size_t step = 0; step < kLossSteps; ++step) {
      FlightRow spread;
      count(request, spread, kLossValues[static_cast<std::size_t>(Loss::level_spread)][step]);
      for (std::size_t octave = 0; octave < kept.size(); ++octave) {
        const std::size_t k = octave * kPlacesPerOctave;
        const float all = row.tiles[k] + row.objects[k];
        kept[octave][step] = all > 0 ? (spread.tiles[k] + spread.objects[k]) / all : 1.0f;
      }
    }
    return kept;
  }

 private:
  HoldGiven look(FrameRequest request, double errorPx, double spread, double objectFarM) {
    FrameLevers& levers = request.levers.policy;
    levers.errorPx = levers.treeErrorPx = levers.objectErrorPx = errorPx;
    levers.lodScale = 1;
    levers.levelSpread = spread;
    levers.smallFeaturePx = 0;
    levers.objectFarM = objectFarM;
    request.levers.drawn = levers;
    request.staticLod.rule = StaticDistanceRule::picture;
    return hold_.look(request, {}, 0);
  }
  FrameHold hold_;
};

template <class Array>
void mostOf(Array& most, const Array& other) {
  for (std::size_t i = 0; i < most.size(); ++i) most[i] = std::max(most[i], other[i]);
}

/// Returns the rate at which the view turns from one image to the next, degrees a second.
double turnOf(const FrameRequest& before, const FrameRequest& request) {
  const double seconds = request.time - before.time;
  const double degrees = degreesBetween(directionOf(before.attitude), directionOf(request.attitude));
  return seconds > 0 && std::isfinite(degrees) ? degrees / seconds : 0;
}

/// Returns the rows to draw, of those that count: evenly spread, but that the row in which the view turns
/// fastest takes the place of its nearest, because there a blur loses most.
std::vector<std::size_t> rowsToDraw(const std::vector<FlightRow>& rows, const std::vector<std::size_t>& over,
                                    std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t count = std::min(most, over.size());
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(over[(2 * k + 1) * over.size() / (2 * count)]);
  if (chosen.empty()) return chosen;
  const std::size_t fastest = *std::max_element(
      over.begin(), over.end(), [&](auto a, auto b) { return rows[a].turnDegps < rows[b].turnDegps; });
  if (!(rows[fastest].turnDegps > 0)) return chosen;
  // Equal steps of the list: the nearest keeps its place among the others.
  const auto at =
      static_cast<std::size_t>(std::lower_bound(over.begin(), over.end(), fastest) - over.begin());
  chosen[std::min(at * count / over.size(), count - 1)] = fastest;
  return chosen;
}

/// Returns those of the rows to draw in which blur is drawn: where the view turns slowest, fastest, and in
/// the middle between.
std::vector<std::size_t> rowsToBlur(const std::vector<FlightRow>& rows, std::vector<std::size_t> chosen) {
  std::stable_sort(chosen.begin(), chosen.end(),
                   [&](auto a, auto b) { return rows[a].turnDegps < rows[b].turnDegps; });
  if (chosen.size() > 3) chosen = {chosen.front(), chosen[chosen.size() / 2], chosen.back()};
  return chosen;
}

/// Returns the requests of the images before a row, oldest first, as a session makes them that begins there:
/// the last, or all that the strongest blur which is drawn reaches back to.
std::vector<FrameRequest> requestsBefore(const FlightScene& scene, const Flight& flight,
                                         const ValidatedParameters& parameters, std::size_t row, bool blurs) {
  const auto& states = flight.states;
  const double reachS = blurReachS(kLossValues[static_cast<std::size_t>(Loss::blur)].back());
  std::size_t first = row;
  while (first > 0 && row - first < experiment::kLongestTrace &&
         (row - first < 2 || (blurs && states[row].time - states[first - 1].time <= reachS)))
    --first;
  Session session(parameters);
  session.setGround(scene.terrain);
  std::vector<FrameRequest> requests;
  for (std::size_t i = first; i < row; ++i) {
    session.fly(states[i], states[i].time);
    requests.push_back(*session.request(states[i].time, scene.widthPx, scene.heightPx));
  }
  return requests;
}

/// Returns the part of the way from one drawn row to the next, and their numbers.
struct Between {
  std::size_t before = 0, after = 0;
  double part = 0;
};
/// `drawn` is where the drawn rows are on a scale, ascending: their number in the flight, or how fast the
/// view turns.
Between betweenOf(const std::vector<double>& drawn, double at) {
  const auto after =
      static_cast<std::size_t>(std::lower_bound(drawn.begin(), drawn.end(), at) - drawn.begin());
  if (after == drawn.size()) return {after - 1, after - 1, 0};
  if (after == 0 || drawn[after] == at) return {after, after, 0};
  return {after - 1, after, (at - drawn[after - 1]) / (drawn[after] - drawn[after - 1])};
}

/// Returns by how many octaves of the allowed error each spread changes what a drawn row loses: until an
/// image without a spread loses as much, at most to the end of the losses.
Steps lostBySpreads(const DrawnRow& drawn) {
  Places places;
  const auto lostAt = [&](int octaves16) {
    Losses losses(drawn.atRest);
    const double px = kSpreadPx * std::exp2(octaves16 / double{kPlacesPerOctave});
    for (const Loss loss : {Loss::ground_error, Loss::object_error}) {
      Steps steps;
      std::ranges::copy(drawn.error[static_cast<std::size_t>(loss)], steps.begin());
      losses.add(places.of(loss, px).in(steps, drawn.atRest));
    }
    return losses.error();
  };
  const auto& lost = drawn.error[static_cast<std::size_t>(Loss::level_spread)];
  constexpr int kMost = 3 * static_cast<int>(kPlacesPerOctave);
  Steps octaves{};
  for (std::size_t s = 0; s < kLossSteps; ++s) {
    if (!(lost[kNoSpread] > 0) || lost[s] == lost[kNoSpread]) continue;
    const bool more = lost[s] > lost[kNoSpread];
    const double target = lostAt(0) * lost[s] / lost[kNoSpread];
    int at = 0;
    while (std::abs(at) < kMost && (more ? lostAt(at) < target : lostAt(at) > target)) at += more ? 1 : -1;
    octaves[s] = static_cast<float>(at) / static_cast<float>(kPlacesPerOctave);
  }
  return octaves;
}

}  // namespace

CountedFlight countFlight(const FlightScene& scene, const Flight& flight, const ValidatedParameters& start,
                          std::size_t mostRows, std::size_t drawn) {
  CountedFlight counted;
  const ValidatedParameters parameters = plain(start);
  Session session(parameters);
  session.setGround(scene.terrain);
  const std::shared_ptr<const LoadIndex> index = scene::loadIndexOf(scene.terrain);
  Counter counter(index);
  const std::size_t count = std::min(flight.states.size(), mostRows);
  std::vector<FrameRequest> requests;
  for (std::size_t i = 0; i < count; ++i) {
    FlightRow row;
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
    if (i > 0) row.turnDegps = turnOf(requests[i - 1], requests[i]);
    counted.rows.push_back(std::move(row));
  }
  std::vector<FlightRow>& rows = counted.rows;
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
  counted.forms = {index->tiles != nullptr, index->patches != nullptr, index->trees != nullptr};
  if (!requests.empty()) {
    counted.form = formDrawn(requests[0], counted.forms);
    counted.pixelsPerRadian = errorPxPerRadian(requests[0]);
    counted.spreadFromM = requests[0].spreadFrom.value();
  }
  const std::vector<std::size_t> chosen = rowsToDraw(rows, over, drawn);
  const std::vector<std::size_t> blurred = rowsToBlur(rows, chosen);
  for (const std::size_t i : chosen) {
    SampleRow sample{rows[i].row,  rows[i].turnDegps, requests[i], std::nullopt,
                     std::nullopt, rows[i].groundMpx, {}};
    const bool blurs = std::find(blurred.begin(), blurred.end(), i) != blurred.end();
    std::vector<FrameRequest> before = requestsBefore(scene, flight, parameters, rows[i].row, blurs);
    if (!before.empty()) {
      sample.before = std::move(before.back());
      before.pop_back();
      if (blurs) sample.trail = std::move(before);
    }
    sample.counted = [tiles = rows[i].tiles, objects = rows[i].objects](double groundPx, double objectPx) {
      return Places::ladderPlace(groundPx).in(tiles) + Places::ladderPlace(objectPx).in(objects);
    };
    counted.spreads.push_back(counter.keptBySpreads(sample.request, rows[i]));
    counted.toDraw.push_back(std::move(sample));
  }
  return counted;
}

void takeSamples(CountedFlight& flight, ErrorKind kind, const DrawnSamples& samples,
                 const std::vector<double>& costs) {
  if (samples.rows.empty()) return;
  const auto mix = [](const auto& a, const auto& b, double part, Steps& into) {
    for (std::size_t s = 0; s < kLossSteps; ++s) into[s] = static_cast<float>(std::lerp(a[s], b[s], part));
  };
  std::vector<double> numbers;
  std::vector<Steps> spreadLoses;
  /// Blur is drawn in a few rows; these are they, by how fast the view turns.
  std::vector<std::pair<double, const DrawnRow*>> blurred;
  for (std::size_t r = 0; r < samples.rows.size(); ++r) {
    numbers.push_back(static_cast<double>(samples.rows[r].row));
    spreadLoses.push_back(lostBySpreads(samples.rows[r]));
    if (flight.toDraw[r].trail) blurred.emplace_back(flight.toDraw[r].turnDegps, &samples.rows[r]);
  }
  std::ranges::sort(blurred);
  std::vector<double> turns;
  for (const auto& [turn, row] : blurred) turns.push_back(turn);
  constexpr auto kBlur = static_cast<std::size_t>(Loss::blur);
  for (FlightRow& row : flight.rows) {
    const Between at = betweenOf(numbers, static_cast<double>(row.row));
    const DrawnRow &a = samples.rows[at.before], &b = samples.rows[at.after];
    row.costs = std::lerp(costs[at.before], costs[at.after], at.part);
    row.drawnHidden = std::lerp(a.drawnHidden, b.drawnHidden, at.part);
    row.drawnOpen = std::lerp(a.drawnOpen, b.drawnOpen, at.part);
    // Where little ground is in the image, little of it is seen to be coarse; the largest error is elsewhere.
    const double sampled =
        std::lerp(flight.toDraw[at.before].groundMpx, flight.toDraw[at.after].groundMpx, at.part);
    const double ground = kind == ErrorKind::geometric ? 1 : sampled > 0 ? row.groundMpx / sampled : 0;
    row.atRest = std::lerp(a.atRest, b.atRest, at.part) * ground;
    for (std::size_t l = 0; l < kLosses; ++l)
      for (std::size_t s = 0; s < kLossSteps; ++s) {
        const double lost = std::lerp(std::max(a.error[l][s] - a.atRest, 0.0),
                                      std::max(b.error[l][s] - b.atRest, 0.0), at.part);
        row.error[l][s] =
            static_cast<float>(row.atRest + (static_cast<Loss>(l) == Loss::particles ? lost : lost * ground));
      }
    mix(a.smallKept, b.smallKept, at.part, row.smallKept);
    mix(a.objectsKept, b.objectsKept, at.part, row.objectsKept);
    mix(a.airKept, b.airKept, at.part, row.airKept);
    mix(a.smallInstances, b.smallInstances, at.part, row.smallInstances);
    mix(a.farInstances, b.farInstances, at.part, row.farInstances);
    mix(spreadLoses[at.before], spreadLoses[at.after], at.part, row.spreadLoses);
    for (std::size_t octave = 0; octave < row.spreadKept.size(); ++octave)
      mix(flight.spreads[at.before][octave], flight.spreads[at.after][octave], at.part,
          row.spreadKept[octave]);
    row.instances = std::lerp(a.instances, b.instances, at.part);
    if (blurred.empty()) continue;
    const Between turn = betweenOf(turns, row.turnDegps);
    const DrawnRow &slower = *blurred[turn.before].second, &faster = *blurred[turn.after].second;
    // What the drawn row has beside its blur is not this row's.
    const auto beside = [&](const DrawnRow& drawn) {
      Steps steps;
      for (std::size_t s = 0; s < kLossSteps; ++s)
        steps[s] = static_cast<float>(row.atRest + std::max(drawn.error[kBlur][s] - drawn.atRest, 0.0));
      return steps;
    };
    mix(beside(slower), beside(faster), turn.part, row.error[kBlur]);
  }
}

}  // namespace trimtab::tune
