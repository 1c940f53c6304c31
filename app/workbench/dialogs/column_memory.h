// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

#include "trimtab/host/column_map.h"
#include "trimtab/host/log_look.h"

namespace trimtab::workbench {

/// What a person said of the columns of logs with the same header, kept in the user's settings. A file
/// without a header has nothing to be recognised by: nothing is remembered of it.
ColumnMap rememberedColumns(LogKind kind, const LogBeginning& log);
/// The same for a file; nothing if it is no table of text.
ColumnMap rememberedColumns(LogKind kind, const QString& file);
/// Remembers a map; an empty one forgets what was remembered.
void rememberColumns(LogKind kind, const LogBeginning& log, const ColumnMap& map);

}  // namespace trimtab::workbench
