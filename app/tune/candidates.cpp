#include "candidates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace trimtab::tune {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double timeOf(const Estimate& estimate, TimeMeasure time) {
  return time == TimeMeasure::median ? estimate.medianMs
         : time == TimeMeasure::p95  ? estimate.p95Ms
                                     : estimate.p99Ms;
}

/// Returns the member of a front, which is ordered by time, that comes nearest to a limit from inside; the
/// nearest outside if there is none.
std::size_t within(std::span<const Candidate> front, std::size_t objective, double limit) {
  const auto inside = [&](const Candidate& c) { return c.objectives[objective] <= limit; };
  if (objective == 0) {
    const auto after = std::find_if_not(front.begin(), front.end(), inside);
    return after == front.begin() ? 0 : static_cast<std::size_t>(after - front.begin()) - 1;
  }
  const auto first = std::find_if(front.begin(), front.end(), inside);
  return first == front.end() ? front.size() - 1 : static_cast<std::size_t>(first - front.begin());
}

}  // namespace

Objectives Judge::of(const ValidatedParameters& parameters, std::span<const Missed> missed) const {
  double longest = 0;
  std::vector<double> errors;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const Estimate estimate = models_[i].estimate(parameters);
    const Missed off = missed.empty() ? Missed{} : missed[i];
    longest = std::max(longest, timeOf(estimate, plan_.time) * off.time);
    errors.push_back(estimate.error * off.error);
  }
  return {longest, errorOfFlights(plan_.error, errors)};
}

Objectives Judge::operator()(std::span<const double> place) const {
  const Result<ValidatedParameters> valid = validate(space_.at(place));
  if (!valid) return {kInfinite, kInfinite};
  return of(*valid);
}

double Judge::merit(const Objectives& objectives) const {
  const std::size_t limited = plan_.maxError ? 1 : 0;
  const double limit = plan_.maxError ? *plan_.maxError : plan_.budgetMs.value_or(kInfinite);
  const double over = objectives[limited] / limit;
  // An error is at most 255, and no image takes an hour.
  constexpr double kFar = 1e7;
  return over > 1 ? kFar * over : objectives[1 - limited];
}

std::vector<Candidate> chosen(const Plan& plan, std::span<const Candidate> front, std::size_t count,
                              double low, double high) {
  std::set<std::size_t> numbers;
  count = std::min(count, front.size());
  if (count == 0) return {};
  const double last = static_cast<double>(std::max<std::size_t>(count - 1, 1));
  const std::optional<double> limit = plan.maxError ? plan.maxError : plan.budgetMs;
  for (std::size_t k = 0; k < count; ++k) {
    const double part = count == 1 ? 0.5 : static_cast<double>(k) / last;
    numbers.insert(limit ? within(front, plan.maxError ? 1 : 0, *limit * std::lerp(low, high, part))
                         : static_cast<std::size_t>(part * static_cast<double>(front.size() - 1)));
  }
  // Where the front is sparse, several of these are one: their neighbours make up for them.
  for (std::size_t next = *numbers.begin(); numbers.size() < count && next-- > 0;) numbers.insert(next);
  for (std::size_t next = 0; numbers.size() < count; ++next) numbers.insert(next);
  std::vector<Candidate> presets;
  for (const std::size_t number : numbers) presets.push_back(front[number]);
  return presets;
}

Candidate simplified(const Judge& judge, std::span<const double> start, Candidate candidate) {
  // A number that moves neither time nor error by so much is not worth moving.
  constexpr double kPart = 0.002;
  for (std::size_t i = 0; i < candidate.place.size(); ++i) {
    if (candidate.place[i] == start[i]) continue;
    std::vector<double> without = candidate.place;
    without[i] = start[i];
    const Objectives objectives = judge(without);
    if (objectives[0] <= candidate.objectives[0] * (1 + kPart) &&
        objectives[1] <= candidate.objectives[1] * (1 + kPart) + judge.unseen()) {
      candidate.place = std::move(without);
      candidate.objectives = objectives;
    }
  }
  return candidate;
}

Candidate bestSingle(const Judge& judge, std::span<const double> start) {
  constexpr int kValues = 33;
  Candidate best{{start.begin(), start.end()}, judge(start)};
  for (std::size_t i = 0; i < start.size(); ++i)
    for (int value = 0; value < kValues; ++value) {
      std::vector<double> place(start.begin(), start.end());
      place[i] = value / static_cast<double>(kValues - 1);
      const Objectives objectives = judge(place);
      if (judge.merit(objectives) < judge.merit(best.objectives)) best = {std::move(place), objectives};
    }
  return best;
}

Candidate bestRandom(const Judge& judge, std::size_t axes, std::uint64_t seed) {
  constexpr int kPlaces = 200;
  std::mt19937_64 random(seed);
  Candidate best;
  for (int i = 0; i < kPlaces; ++i) {
    std::vector<double> place(axes);
    // The distributions of the standard library differ from one to the next; this does not.
    for (double& at : place) at = static_cast<double>(random() >> 11) * 0x1p-53;
    const Objectives objectives = judge(place);
    if (best.place.empty() || judge.merit(objectives) < judge.merit(best.objectives))
      best = {std::move(place), objectives};
  }
  return best;
}

}  // namespace trimtab::tune
