// SPDX-License-Identifier: GPL-3.0-or-later
#include "document_controller.h"

#include <QDateTime>
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>

#include "app/workbench/dialogs/notice_bar.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/viewport/viewport.h"
#include "ig_controller.h"
#include "recent_files.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/rig/ig_profile.h"
#include "views/model/draft.h"

namespace trimtab::workbench {
namespace {

const QString kDiskNotice = QStringLiteral("disk");

QString presetFilter() {
  return DocumentController::tr("Presets (*.json);;All files (*)");
}

}  // namespace

DocumentController::DocumentController(const Workplace& workplace, NoticeBar& notices)
    : at_(workplace), notices_(notices), document_(workplace.draft) {
  connect(&document_, &Document::changedOnDisk, this, &DocumentController::onChangedOnDisk);
  // Another preset has another target, or none; saved under another name it is still the same preset.
  connect(&at_.draft, &views::Draft::loaded, this, [this] { target_.reset(); });
  connect(&document_, &Document::fileChanged, this, [this] {
    if (document_.file().isEmpty()) return;
    if (target_)
      rememberTarget(document_.file(), *target_);
    else
      target_ = targetOf(document_.file());
  });
}

bool DocumentController::open(const QString& nameOrFile) {
  return sayOpened(nameOrFile, document_.open(nameOrFile));
}

bool DocumentController::openEdits(const QString& nameOrFile, const QString& text, const QString& session) {
  return sayOpened(nameOrFile.isEmpty() ? session : nameOrFile,
                   document_.openEdits(nameOrFile, text, session, tr("Unsaved edits of the session")));
}

bool DocumentController::sayOpened(const QString& name, const Result<Done>& opened) {
  if (!opened) {
    at_.messages.add(tr("The preset cannot be opened: %1").arg(name), opened.findings());
    return false;
  }
  if (!opened.findings().empty()) at_.messages.add(tr("Opened %1").arg(name), opened.findings());
  if (!document_.file().isEmpty()) rememberRecent(QStringLiteral("preset"), document_.file());
  return true;
}

void DocumentController::openOverEdits(const QString& nameOrFile) {
  if (mayLoseEdits()) open(nameOrFile);
}

void DocumentController::startFrom(const QString& shipped) {
  if (mayLoseEdits()) document_.startFrom(shipped);
}

void DocumentController::askOpen() {
  if (!mayLoseEdits()) return;
  const QString file =
      QFileDialog::getOpenFileName(&at_.window, tr("Open preset"), document_.file(), presetFilter());
  if (!file.isEmpty()) open(file);
}

bool DocumentController::saveTo(const QString& file) {
  const Result<Done> saved = document_.save(file);
  if (!saved) {
    at_.messages.add(tr("The preset cannot be saved: %1").arg(file), saved.findings());
    return false;
  }
  if (!saved.findings().empty()) at_.messages.add(tr("Saved to %1").arg(file), saved.findings());
  notices_.withdraw(kDiskNotice);
  rememberRecent(QStringLiteral("preset"), document_.file());
  emit this->saved(document_.file());
  return true;
}

bool DocumentController::save() {
  return document_.file().isEmpty() ? saveAs() : saveTo(document_.file());
}

bool DocumentController::saveAs() {
  QFileDialog dialog(&at_.window, tr("Save preset"), document_.file(), presetFilter());
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("json"));
  return dialog.exec() == QDialog::Accepted && saveTo(dialog.selectedFiles().constFirst());
}

bool DocumentController::mayLoseEdits() {
  if (!at_.draft.isDirty()) return true;
  QMessageBox box(QMessageBox::Question, tr("Trimtab"), tr("Save the changes to %1?").arg(document_.title()),
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, &at_.window);
  box.setInformativeText(tr("They are lost if you do not save them."));
  box.setDefaultButton(QMessageBox::Save);
  switch (box.exec()) {
    case QMessageBox::Save:
      return save();
    case QMessageBox::Discard:
      return true;
    default:
      return false;
  }
}

bool DocumentController::exportTo(const QString& file, ExportFormat format, const QString& author,
                                  const QString& comment) {
  if (at_.draft.isBroken()) {
    at_.messages.add(tr("Nothing is exported while the preset breaks a rule"), at_.draft.findings());
    return false;
  }
  Provenance provenance;
  provenance.author = author.toStdString();
  provenance.created = QDateTime::currentDateTimeUtc().toString(Qt::ISODate).toStdString();
  provenance.program = "trimtab " TRIMTAB_VERSION;
  provenance.terrain = terrainName_.toStdString();
  const std::string note = machineNote(*at_.draft.active());
  provenance.comment = comment.toStdString() + (comment.isEmpty() || note.empty() ? "" : " ") + note;
  const Result<ValidatedParameters> limited = limitedActive(at_.draft, document_.title().toStdString());
  if (!limited) {
    at_.messages.add(tr("Nothing is exported: the preset cannot be limited to the image generator"),
                     limited.findings());
    return false;
  }
  const QString name =
      document_.file().isEmpty() ? document_.title() : QFileInfo(document_.file()).completeBaseName();
  const std::string text = exportText(*limited, name.toStdString(), provenance, format);
  const QString absolute = QFileInfo(file).absoluteFilePath();
  const Result<Done> written = writeAtomically(absolute.toStdString(), text);
  if (!written) {
    at_.messages.add(tr("The export cannot be written: %1").arg(file), written.findings());
    return false;
  }
  Findings notes = written.findings();
  notes.insert(notes.end(), limited.findings().begin(), limited.findings().end());
  const IgProfile* const ig = at_.draft.imageGenerator();
  at_.messages.add(ig == nullptr ? tr("Exported to %1").arg(absolute)
                                 : tr("Exported to %1, limited to %2; the preset here stays as it is")
                                       .arg(absolute, QString::fromStdString(ig->name)),
                   notes);
  emit exported(absolute);
  return true;
}

void DocumentController::askExport() {
  ExportDialog dialog(target_, &at_.window);
  if (dialog.exec() != QDialog::Accepted) return;
  QString file = dialog.file();
  if (file.isEmpty()) {
    QFileDialog files(&at_.window, tr("Export preset"), {}, dialog.fileFilter());
    files.setAcceptMode(QFileDialog::AcceptSave);
    files.setDefaultSuffix(dialog.suffix());
    if (files.exec() != QDialog::Accepted) return;
    file = files.selectedFiles().constFirst();
  }
  const ExportTarget target{file, dialog.format(), dialog.author(), dialog.comment()};
  if (!exportTo(target)) return;
  target_ = target;
  if (!document_.file().isEmpty()) rememberTarget(document_.file(), target);
}

void DocumentController::exportAgain() {
  if (target_)
    exportTo(*target_);
  else
    askExport();
}

bool DocumentController::exportTo(const ExportTarget& target) {
  return exportTo(target.file, target.format, target.author, target.comment);
}

void DocumentController::offerRecovery() {
  for (const Document::Recovered& found : Document::abandoned()) {
    const QString what = found.file.isEmpty() ? tr("a new preset") : QFileInfo(found.file).fileName();
    notices_.ask(found.copy, tr("Unsaved edits of %1 from %2 were left behind.").arg(what, found.savedAt),
                 {{tr("&Recover"),
                   [this, found] {
                     if (!mayLoseEdits()) return offerRecovery();
                     if (const Result<Done> back = document_.recover(found); !back)
                       at_.messages.add(tr("The edits cannot be recovered"), back.findings());
                   }},
                  {tr("&Discard"), [found] { Document::discard(found); }},
                  {tr("Later"), {}}});
  }
}

void DocumentController::onChangedOnDisk(bool gone) {
  const QString name = QFileInfo(document_.file()).fileName();
  if (gone)
    return notices_.ask(kDiskNotice, tr("%1 is gone from the disk. Your edits are still here.").arg(name),
                        {{tr("&Save it again"), [this] { save(); }}, {tr("&Dismiss"), {}}});
  notices_.ask(kDiskNotice, tr("%1 was changed on disk by another program.").arg(name),
               {{at_.draft.isDirty() ? tr("&Reload and lose edits") : tr("&Reload"),
                 [this] { open(document_.file()); }},
                {tr("&Keep mine"), {}}});
}

}  // namespace trimtab::workbench
