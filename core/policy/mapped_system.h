#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/policy/fuzzy_system.h"
#include "trimtab/policy/levers.h"
#include "trimtab/policy/rule_mapping.h"

namespace trimtab::fuzzy_system {

/// The signal of each input and the lever of each output, in the system's order.
struct SystemKeys {
  std::vector<RuleVariable> inputs, outputs;
};

/// Finds the keys: those of the mapping, else those that the variables are named by, in any letters. Refuses
/// what has none, with the keys that exist, and notes names that are not the key to the letter.
Result<SystemKeys> keysOf(const System& system, std::span<const RuleVariable> mapping,
                          const std::string& where);

/// Returns the system with these names, and with numbers in the units of signals and levers. Its inputs have
/// shapes of a policy and its outputs constants.
System mappedBy(const SystemKeys& keys, System system);

/// Returns the key of the signal of an input, or of the lever of an output, that its name says in any
/// letters; empty if it says none.
std::string keyInName(std::string_view name, bool input);

/// Returns the lever that an output of that name sets: its key, or the total of the former rule base.
std::optional<Lever> leverOfOutput(std::string_view name);
/// The output of rule files that were written for the former rule base of the culling scheme: the total,
/// which the lever occlusion sets now, and 0 where no rule fired.
inline constexpr std::string_view kFormerOutput = "total";

}  // namespace trimtab::fuzzy_system
