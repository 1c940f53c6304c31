#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/policy/fuzzy_system.h"
#include "trimtab/policy/policy.h"
#include "trimtab/policy/rule_mapping.h"
#include "trimtab/units/range.h"
#include "trimtab/units/result.h"

namespace trimtab {

/// A rule file that is read once and made a policy as often as somebody changes what its variables are. What
/// does not depend on that, such as how far constants are from the file's planes, is worked out once.
class RuleFile {
 public:
  /// Reads a file's text in its own terms. Fails if it is not in the form of the language; `where` is the
  /// file's name in findings.
  static Result<RuleFile> open(std::string_view text, const std::string& where, RuleFormat format);

  /// An input or an output, as the file has it.
  struct Variable {
    std::string name;
    Range range;      ///< in the file's unit
    std::string key;  ///< of the signal or lever that the name says; empty if it says none
  };
  const std::vector<Variable>& inputs() const;
  const std::vector<Variable>& outputs() const;

  /// Returns what is said of shapes and of outputs that become constants: among it, with keys "difference of
  /// OUTPUT", the greatest and the mean difference of the surface from the file's. It takes up to a second
  /// when it is first asked for, and holds an error if no policy may come of it.
  const Findings& differences(bool acceptDifference) const;
  /// Reports whether accepting a difference above 5 % changes what comes of the file.
  bool acceptMatters() const;

  /// Makes a policy, as readPolicyFile() does with these options.
  Result<Policy> policy(std::span<const RuleVariable> mapping, bool acceptDifference) const;

 private:
  struct State;
  explicit RuleFile(std::shared_ptr<State> state) : state_(std::move(state)) {}
  std::shared_ptr<State> state_;  ///< shared by copies, which are the same file
};

/// Reports whether a rule file was refused for what its variables are, or for a difference that may be
/// accepted, so that a mapping may mend it.
bool mappingMayHelp(const Findings& findings);

}  // namespace trimtab
