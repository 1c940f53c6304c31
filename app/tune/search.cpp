#include "search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <utility>

namespace trimtab::tune {
namespace {

/// Forty make a population: of sizes tried on problems whose front is known, it comes nearest within 10,000
/// evaluations. NSGA-II takes multiples of four.
constexpr std::size_t kPopulation = 40;

/// Keeps what no other beats, by ascending first objective, so that the second descends.
class Front {
 public:
  void add(std::span<const double> place, const Objectives& objectives) {
    if (!std::isfinite(objectives[0]) || !std::isfinite(objectives[1])) return;
    const auto after = std::upper_bound(
        kept_.begin(), kept_.end(), objectives[0],
        [](double value, const Candidate& candidate) { return value < candidate.objectives[0]; });
    if (after != kept_.begin() && (after - 1)->objectives[1] <= objectives[1]) return;
    auto first = after;
    while (first != kept_.begin() && (first - 1)->objectives[0] == objectives[0]) --first;
    auto last = after;
    while (last != kept_.end() && last->objectives[1] >= objectives[1]) ++last;
    const auto at = kept_.erase(first, last);
    kept_.insert(at, {{place.begin(), place.end()}, objectives});
  }
  std::vector<Candidate> take() { return std::move(kept_); }

 private:
  std::vector<Candidate> kept_;
};

/// The problem as pagmo sees it. pagmo copies it, so what it shares is pointed to.
struct Problem {
  const Search* search = nullptr;
  std::shared_ptr<Front> front;

  pagmo::vector_double fitness(const pagmo::vector_double& place) const {
    const Objectives objectives = search->evaluate(place);
    front->add(place, objectives);
    pagmo::vector_double fitness;
    for (const double value : objectives)
      fitness.push_back(std::isfinite(value) ? value : std::numeric_limits<double>::max());
    return fitness;
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(search->axes, 0.0), pagmo::vector_double(search->axes, 1.0)};
  }
  pagmo::vector_double::size_type get_nobj() const { return 2; }
};

}  // namespace

std::vector<Candidate> frontOf(const Search& search) {
  const auto front = std::make_shared<Front>();
  const auto seed = static_cast<unsigned>(search.seed);
  pagmo::population population{pagmo::problem{Problem{&search, front}}, 0, seed};
  for (const std::vector<double>& place : search.seeds) population.push_back(place);
  const std::size_t size = std::max(kPopulation, (population.size() + 3) / 4 * 4);
  while (population.size() < size) population.push_back(population.random_decision_vector());
  pagmo::algorithm algorithm{pagmo::nsga2(1, 0.95, 10, 1 / static_cast<double>(search.axes), 20, seed)};
  const std::size_t generations = std::max<std::size_t>(search.evaluations / size, 2) - 1;
  for (std::size_t i = 0; i < generations; ++i) {
    population = algorithm.evolve(population);
    if (search.progress && !search.progress(static_cast<double>(i + 1) / static_cast<double>(generations)))
      break;
  }
  return front->take();
}

std::vector<Candidate> joined(std::vector<Candidate> candidates, std::span<const Candidate> more) {
  Front front;
  for (const Candidate& candidate : candidates) front.add(candidate.place, candidate.objectives);
  for (const Candidate& candidate : more) front.add(candidate.place, candidate.objectives);
  return front.take();
}

}  // namespace trimtab::tune
