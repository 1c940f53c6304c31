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

QStringList shippedFlights() {
  // Beside an installed program, or in the tree in which it was built.
  QDir folder(QCoreApplication::applicationDirPath() + QStringLiteral("/../share/trimtab/flights"));
  if (!folder.exists())
    folder.setPath(QCoreApplication::applicationDirPath() + QStringLiteral("/../../resources/flights"));
  QStringList paths;
  for (const QFileInfo& file : folder.entryInfoList({QStringLiteral("*.csv")}, QDir::Files, QDir::Name))
    paths.append(file.canonicalFilePath());
  return paths;
}

QString folderOfRecent(const QString& kind) {
  for (const QString& path : recentFiles(kind))
    if (const QFileInfo file(path); file.exists()) return file.path();
  const QStringList shipped = kind == QLatin1String("flight") ? shippedFlights() : QStringList();
  return shipped.isEmpty() ? QString() : QFileInfo(shipped.first()).path();
}

}  // namespace trimtab::workbench
