// SPDX-License-Identifier: GPL-3.0-or-later
#include "file_kind.h"

#include <QFile>
#include <QFileInfo>
#include <algorithm>

#include "saved_session.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/format/store.h"

namespace trimtab::workbench {
namespace {

constexpr qint64 kLongestHeader = 4096;

/// The first line that is no comment.
QString headerOf(const QString& path) {
  QFile file(path);
  if (!checkIsData(path.toStdString()) || !file.open(QIODevice::ReadOnly)) return {};
  QByteArray line;
  do {
    line = file.readLine(kLongestHeader);
  } while (line.startsWith('#'));
  return QString::fromUtf8(line).toLower();
}

FileKind kindOfTable(const QString& path) {
  const QString header = headerOf(path);
  const auto names = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](const char* word) { return header.contains(QLatin1String(word)); });
  };
  return names({"yaw", "pitch", "heading"}) && !names({"lat"}) ? FileKind::head_log : FileKind::flight;
}

/// Whether a file is the manifest of a baked database, which is what file managers open of one.
bool isManifest(const QFileInfo& info) {
  return info.fileName() == QLatin1String(terrain::kManifestName);
}

}  // namespace

QString terrainOf(const QString& path) {
  const QFileInfo info(path);
  return isManifest(info) ? info.path() : path;
}

FileKind fileKindOf(const QString& path) {
  const QFileInfo info(path);
  if (!info.isFile()) return FileKind::terrain;
  const QString name = info.fileName().toLower(), ending = info.suffix().toLower();
  if (isManifest(info)) return FileKind::terrain;
  if (name == QLatin1String("results.json")) return FileKind::results;
  if (name.endsWith(QLatin1String(".workspace.json"))) return FileKind::workspace;
  if (name.endsWith(QLatin1String(kSessionEnding))) return FileKind::session;
  if (ending == QLatin1String("json")) return FileKind::preset;
  if (ending == QLatin1String("fll") || ending == QLatin1String("fis")) return FileKind::rules;
  if (ending == QLatin1String("pcap") || ending == QLatin1String("pcapng") ||
      ending == QLatin1String("gpx") || ending == QLatin1String("igc"))
    return FileKind::flight;
  if (ending == QLatin1String("csv") || ending == QLatin1String("txt")) return kindOfTable(path);
  return FileKind::terrain;
}

}  // namespace trimtab::workbench
