#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/units/range.h"
#include "trimtab/units/result.h"

namespace trimtab {

/// The languages of rule files: FuzzyLite Language (version 6), and MATLAB's fuzzy inference systems as text
/// with the shapes and hedges that fuzzylite adds to them.
enum class RuleFormat { fuzzylite, matlab };

/// Returns the language by the file's ending, .fll or .fis.
std::optional<RuleFormat> ruleFormatOf(const std::filesystem::path& file);

}  // namespace trimtab

/// Holds what a rule file says, in either language, before it is compared with what this program can do: a
/// Takagi-Sugeno system of order zero, whose outputs are weighted averages of constants.
namespace trimtab::fuzzy_system {

struct Term {
  std::string name;
  std::string shape;  ///< as fuzzylite spells it: Discrete, ..., Constant, Linear; else as MATLAB does
  std::vector<double> numbers;  ///< in fuzzylite's order
  std::string where;
};

/// A value of the whole system, and where it stands; empty if the file does not say it.
struct Setting {
  std::string value, where;
};

struct Variable {
  std::string name;
  Range range;
  bool lockRange = false;  ///< values beyond the range count as its end
  std::vector<Term> terms;
  std::string where;
  double unfired = std::numeric_limits<double>::quiet_NaN();  ///< an output if no rule fires that sets it
  std::string unfiredWhere;
};

/// A term of an output that a rule sets.
struct Conclusion {
  std::size_t output = 0, term = 0;
};

struct Rule {
  std::string condition;  ///< "speed is not very fast and ( roll is any or ... )"; `not` never before "("
  std::vector<Conclusion> conclusions;
  double weight = 1;
  bool enabled = true;  ///< a rule that is switched off is a comment in both languages
  std::string reason;   ///< likewise
  std::string where;
};

/// How a system of Mamdani's kind infers, in MATLAB's words. Its outputs have terms with shapes.
struct MamdaniMethods {
  std::string implication = "min", aggregation = "max", defuzzifier = "centroid";
};

struct System {
  std::string name;
  std::vector<Variable> inputs, outputs;
  Setting conjunction, disjunction;  ///< as fuzzylite spells norms; "none" if there is none
  std::vector<Rule> rules;
  std::optional<MamdaniMethods> mamdani;  ///< Takagi and Sugeno's kind has none
};

/// Returns the text of a file. MATLAB's rules are numbers: one term of each input, joined by `and` alone or
/// by `or` alone. Each rule that cannot be said so is refused with its number. Reasons are written on one
/// line.
Result<std::string> systemText(const System& system, RuleFormat format);

/// Reads what systemText writes. It refuses with file, line, expected and found, one finding each and a
/// hundred at most, what is neither language's form or no system of order zero, and what is beyond 4,096
/// terms, 2,048 rules or 32,768 characters in a line. Shapes, numbers and the words of conditions are not
/// looked at.
Result<System> readSystem(std::string_view text, const std::string& where, RuleFormat format);

/// One "INPUT is HEDGES TERM" of a condition.
struct Proposition {
  std::string_view input;
  std::vector<std::string_view> hedges;
  std::string_view term;  ///< or "any"
};
/// A condition without groups, whose propositions are all joined by `connective`; empty if there is one.
struct FlatCondition {
  std::vector<Proposition> propositions;
  std::string_view connective;
};
/// Reads a condition. A finding has the key "rule" and no place. The views point into `condition`.
Result<FlatCondition> flatCondition(std::string_view condition);

/// Both languages take the first of two points at one x, and this program the last. Moves the first point of
/// each such pair to the left by a few units in the last place; and the inverse.
void moveStepsApart(std::vector<double>& xy);
void moveStepsTogether(std::vector<double>& xy);

/// Returns a name reduced to letters, digits and _; `fallback` if nothing is left.
std::string engineName(std::string_view name, std::string_view fallback);

/// Returns the index of the variable or term of that name; the size of the list if there is none.
template <class Named>
std::size_t indexOf(const std::vector<Named>& list, std::string_view name) {
  std::size_t i = 0;
  while (i < list.size() && list[i].name != name) ++i;
  return i;
}
/// Returns "low, high" for findings.
template <class Named>
std::string namesOf(const std::vector<Named>& list) {
  std::string names;
  for (const Named& each : list) names += (names.empty() ? "" : ", ") + each.name;
  return names;
}

}  // namespace trimtab::fuzzy_system
