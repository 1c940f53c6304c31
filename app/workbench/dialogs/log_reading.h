// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <string>

#include "trimtab/host/column_map.h"
#include "trimtab/host/log_look.h"
#include "trimtab/units/result.h"

namespace trimtab::workbench {

/// What a log, or its beginning, is with a map of columns.
struct LogReading {
  /// The rows, the duration, and from where to where each quantity goes; empty if the log is refused.
  QString text;
  /// Notes, or why it is refused. A head log some of whose rows are bad is read without them: opening it asks
  /// what to do with them.
  Findings findings;
};
LogReading readingOf(LogKind kind, const std::string& text, const std::string& file, const ColumnMap& map);

}  // namespace trimtab::workbench
