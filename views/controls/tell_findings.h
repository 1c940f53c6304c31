// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

#include "trimtab/units/result.h"

class QWidget;

namespace trimtab::views {

/// Shows the findings of a file in a box that waits for the person, if there are any: under the title
/// `failed` if one is an error, else under `done`.
void tellFindings(QWidget* parent, const QString& failed, const QString& done, const Findings& findings);

/// Returns the finding for a file of fuzzy rules whose name ends neither in .fll nor in .fis.
Finding unknownRuleEnding(const QString& file);

}  // namespace trimtab::views
