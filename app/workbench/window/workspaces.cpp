// SPDX-License-Identifier: GPL-3.0-or-later
#include "workspaces.h"

#include <QFileInfo>
#include <QJsonDocument>
#include <QJsonObject>
#include <QMainWindow>
#include <QSettings>
#include <algorithm>
#include <array>

#include "dock_layout.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"

namespace trimtab::workbench {
namespace {

/// Raise it when docks come or go, so that no old layout replaces what ships. What a person saved is still
/// opened: Qt passes over docks that are gone.
constexpr int kDocksVersion = 6, kOldestVersion = 5;
constexpr auto kVersionKey = "trimtab_workspace", kNameKey = "name", kStateKey = "docks";

constexpr double kRight = 0.385;  ///< of the window's width

struct Shipped {
  const char* name;
  Arrangement docks;
};

/// What each job needs, with at least half of a window of 1280x720 left for the image: docks on the right, or
/// at the foot, not both.
const std::array<Shipped, 5>& shippedList() {
  static const std::array<Shipped, 5> list{{
      {QT_TRANSLATE_NOOP("Workspaces", "Fly"),
       {{{{"decision", "plots"}, 0.6}, {{"flight"}, 0.4}}, {}, kRight}},
      {QT_TRANSLATE_NOOP("Workspaces", "Tune"),
       {{{{"policy", "weather", "culling", "preset"}, 0.6}, {{"budget", "decision", "plots"}, 0.4}},
        {},
        kRight}},
      {QT_TRANSLATE_NOOP("Workspaces", "Measure"),
       {{}, {{{"errors"}, 0.68}, {{"flight", "preset"}, 0.32}}, 0, 0.32, true}},
      {QT_TRANSLATE_NOOP("Workspaces", "Terrain"),
       {{{{"terrain", "culling"}, 0.78}, {{"messages"}, 0.22}}, {}, kRight}},
      {QT_TRANSLATE_NOOP("Workspaces", "Connect"),
       {{{{"host"}, 0.6}, {{"flight", "plots", "messages"}, 0.4}}, {}, kRight}},
  }};
  return list;
}

Findings refusal(const QString& where, const char* expected, const QString& found) {
  return {{Severity::error, where.toStdString(), {}, expected, found.toStdString()}};
}

}  // namespace

std::size_t Workspaces::shipped() {
  return shippedList().size();
}

Workspaces::Workspaces(QMainWindow& window, DockLayout& docks)
    : QObject(&window), window_(window), docks_(docks) {
  for (const Shipped& each : shippedList()) all_.push_back({tr(each.name), {}, {}, {}});
}

QStringList Workspaces::names() const {
  QStringList names;
  for (const Workspace& each : all_) names << each.name;
  return names;
}

void Workspaces::show(int index) {
  if (index < 0 || std::size_t(index) >= all_.size()) return;
  leave();
  apply(index);
}

void Workspaces::leave() {
  all_[std::size_t(current_)].left = window_.saveState(kDocksVersion);
  all_[std::size_t(current_)].leftAt = window_.size();
}

void Workspaces::apply(int index) {
  current_ = index;
  const Workspace& wanted = all_[std::size_t(index)];
  const bool asLeft = !wanted.left.isEmpty() && window_.restoreState(wanted.left, kDocksVersion);
  if (!asLeft && !restore(wanted.saved)) {
    docks_.arrange(shippedList()[std::min(std::size_t(index), shipped() - 1)].docks);
  } else {
    docks_.noteShares(asLeft && !wanted.leftAt.isEmpty() ? wanted.leftAt : window_.size());
    docks_.keepShares();
  }
  emit currentChanged(index);
}

bool Workspaces::restore(const QByteArray& state) {
  for (int version = kDocksVersion; version >= kOldestVersion && !state.isEmpty(); --version)
    if (window_.restoreState(state, version)) return true;
  return false;
}

void Workspaces::reset() {
  all_[std::size_t(current_)].left.clear();
  apply(current_);
}

void Workspaces::add(const QString& name, const QByteArray& state) {
  leave();
  auto at = std::find_if(all_.begin(), all_.end(), [&](const Workspace& each) { return each.name == name; });
  if (at == all_.end()) at = all_.insert(at, {name, {}, {}, {}});
  at->saved = state;
  at->left.clear();
  emit listChanged();
  apply(static_cast<int>(at - all_.begin()));
}

Findings Workspaces::saveAs(const QString& name) {
  const QString plain = name.trimmed();
  const qsizetype at = names().indexOf(plain);
  if (plain.isEmpty() || (at >= 0 && ships(int(at))))
    return refusal(tr("workspace"), "a name that does not ship", plain);
  add(plain, window_.saveState(kDocksVersion));
  return {};
}

void Workspaces::remove(int index) {
  if (index < 0 || ships(index) || std::size_t(index) >= all_.size()) return;
  all_.erase(all_.begin() + index);
  if (current_ > index)
    --current_;
  else if (current_ == index)
    apply(0);
  emit listChanged();
}

Findings Workspaces::writeTo(const QString& file) const {
  const QJsonObject object{
      {QLatin1String(kVersionKey), kDocksVersion},
      {QLatin1String(kNameKey), all_[std::size_t(current_)].name},
      {QLatin1String(kStateKey), QString::fromLatin1(window_.saveState(kDocksVersion).toBase64())}};
  return writeAtomically(file.toStdString(), QJsonDocument(object).toJson().toStdString()).findings();
}

Findings Workspaces::readFrom(const QString& file) {
  const Result<std::string> text = readWhole(file.toStdString());
  if (!text) return text.findings();
  const QJsonObject object = QJsonDocument::fromJson(QByteArray::fromStdString(*text)).object();
  const int version = object[QLatin1String(kVersionKey)].toInt();
  if (version < kOldestVersion || version > kDocksVersion)
    return refusal(file, "a workspace of this version of the program",
                   object.isEmpty() ? tr("another file") : tr("another version"));
  const QByteArray state = QByteArray::fromBase64(object[QLatin1String(kStateKey)].toString().toLatin1());
  const QByteArray before = window_.saveState(kDocksVersion);
  if (!restore(state)) {
    window_.restoreState(before, kDocksVersion);
    return refusal(file, "places of docks", tr("bytes that are none"));
  }
  window_.restoreState(before, kDocksVersion);
  QString name = object[QLatin1String(kNameKey)].toString().trimmed();
  if (name.isEmpty()) name = QFileInfo(file).completeBaseName();
  if (const qsizetype at = names().indexOf(name); at >= 0 && ships(int(at)))
    name = tr("%1 of %2").arg(name, QFileInfo(file).completeBaseName());
  add(name, state);
  return {};
}

/// Returns the name that the settings have: what ships is not translated there.
QString Workspaces::keptName(std::size_t index) const {
  return index < shipped() ? QString::fromLatin1(shippedList()[index].name) : all_[index].name;
}

void Workspaces::begin() {
  const auto indexOf = [this](const QString& name) {
    std::size_t index = 0;
    while (index < all_.size() && keptName(index) != name) ++index;
    return index;
  };
  QSettings settings;
  const int count = settings.beginReadArray(QStringLiteral("workspaces"));
  for (int i = 0; i < count; ++i) {
    settings.setArrayIndex(i);
    const QString name = settings.value(QStringLiteral("name")).toString();
    const QByteArray saved = settings.value(QStringLiteral("saved")).toByteArray(),
                     left = settings.value(QStringLiteral("left")).toByteArray();
    const QSize leftAt = settings.value(QStringLiteral("left_at")).toSize();
    if (const std::size_t at = indexOf(name); at < all_.size())
      all_[at].left = left, all_[at].leftAt = leftAt;
    else if (!saved.isEmpty())
      all_.push_back({name, saved, left, leftAt});
    // Else it is one that shipped with an earlier version.
  }
  settings.endArray();
  emit listChanged();
  const std::size_t last = indexOf(settings.value(QStringLiteral("workspace")).toString());
  apply(last < all_.size() ? int(last) : current_);
}

void Workspaces::keep() {
  leave();
  QSettings settings;
  settings.beginWriteArray(QStringLiteral("workspaces"), int(all_.size()));
  for (std::size_t i = 0; i < all_.size(); ++i) {
    settings.setArrayIndex(int(i));
    settings.setValue(QStringLiteral("name"), keptName(i));
    settings.setValue(QStringLiteral("saved"), all_[i].saved);
    settings.setValue(QStringLiteral("left"), all_[i].left);
    settings.setValue(QStringLiteral("left_at"), all_[i].leftAt);
  }
  settings.endArray();
  settings.setValue(QStringLiteral("workspace"), keptName(std::size_t(current_)));
}

}  // namespace trimtab::workbench
