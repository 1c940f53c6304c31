// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

#include "trimtab/policy/policy.h"
#include "trimtab/policy/rule_file.h"

/// Policies in the files of fuzzy-logic tools, by the ending of the file's name.
namespace trimtab::views {

/// Returns the filters for a file dialogue.
QString policyFileFilters();

/// Opens a file of rules. Fails for an ending that is none of ours, and for a file that cannot be read or is
/// not in the form of its language.
Result<RuleFile> openRuleFile(const QString& file);

/// Writes a policy under a name. The findings say why it failed.
Findings writePolicyFile(const QString& file, const Policy& policy, const std::string& name);

}  // namespace trimtab::views
