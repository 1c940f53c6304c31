// SPDX-License-Identifier: GPL-3.0-or-later
#include "column_memory.h"

#include <QCryptographicHash>
#include <QFileInfo>
#include <QSettings>

namespace trimtab::workbench {
namespace {

/// The header of a file is found in at most so many of its first bytes.
constexpr std::size_t kHeaderBytes = std::size_t{1} << 16;

QString keyOf(LogKind kind, const LogBeginning& log) {
  QCryptographicHash hash(QCryptographicHash::Sha256);
  for (const std::string& name : log.header) {
    hash.addData(QByteArray::fromStdString(name));
    hash.addData(QByteArray(1, '\0'));  // no name holds it, so that two headers never look the same
  }
  return (kind == LogKind::flight ? QStringLiteral("columns/flight/") : QStringLiteral("columns/head/")) +
         QString::fromLatin1(hash.result().toHex());
}

}  // namespace

ColumnMap rememberedColumns(LogKind kind, const LogBeginning& log) {
  if (!log.hasHeader) return {};
  const auto map = parseColumnMap(QSettings().value(keyOf(kind, log)).toString().toStdString());
  return map ? *map : ColumnMap{};
}

ColumnMap rememberedColumns(LogKind kind, const QString& file) {
  // A pipe gives its bytes once, and they are the reader's.
  if (!QFileInfo(file).isFile()) return {};
  const auto log = beginningOfLog(file.toStdString(), kind, kHeaderBytes);
  return log ? rememberedColumns(kind, *log) : ColumnMap{};
}

void rememberColumns(LogKind kind, const LogBeginning& log, const ColumnMap& map) {
  if (!log.hasHeader) return;
  QSettings settings;
  if (map.empty())
    settings.remove(keyOf(kind, log));
  else
    settings.setValue(keyOf(kind, log), QString::fromStdString(columnMapText(map)));
}

}  // namespace trimtab::workbench
