#pragma once

#include <optional>
#include <vector>

#include "rule_surface.h"

namespace trimtab::fuzzy_system {

/// Returns a table that stands for a surface: each input gets triangular terms whose memberships sum to 1,
/// and each combination of them is a rule, so that the outputs go straight from level to level. Beyond the
/// ranges of the inputs they stay as at the ends. The system has the names, ranges and places of `like`.
///
/// Levels are placed one at a time where they help most, until no output differs by more than `most` at a
/// place of the grid. Returns nothing for more than three inputs, for a surface with places where no rule
/// fires, and if more rules than a policy may have would be needed.
std::optional<System> tableOf(const System& like, const RuleGrid& grid, const Surface& surface,
                              const std::vector<double>& most);

}  // namespace trimtab::fuzzy_system
