// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <optional>

#include "trimtab/preset/preset.h"

namespace trimtab::workbench {

/// Where an export went and what was said with it, so that it can be repeated without a question.
struct ExportTarget {
  QString file;
  ExportFormat format = ExportFormat::json;
  QString author, comment;
};

/// Keeps the target of a preset's file in the person's settings. Only the newest targets are kept.
void rememberTarget(const QString& presetFile, const ExportTarget& target);
/// Returns the target of the last export of a preset's file, in this run or an earlier one.
std::optional<ExportTarget> targetOf(const QString& presetFile);

}  // namespace trimtab::workbench
