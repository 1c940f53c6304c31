#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace trimtab::tune {

/// The two numbers that a search makes small, time and error. A NaN or an infinity is worse than any number.
using Objectives = std::array<double, 2>;

struct Candidate {
  std::vector<double> place;  ///< one number from 0 to 1 for each axis
  Objectives objectives{};
};

struct Search {
  std::size_t axes = 0;                    ///< at least one
  std::vector<std::vector<double>> seeds;  ///< places to begin from, besides random ones
  std::function<Objectives(std::span<const double> place)> evaluate;
  std::size_t evaluations = 20000;
  std::uint64_t seed = 1;
  /// Called after each generation with the part that is done; returning false ends the search, which then
  /// returns what it has found.
  std::function<bool(double part)> progress;
};

/// Searches for places that no other beats in both objectives, by pagmo's NSGA-II (Deb et al., "A fast and
/// elitist multiobjective genetic algorithm", 2002), and returns those of all places that were evaluated, by
/// ascending first objective. The same search returns the same bits, whatever machine has as many.
std::vector<Candidate> frontOf(const Search& search);

/// Keeps the best of `candidates` and `more`: those that no other beats, by ascending first objective.
std::vector<Candidate> joined(std::vector<Candidate> candidates, std::span<const Candidate> more);

}  // namespace trimtab::tune
