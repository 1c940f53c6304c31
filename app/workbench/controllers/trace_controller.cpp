// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace_controller.h"

#include <QFileDialog>
#include <QFileInfo>

#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "frame_controller.h"
#include "recent_files.h"

namespace trimtab::workbench {

TraceController::TraceController(const Workplace& workplace, const FrameController& frame) : at_(workplace) {
  connect(&frame, &FrameController::painted, this, [this] { write(false); });
}

bool TraceController::start(const QString& file) {
  stop();
  Result<TraceFile> writer = TraceFile::open(file.toStdString());
  if (!writer) {
    at_.messages.add(tr("The trace cannot be written: %1").arg(file), writer.findings());
    emit recordingChanged(false);
    return false;
  }
  writer_.emplace(std::move(writer).value());
  file_ = QFileInfo(file).absoluteFilePath();
  count_ = 0;
  at_.feed.session().keepRows(true);
  emit recordingChanged(true);
  at_.messages.note(tr("Recording the trace to %1").arg(file_));
  return true;
}

/// Rows that no image has shown yet are written only at the end (`all`).
void TraceController::write(bool all) {
  if (!writer_) return;
  rows_.clear();
  at_.feed.session().takeRows(rows_, all);
  if (const Result<Done> written = writer_->write(rows_); !written)
    at_.messages.add(tr("The trace is no longer recorded"), written.findings());
  count_ += rows_.size();
}

void TraceController::stop() {
  if (!writer_) return;
  write(true);
  at_.feed.session().keepRows(false);
  const Result<Done> closed = writer_->finish();
  writer_.reset();
  if (closed) {
    recorded_ = file_;
    // A trace can be flown.
    rememberRecent(QStringLiteral("flight"), QFileInfo(file_).absoluteFilePath());
  }
  emit recordingChanged(false);
  if (!closed) return at_.messages.add(tr("The trace is not complete"), closed.findings());
  at_.messages.note(tr("Trace recorded: %L1 rows").arg(count_));
}

void TraceController::askOrStop() {
  if (writer_) return stop();
  // The menu's check mark was set by the click; it must not stand while nothing is recorded.
  emit recordingChanged(false);
  QFileDialog dialog(&at_.window, tr("Record trace"), {}, tr("Traces (*.csv)"));
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("csv"));
  if (dialog.exec() == QDialog::Accepted) start(dialog.selectedFiles().constFirst());
}

}  // namespace trimtab::workbench
