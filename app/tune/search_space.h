#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/policy/policy.h"
#include "trimtab/preset/table.h"
#include "trimtab/units/result.h"

/// Says which numbers of a preset a search may move, and between which ends.
namespace trimtab::tune {

/// A preset as its numbers are moved: its policy is not text.
struct Movable {
  TuningParameters parameters;
  Policy policy;
};

/// One number that may move.
struct Axis {
  std::string name;  ///< "lod.scale", "fuzzy.pitch.curve_deg point 2 y", "policy.rules 1 lod_scale"
  double low = 0, high = 1;
  bool logarithmic = false;  ///< equal ways on the axis are equal ratios
  bool whole = false;        ///< only whole numbers
  std::function<double(const Movable&)> get;
  std::function<void(Movable&, double)> set;
};

/// The numbers that are free, each between 0 and 1 to whoever searches.
class SearchSpace {
 public:
  /// Makes the space around a preset. Each text frees a parameter by its key, a whole group ("lod.*"), or a
  /// parameter within other ends than its usual range ("lod.scale=1..3"). Of a curve or of bands each point
  /// is free, of `policy.terms` the numbers of each term, of `policy.rules` what each rule sets and its
  /// weight. Refuses what is unknown, what a search cannot move, ends that are out of order, that leave the
  /// accepted range or that leave out where the preset is, and nothing at all.
  static Result<SearchSpace> make(const TuningParameters& start, const std::vector<std::string>& free);

  std::size_t size() const { return axes_.size(); }
  const std::vector<Axis>& axes() const { return axes_; }
  /// Returns where a preset is, one number from 0 to 1 for each axis. What lies beyond an end counts as the
  /// end; a policy of another make than the start's counts as the start's.
  std::vector<double> placeOf(const TuningParameters& parameters) const;
  /// Returns the preset at a place. Points that a place puts out of order are put in order. It may still
  /// break a rule between parameters, which validate() finds.
  TuningParameters at(std::span<const double> place) const;

 private:
  Movable start_;
  std::vector<Axis> axes_;
  std::vector<double> startPlace_;
  std::vector<const ParameterRow*> ordered_;  ///< rows of free points, which must be in order
  bool movesPolicy_ = false;
};

}  // namespace trimtab::tune
