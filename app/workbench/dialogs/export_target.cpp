// SPDX-License-Identifier: GPL-3.0-or-later
#include "export_target.h"

#include <QSettings>
#include <vector>

namespace trimtab::workbench {
namespace {

const QString kTargets = QStringLiteral("export/targets");
constexpr int kKept = 20;
constexpr int kFormats = int(ExportFormat::ini) + 1;

struct Remembered {
  QString presetFile;
  ExportTarget target;
};

/// Reads an enumeration with `count` values; nothing if the settings hold none of them.
template <class E>
std::optional<E> choiceIn(const QVariant& value, int count) {
  bool isNumber = false;
  const int number = value.toInt(&isNumber);
  if (!isNumber || number < 0 || number >= count) return std::nullopt;
  return static_cast<E>(number);
}

/// A target that another version of the program wrote and this one cannot repeat is left out.
std::vector<Remembered> read() {
  QSettings settings;
  std::vector<Remembered> all;
  const int size = settings.beginReadArray(kTargets);
  for (int i = 0; i < size; ++i) {
    settings.setArrayIndex(i);
    const auto format = choiceIn<ExportFormat>(settings.value("format"), kFormats);
    if (!format) continue;
    all.push_back({settings.value("preset").toString(),
                   {settings.value("file").toString(), *format, settings.value("author").toString(),
                    settings.value("comment").toString()}});
  }
  return all;
}

}  // namespace

void rememberTarget(const QString& presetFile, const ExportTarget& target) {
  std::vector<Remembered> all = read();
  std::erase_if(all, [&](const Remembered& each) { return each.presetFile == presetFile; });
  all.insert(all.begin(), {presetFile, target});
  if (all.size() > kKept) all.resize(kKept);
  QSettings settings;
  settings.remove(kTargets);
  settings.beginWriteArray(kTargets, int(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    settings.setArrayIndex(int(i));
    settings.setValue("preset", all[i].presetFile);
    settings.setValue("file", all[i].target.file);
    settings.setValue("format", int(all[i].target.format));
    settings.setValue("author", all[i].target.author);
    settings.setValue("comment", all[i].target.comment);
  }
  settings.endArray();
}

std::optional<ExportTarget> targetOf(const QString& presetFile) {
  for (const Remembered& each : read())
    if (each.presetFile == presetFile) return each.target;
  return std::nullopt;
}

}  // namespace trimtab::workbench
