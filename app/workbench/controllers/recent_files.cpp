// SPDX-License-Identifier: GPL-3.0-or-later
#include "recent_files.h"

#include <QCoreApplication>
#include <QDir>
#include <QFileInfo>
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

QString folderOfRecent(const QString& kind) {
  for (const QString& path : recentFiles(kind))
    if (const QFileInfo file(path); file.exists()) return file.path();
  if (kind != QLatin1String("flight")) return {};
  // The program is run from the tree in which it was built.
  const QDir shipped(QCoreApplication::applicationDirPath() + QStringLiteral("/../../resources/flights"));
  return shipped.exists() ? shipped.canonicalPath() : QString();
}

}  // namespace trimtab::workbench
