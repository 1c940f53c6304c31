// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

#include "trimtab/policy/policy.h"

/// Policies in the files of fuzzy-logic tools, by the ending of the file's name.
namespace trimtab::views {

/// Returns the filters for a file dialogue.
QString policyFileFilters();

/// Reads a policy. Fails for an ending that is none of ours, a file that cannot be read, and with everything
/// that a policy cannot say.
Result<Policy> readPolicyFile(const QString& file);

/// Writes a policy under a name. The findings say why it failed.
Findings writePolicyFile(const QString& file, const Policy& policy, const std::string& name);

}  // namespace trimtab::views
