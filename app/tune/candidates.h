#pragma once

#include <span>
#include <vector>

#include "flight_model.h"
#include "search.h"
#include "search_space.h"
#include "tried.h"
#include "tune.h"

/// Chooses presets by their estimates.
namespace trimtab::tune {

/// Judges presets over several flights by estimates.
class Judge {
 public:
  Judge(const Plan& plan, const SearchSpace& space, std::span<const FlightModel> models)
      : plan_(plan), space_(space), models_(models) {}

  /// Returns the time of the flight that takes longest, milliseconds, and the error of all (errorOfFlights);
  /// infinite if the preset breaks a rule.
  Objectives operator()(std::span<const double> place) const;
  /// `missed`, if it is given, corrects the estimates of each flight.
  Objectives of(const ValidatedParameters& parameters, std::span<const Missed> missed = {}) const;
  /// Orders what was judged by what the plan asks for: least error within the budget, least time within the
  /// error. What breaks the limit is worse than all that does not.
  double merit(const Objectives& objectives) const;
  /// Returns an error that nobody sees.
  double unseen() const { return rowOf(plan_.error).unseen; }

 private:
  const Plan& plan_;
  const SearchSpace& space_;
  std::span<const FlightModel> models_;
};

/// Returns presets along a front, `count` or as many as there are: evenly from `low` to `high` times the
/// limit of the plan, without a limit evenly along the front.
std::vector<Candidate> chosen(const Plan& plan, std::span<const Candidate> front, std::size_t count,
                              double low, double high);

/// Puts back to the start each number of a place whose moving wins nothing by the estimate.
Candidate simplified(const Judge& judge, std::span<const double> start, Candidate candidate);

/// Returns the best place by merit of those that differ from the start in one axis, and of 200 random ones.
Candidate bestSingle(const Judge& judge, std::span<const double> start);
Candidate bestRandom(const Judge& judge, std::size_t axes, std::uint64_t seed);

}  // namespace trimtab::tune
