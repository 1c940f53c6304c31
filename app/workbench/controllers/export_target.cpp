// SPDX-License-Identifier: GPL-3.0-or-later
#include "export_target.h"

#include <QSettings>
#include <vector>

namespace trimtab::workbench {
namespace {

const QString kTargets = QStringLiteral("export/targets");
constexpr int kKept = 20;

struct Remembered {
  QString presetFile;
  ExportTarget target;
};

std::vector<Remembered> read() {
  QSettings settings;
  std::vector<Remembered> all;
  const int size = settings.beginReadArray(kTargets);
  for (int i = 0; i < size; ++i) {
    settings.setArrayIndex(i);
    ExportTarget target{settings.value("file").toString(),
                        static_cast<ExportFormat>(settings.value("format").toInt()),
                        settings.value("author").toString(),
                        settings.value("comment").toString(),
                        {}};
    if (settings.contains("pinned"))
      target.pinned = static_cast<OcclusionMethod>(settings.value("pinned").toInt());
    all.push_back({settings.value("preset").toString(), target});
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
    if (all[i].target.pinned) settings.setValue("pinned", int(*all[i].target.pinned));
  }
  settings.endArray();
}

std::optional<ExportTarget> targetOf(const QString& presetFile) {
  for (const Remembered& each : read())
    if (each.presetFile == presetFile) return each.target;
  return std::nullopt;
}

}  // namespace trimtab::workbench
