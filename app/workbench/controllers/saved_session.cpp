// SPDX-License-Identifier: GPL-3.0-or-later
#include "saved_session.h"

#include <QDir>
#include <QFileInfo>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <algorithm>
#include <cmath>

#include "trimtab/host/column_map.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "views/model/snapshots.h"

namespace trimtab::workbench {
namespace {

constexpr auto kVersionKey = "trimtab_session";
constexpr int kVersion = 1;
constexpr double kLowestM = -1000, kHighestM = 1e6, kLongestS = 1e7;

/// Reads the entries of one JSON object and collects what is wrong with them.
class Reader {
 public:
  Reader(QJsonObject object, QString file, QString place, Findings& findings)
      : object_(std::move(object)), file_(std::move(file)), place_(std::move(place)), findings_(findings) {}

  QString text(const char* key) {
    const QJsonValue value = object_.value(QLatin1String(key));
    if (!value.isUndefined() && !value.isString()) refuse(key, "a text", value);
    return value.toString();
  }
  double number(const char* key, double low, double high) {
    const QJsonValue value = object_.value(QLatin1String(key));
    const double found = value.toDouble(std::nan(""));
    if (found >= low && found <= high) return found;
    refuse(key, QStringLiteral("a number from %1 to %2").arg(low).arg(high), value);
    return low;
  }
  bool has(const char* key) const { return object_.contains(QLatin1String(key)); }
  Reader object(const char* key) {
    const QJsonValue value = object_.value(QLatin1String(key));
    if (!value.isObject()) refuse(key, "an object", value);
    return {value.toObject(), file_, place_ + QLatin1String(key) + '.', findings_};
  }
  std::vector<Reader> objects(const char* key) {
    const QJsonValue value = object_.value(QLatin1String(key));
    if (!value.isUndefined() && !value.isArray()) refuse(key, "a list", value);
    std::vector<Reader> all;
    for (const QJsonValue& each : value.toArray()) {
      const QString place = QStringLiteral("%1%2[%3].").arg(place_, QLatin1String(key)).arg(all.size());
      if (!each.isObject()) refuse(key, "a list of objects", each);
      all.push_back({each.toObject(), file_, place, findings_});
    }
    return all;
  }
  SavedSnapshot snapshot() {
    const QString letter = text("slot");
    SavedSnapshot read{letter.size() == 1 ? letter[0].unicode() - 'A' : -1, text("name"), {}};
    if (read.slot < 0 || read.slot >= views::Snapshots::kCount)
      refuse("slot", QStringLiteral("a letter from A to %1").arg(QChar('A' + views::Snapshots::kCount - 1)),
             letter);
    read.preset = preset("preset");
    return read;
  }
  /// Returns the text of a preset that is an object of its own.
  QString preset(const char* key) {
    const QJsonValue value = object_.value(QLatin1String(key));
    if (!value.isObject()) {
      refuse(key, "an object", value);
      return {};
    }
    const QByteArray text = QJsonDocument(value.toObject()).toJson(QJsonDocument::Compact);
    const auto parsed =
        parsePreset(text.toStdString(), (file_ + ' ' + place_ + QLatin1String(key)).toStdString());
    if (!parsed) findings_.insert(findings_.end(), parsed.findings().begin(), parsed.findings().end());
    return QString::fromUtf8(text);
  }
  /// Returns the text of a map of columns.
  QString columns(const char* key) {
    const QString map = text(key);
    if (!parseColumnMap(map.toStdString())) refuse(key, "a map of columns", map);
    return map;
  }
  SavedView view() {
    return {text("name"),
            {Degrees{number("latitude_deg", -90, 90)}, Degrees{number("longitude_deg", -180, 180)},
             Metres{number("height_m", kLowestM, kHighestM)}},
            {Degrees{number("heading_deg", 0, 360)}, Degrees{number("pitch_deg", -90, 90)},
             Degrees{number("roll_deg", -180, 180)}}};
  }

 private:
  void refuse(const char* key, const QString& expected, const QJsonValue& found) {
    QByteArray text = QJsonDocument(QJsonArray{found}).toJson(QJsonDocument::Compact);
    text = text.mid(1, std::min<qsizetype>(text.size() - 2, 60));
    findings_.push_back({Severity::error, file_.toStdString(), (place_ + QLatin1String(key)).toStdString(),
                         expected.toStdString(), text.toStdString()});
  }

  QJsonObject object_;
  QString file_, place_;
  Findings& findings_;
};

QJsonObject presetObject(const QString& text) {
  return QJsonDocument::fromJson(text.toUtf8()).object();
}

QJsonObject toJson(const SavedSnapshot& snapshot) {
  QJsonObject object{{"slot", QString(QChar('A' + snapshot.slot))},
                     {"preset", presetObject(snapshot.preset)}};
  if (!snapshot.name.isEmpty()) object["name"] = snapshot.name;
  return object;
}

QJsonObject toJson(const SavedView& view) {
  QJsonObject object{
      {"latitude_deg", view.position.latitude.value()}, {"longitude_deg", view.position.longitude.value()},
      {"height_m", view.position.height.value()},       {"heading_deg", view.attitude.heading.value()},
      {"pitch_deg", view.attitude.pitch.value()},       {"roll_deg", view.attitude.roll.value()}};
  if (!view.name.isEmpty()) object["name"] = view.name;
  return object;
}

/// A path below `folder` becomes relative to it. What is no path, such as a preset's name, stays.
QString relativeTo(const QDir& folder, const QString& path) {
  if (!QDir::isAbsolutePath(path)) return path;
  const QString relative = folder.relativeFilePath(path);
  return relative.startsWith(QLatin1String("..")) ? path : QStringLiteral("./") + relative;
}

QString absoluteIn(const QDir& folder, const QString& path) {
  return path.startsWith(QLatin1String("./")) ? QDir::cleanPath(folder.absoluteFilePath(path)) : path;
}

}  // namespace

Result<Done> writeSession(const QString& file, const SavedSession& session) {
  const QDir folder = QFileInfo(file).absoluteDir();
  QJsonObject object{{kVersionKey, kVersion}, {"workspace", session.workspace}};
  object["terrain"] = relativeTo(folder, session.terrain);
  object["preset"] = relativeTo(folder, session.preset);
  if (!session.imageGenerator.isEmpty())
    object["image_generator"] = relativeTo(folder, session.imageGenerator);
  if (session.draft) object["draft"] = presetObject(*session.draft);
  if (!session.flight.isEmpty()) {
    object["flight"] = relativeTo(folder, session.flight);
    object["flight_position_s"] = session.flightPositionS;
    if (!session.flightColumns.isEmpty()) object["flight_columns"] = session.flightColumns;
  }
  if (session.listenPort) object["listen_port"] = *session.listenPort;
  if (session.eye) object["eye"] = toJson(*session.eye);
  QJsonArray views;
  for (const SavedView& view : session.views) views.append(toJson(view));
  object["views"] = views;
  if (session.snapshots) {
    QJsonArray snapshots;
    for (const SavedSnapshot& snapshot : *session.snapshots) snapshots.append(toJson(snapshot));
    object["snapshots"] = snapshots;
  }
  return writeAtomically(QFileInfo(file).absoluteFilePath().toStdString(),
                         QJsonDocument(object).toJson().toStdString());
}

Result<SavedSession> readSession(const QString& file) {
  const Result<std::string> text = readWhole(file.toStdString());
  if (!text) return text.findings();
  QJsonParseError error;
  const QByteArray bytes = QByteArray::fromStdString(*text);
  const QJsonDocument document = QJsonDocument::fromJson(bytes, &error);
  const auto at = [&](qsizetype line) { return QStringLiteral("%1:%2").arg(file).arg(line).toStdString(); };
  if (error.error != QJsonParseError::NoError)
    return Finding{Severity::error,
                   at(bytes.left(error.offset).count('\n') + 1),
                   {},
                   "JSON",
                   error.errorString().toStdString()};
  const QJsonValue version = document.object()[QLatin1String(kVersionKey)];
  if (version.toInt() != kVersion)
    return Finding{Severity::error, file.toStdString(), kVersionKey, std::to_string(kVersion),
                   version.isUndefined() ? "no such entry" : std::to_string(version.toInt())};

  Findings findings;
  Reader in(document.object(), file, {}, findings);
  const QDir folder = QFileInfo(file).absoluteDir();
  SavedSession session;
  session.terrain = absoluteIn(folder, in.text("terrain"));
  session.preset = absoluteIn(folder, in.text("preset"));
  session.imageGenerator = absoluteIn(folder, in.text("image_generator"));
  if (in.has("draft")) session.draft = in.preset("draft");
  session.flight = absoluteIn(folder, in.text("flight"));
  session.flightColumns = in.columns("flight_columns");
  if (in.has("flight_position_s")) session.flightPositionS = in.number("flight_position_s", 0, kLongestS);
  if (in.has("listen_port"))
    session.listenPort = static_cast<std::uint16_t>(in.number("listen_port", 1, 65535));
  session.workspace = in.text("workspace");
  if (in.has("eye")) session.eye = in.object("eye").view();
  for (Reader& view : in.objects("views")) session.views.push_back(view.view());
  if (in.has("snapshots")) {
    session.snapshots.emplace();
    for (Reader& each : in.objects("snapshots")) session.snapshots->push_back(each.snapshot());
  }
  if (!findings.empty()) return findings;
  return session;
}

}  // namespace trimtab::workbench
