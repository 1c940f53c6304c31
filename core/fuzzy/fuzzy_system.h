#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/result.h"

/// What the rule files of rule_file.h say, before it is held against what this program can do.
namespace trimtab::fuzzy_system {

struct Term {
  std::string name;
  std::string shape;  ///< as FuzzyLite spells it: Discrete, Ramp, Triangle, Trapezoid, Constant
  std::vector<double> numbers;
  std::string where;
};

struct Variable {
  std::string name;
  std::vector<Term> terms;
  std::string where;
};

enum class Hedge { is, is_not, any };

struct Condition {
  std::size_t input = 0;
  Hedge hedge = Hedge::is;
  std::size_t term = 0;  ///< of no meaning with `any`
};

struct Rule {
  std::vector<Condition> conditions;
  std::size_t output = 0;  ///< a term of the output
  double weight = 1;
  std::string where;
};

struct System {
  std::string name;
  std::vector<Variable> inputs;
  Variable output;
  std::vector<Rule> rules;
};

/// The system that computes what Combination::rules does. Refused, and warned of, as ruleFileText() says.
Result<System> systemOf(const TuningParameters& parameters, const std::string& name);
Result<TuningParameters> parametersOf(const System& system, const std::string& where,
                                      const TuningParameters& onto);

/// The two languages. A reader refuses what this program cannot do, line by line.
std::string toFuzzyLite(const System& system);
Result<System> readFuzzyLite(std::string_view text, const std::string& where);
std::string toMatlab(const System& system);
Result<System> readMatlab(std::string_view text, const std::string& where);

/// For the readers: words at blanks, text without blanks around, the next line without its end.
std::vector<std::string_view> words(std::string_view text);
std::string_view trimmed(std::string_view text);
std::string_view takeLine(std::string_view& text);
/// Index of the variable or term of that name; the size of the list where there is none.
template <class Named>
std::size_t indexOf(const std::vector<Named>& list, std::string_view name) {
  std::size_t i = 0;
  while (i < list.size() && list[i].name != name) ++i;
  return i;
}
/// "low, high" for findings.
template <class Named>
std::string namesOf(const std::vector<Named>& list) {
  std::string names;
  for (const Named& each : list) names += (names.empty() ? "" : ", ") + each.name;
  return names;
}

}  // namespace trimtab::fuzzy_system
