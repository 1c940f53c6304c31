// SPDX-License-Identifier: GPL-3.0-or-later
#include "recent_files.h"

#include <QSettings>

namespace trimtab::workbench {
namespace {

constexpr int kMostRecent = 8;

QString keyOf(const QString& kind) {
  return QStringLiteral("recent/") + kind;
}

}  // namespace

void rememberRecent(const QString& kind, const QString& path) {
  QStringList paths = recentFiles(kind);
  paths.removeAll(path);
  paths.prepend(path);
  QSettings().setValue(keyOf(kind), QStringList(paths.mid(0, kMostRecent)));
}

QStringList recentFiles(const QString& kind) {
  return QSettings().value(keyOf(kind)).toStringList();
}

}  // namespace trimtab::workbench
