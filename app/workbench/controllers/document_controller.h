// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>

#include "app/workbench/dialogs/export_dialog.h"
#include "document.h"
#include "workplace.h"

namespace trimtab::workbench {

class NoticeBar;

/// Opens, saves and exports the preset, and sees to it that no edit is lost unasked. Failures are reported in
/// the Messages dock and change nothing.
class DocumentController : public QObject {
  Q_OBJECT

 public:
  DocumentController(const Workplace& workplace, NoticeBar& notices);

  Document& document() { return document_; }

  /// Opens a shipped preset by its name, or a file. Returns false if it cannot be read.
  bool open(const QString& nameOrFile);
  /// Opens a preset with the edits that a session holds; see Document::openEdits. `session` is its file.
  bool openEdits(const QString& nameOrFile, const QString& text, const QString& session);
  bool saveTo(const QString& file);
  /// Saves to the preset's own file; asks for one if it has none. Returns false if nothing was saved.
  bool save();
  bool saveAs();
  /// Writes the active parameters for an image generator. Returns false while the draft breaks a rule, or if
  /// the file cannot be written. What depends on the machine joins the comment. With the profile of an image
  /// generator the export is limited to it, without a question: an export is for that image generator, and it
  /// could not follow the rest. The preset stays as it is.
  bool exportTo(const QString& file, ExportFormat format, const QString& author, const QString& comment);
  /// The terrain that an export names as the one it was tuned over.
  void setTerrainName(const QString& name) { terrainName_ = name; }

  // These ask first whether unsaved edits may be lost.
  void askOpen();
  void openOverEdits(const QString& nameOrFile);
  void startFrom(const QString& shipped);
  /// Asks for format, comment and file, exports, and remembers all of it for exportAgain().
  void askExport();
  /// Exports to the preset's last target without a question; asks if there is none.
  void exportAgain();
  /// Asks what to do with unsaved edits. Returns false if the person cancels, or if saving fails.
  bool mayLoseEdits();
  /// Offers the edits that programs left behind which ended without saving.
  void offerRecovery();

 signals:
  void saved(const QString& file);
  void exported(const QString& file);

 private:
  bool sayOpened(const QString& name, const Result<Done>& opened);
  void onChangedOnDisk(bool gone);
  bool exportTo(const ExportTarget& target);

  Workplace at_;
  NoticeBar& notices_;
  Document document_;
  QString terrainName_;
  std::optional<ExportTarget> target_;  ///< of the preset's last export
};

}  // namespace trimtab::workbench
