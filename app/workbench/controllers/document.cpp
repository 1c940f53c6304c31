// SPDX-License-Identifier: GPL-3.0-or-later
#include "document.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <QCoreApplication>
#include <QDateTime>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonDocument>
#include <QJsonObject>
#include <QMetaObject>
#include <QStandardPaths>
#include <algorithm>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "views/model/draft.h"

namespace trimtab::workbench {
namespace {

constexpr int kCopyAfterMs = 1500;
/// Some editors save in several steps: the file is read once they are done.
constexpr int kLookAfterMs = 150;
constexpr auto kUntitled = "untitled";

QString recoveryFolder() {
  return QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation) + QStringLiteral("/recovery");
}

QString ownCopy() {
  return QStringLiteral("%1/%2.json").arg(recoveryFolder()).arg(QCoreApplication::applicationPid());
}

/// The lock is held while the program that keeps the copy lives. Its process number alone says too little:
/// the system may give a dead program's number to another one, or keep it in use until its parent asks how it
/// ended.
QString lockOf(const QString& copy) {
  return copy.chopped(5) + QStringLiteral(".lock");
}

bool isKept(const QString& copy, qint64 pid) {
  const int lock = ::open(QFile::encodeName(lockOf(copy)).constData(), O_RDWR | O_CLOEXEC);
  if (lock < 0) return ::kill(static_cast<pid_t>(pid), 0) == 0;
  const bool kept = ::flock(lock, LOCK_EX | LOCK_NB) != 0;
  ::close(lock);
  return kept;
}

bool isShipped(std::string_view name) {
  const auto shipped = shippedPresets();
  return std::find(shipped.begin(), shipped.end(), name) != shipped.end();
}

/// Returns the same preset for a file in another folder: if its base is a file, its path is made relative to
/// that folder.
Preset movedTo(Preset preset, const QString& folder) {
  if (!preset.base.empty() && !isShipped(preset.base)) {
    const QDir old(QString::fromStdString(preset.folder.string()));
    preset.base = QDir(folder)
                      .relativeFilePath(old.absoluteFilePath(QString::fromStdString(preset.base)))
                      .toStdString();
  }
  preset.folder = folder.toStdString();
  return preset;
}

/// Returns the name under which a preset is saved. One that a person gave it stays; one that came from the
/// file before, or from what the preset was made of, becomes the file's.
std::string nameIn(const QString& file, const std::string& name, const QString& before) {
  const bool given = !name.empty() && name != kUntitled && !isShipped(name) &&
                     QString::fromStdString(name) != QFileInfo(before).completeBaseName();
  return given ? name : QFileInfo(file).completeBaseName().toStdString();
}

std::string readAll(const QString& file) {
  const Result<std::string> bytes = readWhole(file.toStdString());
  return bytes ? *bytes : std::string();
}

}  // namespace

Document::Document(views::Draft& draft, QObject* parent) : QObject(parent), draft_(draft) {
  copySoon_.setSingleShot(true);
  lookSoon_.setSingleShot(true);
  connect(&copySoon_, &QTimer::timeout, this, &Document::keepCopyNow);
  connect(&lookSoon_, &QTimer::timeout, this, &Document::checkDisk);
  connect(&watcher_, &QFileSystemWatcher::fileChanged, this, [this] { lookSoon_.start(kLookAfterMs); });
  connect(&draft_.undoStack(), &QUndoStack::indexChanged, this, [this] {
    if (draft_.isDirty())
      copySoon_.start(kCopyAfterMs);
    else
      dropCopy();
  });
}

Document::~Document() {
  if (lock_ < 0) return;
  // A copy that is left now is offered at the next start.
  if (!QFile::exists(ownCopy())) QFile::remove(lockOf(ownCopy()));
  ::close(lock_);
}

QString Document::title() const {
  if (!file_.isEmpty()) return QFileInfo(file_).fileName();
  const std::string& name = draft_.preset().name;
  return name.empty() ? tr("untitled") : QString::fromStdString(name);
}

Result<Done> Document::open(const QString& nameOrFile) {
  const QString file =
      isShipped(nameOrFile.toStdString()) ? QString() : QFileInfo(nameOrFile).absoluteFilePath();
  std::string bytes = file.isEmpty() ? std::string() : readAll(file);
  Result<Preset> loaded = loadPreset(nameOrFile.toStdString());
  if (!loaded) return loaded.findings();
  draft_.load(*loaded);
  dropCopy();
  become(file, std::move(bytes));
  return {Done{}, loaded.findings()};
}

void Document::startFrom(const QString& shipped) {
  Result<Preset> base = loadPreset(shipped.toStdString());
  Preset fresh = base ? *base : Preset{};
  fresh.base = base ? shipped.toStdString() : std::string();
  fresh.name = kUntitled;
  fresh.description.clear();
  draft_.load(fresh);
  dropCopy();
  become({}, {});
}

Result<Done> Document::openEdits(const QString& nameOrFile, const QString& text, const QString& where,
                                 const QString& step) {
  Result<Preset> parsed = parsePreset(text.toStdString(), where.toStdString());
  if (!parsed) return parsed.findings();
  Findings findings = parsed.findings();
  Result<Done> opened = nameOrFile.isEmpty() ? Result<Done>(Findings{}) : open(nameOrFile);
  findings.insert(findings.end(), opened.findings().begin(), opened.findings().end());
  if (!opened) startFrom(QString::fromStdString(parsed->base.empty() ? "default" : parsed->base));
  draft_.takeParameters(parsed->parameters, step);
  return {Done{}, std::move(findings)};
}

Result<std::string> Document::editsText() const {
  Preset edits = draft_.preset();
  if (!isShipped(edits.base)) edits.base.clear();
  return presetText(edits);
}

Result<Done> Document::save(const QString& file) {
  const QString absolute = QFileInfo(file).absoluteFilePath();
  Preset saved = movedTo(draft_.preset(), QFileInfo(absolute).absolutePath());
  saved.name = nameIn(absolute, saved.name, file_);
  const Result<std::string> text = presetText(saved);
  if (!text) return text.findings();
  const Result<Done> written = writeAtomically(absolute.toStdString(), *text);
  if (!written) return written.findings();
  draft_.describe(saved.name, saved.description);
  draft_.markSaved();
  dropCopy();
  become(absolute, *text);
  return written;
}

void Document::become(const QString& file, std::string bytes) {
  if (!watcher_.files().isEmpty()) watcher_.removePaths(watcher_.files());
  file_ = file;
  bytes_ = std::move(bytes);
  ++becameTimes_;
  if (!file.isEmpty()) {
    watcher_.addPath(file);
    // Another program may have written it after these bytes were read or saved, and before it was watched.
    lookSoon_.start(kLookAfterMs);
  }
  emit fileChanged();
}

void Document::checkDisk() {
  if (file_.isEmpty()) return;
  disk_ = std::jthread([this, file = file_, times = becameTimes_, before = std::move(disk_)]() mutable {
    if (before.joinable()) before.join();
    const bool gone = !QFileInfo::exists(file);
    QMetaObject::invokeMethod(
        this,
        [this, times, gone, now = gone ? std::string() : readAll(file)] {
          // What was read before a save is older than what was saved.
          if (times == becameTimes_) compareWithDisk(gone, now);
        },
        Qt::QueuedConnection);
  });
}

void Document::compareWithDisk(bool gone, std::string now) {
  // A file that was replaced must be watched again.
  if (!gone && !watcher_.files().contains(file_)) watcher_.addPath(file_);
  if (gone) return emit changedOnDisk(true);
  if (now == bytes_) return;
  bytes_ = std::move(now);
  emit changedOnDisk(false);
}

void Document::keepCopyNow() {
  copySoon_.stop();
  if (!draft_.isDirty()) return;
  const Result<std::string> text = presetText(draft_.preset());
  if (!text) return;
  QDir().mkpath(recoveryFolder());
  if (lock_ < 0) {
    lock_ = ::open(QFile::encodeName(lockOf(ownCopy())).constData(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
      ::close(lock_);
      lock_ = -1;
    }
  }
  const QJsonObject copy{{"file", file_},
                         {"saved_at", QDateTime::currentDateTime().toString(Qt::ISODate)},
                         {"preset", QString::fromStdString(*text)}};
  // If the copy cannot be written, only the copy is lost: the next save will report what is wrong with the
  // disk.
  const auto ignored = writeAtomically(ownCopy().toStdString(), QJsonDocument(copy).toJson().toStdString());
  static_cast<void>(ignored);
}

void Document::dropCopy() {
  copySoon_.stop();
  QFile::remove(ownCopy());
}

std::vector<Document::Recovered> Document::abandoned() {
  std::vector<Recovered> found;
  const QDir folder(recoveryFolder());
  for (const QFileInfo& info : folder.entryInfoList({QStringLiteral("*.json")}, QDir::Files, QDir::Time)) {
    bool isPid = false;
    const qint64 pid = info.completeBaseName().toLongLong(&isPid);
    if (!isPid || pid == QCoreApplication::applicationPid() || isKept(info.filePath(), pid)) continue;
    const QJsonObject copy =
        QJsonDocument::fromJson(QByteArray::fromStdString(readAll(info.filePath()))).object();
    found.push_back(
        {info.filePath(), copy["file"].toString(), copy["saved_at"].toString(), copy["preset"].toString()});
  }
  return found;
}

Result<Done> Document::recover(const Recovered& recovered) {
  const QString where = recovered.file.isEmpty() ? recovered.copy : recovered.file;
  Result<Done> back = openEdits(recovered.file, recovered.text, where, tr("Recover unsaved edits"));
  if (!back) return back;
  keepCopyNow();
  discard(recovered);
  return back;
}

void Document::discard(const Recovered& recovered) {
  QFile::remove(recovered.copy);
  QFile::remove(lockOf(recovered.copy));
}

}  // namespace trimtab::workbench
