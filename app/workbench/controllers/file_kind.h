// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

namespace trimtab::workbench {

/// What a file or folder is that a person drops on the window or names on the command line.
enum class FileKind { results, workspace, session, preset, rules, head_log, flight, terrain };

/// Tells the kind by the name's ending; of a table (.csv, .txt), by its first line: a flight has places, a
/// head log has angles alone. Everything else is taken for terrain, folders too.
FileKind fileKindOf(const QString& path);

/// Returns the folder of a baked database whose manifest.json `path` is, else `path`.
QString terrainOf(const QString& path);

}  // namespace trimtab::workbench
