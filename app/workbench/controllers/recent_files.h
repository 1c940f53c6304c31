// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QStringList>

namespace trimtab::workbench {

/// The files that were opened lately, kept in the user's settings. `kind` is "preset", "terrain" or "flight".
void rememberRecent(const QString& kind, const QString& path);
/// Returns the folder in which to look for another one: that of the newest file that is still there, else for
/// a flight the folder of those that ship, if there is one. Empty if there is nothing to suggest.
QString folderOfRecent(const QString& kind);
/// Returns at most eight paths, the newest first. Files that are gone by now are among them.
QStringList recentFiles(const QString& kind);
/// Returns the paths of the flights that ship, by name; none if their folder is not there.
QStringList shippedFlights();

}  // namespace trimtab::workbench
