#pragma once

#include <string>
#include <vector>

#include "trimtab/policy/fuzzy_system.h"

/// The outputs of a rule file as functions of its inputs, sampled on a grid over the inputs' ranges.
namespace trimtab::fuzzy_system {

/// Returns the weight of a rule; 0 if it is switched off.
double weightOf(const Rule& rule);

/// An even grid with at most as many places as asked for, ends included.
class RuleGrid {
 public:
  RuleGrid(const std::vector<Variable>& inputs, std::size_t most);

  std::size_t places() const { return places_; }
  std::size_t side() const { return side_; }
  /// Puts the number along each input of a place into `step`.
  void stepsTo(std::size_t place, std::vector<std::size_t>& step) const;
  double x(std::size_t input, std::size_t step) const;

 private:
  const std::vector<Variable>& inputs_;
  std::size_t side_ = 2, places_ = 1;
};

/// How far each rule fires on a grid. The terms that rules name must have numbers that membershipFlaw()
/// accepts.
class RuleFirings {
 public:
  /// Takes a system whose conditions flatCondition() accepts.
  RuleFirings(const System& system, const RuleGrid& grid);
  /// Returns the membership of each rule's condition, without its weight.
  const std::vector<double>& at(const std::vector<std::size_t>& step);

 private:
  struct Part {
    std::size_t input, first;  ///< in memberships_
  };
  struct Condition {
    std::vector<Part> parts;
    bool byOr = false;
  };
  bool productOfAnd_, sumOfOr_;
  std::vector<Condition> conditions_;
  std::vector<double> memberships_;
  std::vector<double> firing_;
};

/// The value of one output of Mamdani's kind: what its terms make of how far rules fire.
class MamdaniOutput {
 public:
  MamdaniOutput(const System& system, std::size_t output);
  /// Returns the value; NaN if no rule fires. `firing` holds weights too.
  double value(const std::vector<double>& firing);
  /// Reports whether a term has an area within the output's range.
  bool hasArea(std::size_t term) const;

 private:
  /// Puts the membership of each y in what the rules conclude together into sum_.
  void aggregate(const std::vector<double>& firing);

  const System& system_;
  std::size_t output_;
  std::vector<double> y_;                  ///< the middles of even cells of the output's range
  std::vector<std::vector<double>> term_;  ///< the membership of each term there
  std::vector<double> sum_;
};

/// The value of each output at each place of a grid; NaN where no rule fires that sets it.
using Surface = std::vector<std::vector<double>>;
/// Takes a system whose terms all have numbers that suit their shapes.
Surface surfaceOf(const System& system, const RuleGrid& grid);

}  // namespace trimtab::fuzzy_system
