// SPDX-License-Identifier: GPL-3.0-or-later
#include "head_controller.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QPushButton>

#include "app/workbench/dialogs/column_dialog.h"
#include "app/workbench/dialogs/column_memory.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/viewport/viewport.h"
#include "views/panels/motion_panel.h"

namespace trimtab::workbench {

using views::MotionPanel;

namespace {
constexpr int kRowsInQuestion = 3;  ///< bad rows that the question names
}

HeadController::HeadController(const Workplace& workplace, MotionPanel& panel)
    : at_(workplace), panel_(panel) {
  connect(&panel_, &MotionPanel::openLogAsked, this, &HeadController::askOpen);
  connect(&panel_, &MotionPanel::columnsAsked, this, &HeadController::askColumns);
  connect(&panel_, &MotionPanel::sourceAsked, this, &HeadController::use);
  connect(&at_.viewport, &Viewport::pointed, this,
          [this](QPointF place) { at_.feed.point(place.x(), place.y()); });
  connect(&at_.feed, &Feed::headChanged, this, &HeadController::showSource);
}

void HeadController::use(int source) {
  switch (source) {
    case MotionPanel::sweep:
      open(panel_.sweepText());
      return;
    case MotionPanel::pointer:
      return at_.feed.useHead(Feed::Head::pointer);
    case MotionPanel::none:
      return at_.feed.useHead(Feed::Head::none);
    default:
      return at_.feed.useHead(Feed::Head::host);
  }
}

void HeadController::showSource() {
  const HeadInput& head = at_.feed.session().head();
  at_.viewport.setPointerWanted(head.source() == Feed::Head::pointer);
  switch (head.source()) {
    case Feed::Head::host:
      return panel_.setSource(MotionPanel::host, {});
    case Feed::Head::pointer:
      return panel_.setSource(MotionPanel::pointer, {});
    case Feed::Head::none:
      return panel_.setSource(MotionPanel::none, {});
    case Feed::Head::log:
      break;
  }
  const QString name = QString::fromStdString(head.log().name);
  if (isSweep(head.log().name)) return panel_.setSource(MotionPanel::sweep, name);
  panel_.setSource(MotionPanel::log, tr("%1: %L2 samples, %3 s")
                                         .arg(name)
                                         .arg(head.log().samples.size())
                                         .arg(head.log().durationS(), 0, 'f', 1));
}

bool HeadController::open(const QString& fileOrSweep) {
  const bool sweep = isSweep(fileOrSweep.toStdString());
  const ColumnMap map = sweep ? ColumnMap{} : rememberedColumns(LogKind::head, fileOrSweep);
  Result<HeadLog> head = openHead(fileOrSweep.toStdString(), BadRows::refuse, map);
  if (!head) {
    at_.messages.add(tr("The line of sight is unchanged: %1 cannot be used").arg(fileOrSweep),
                     head.findings());
    showSource();
    if (!offerTheOtherRows(fileOrSweep, head.findings(), map) && !sweep &&
        (mapMayHelp(head.findings()) || !map.empty()))
      askColumnsOf(fileOrSweep, map);
    return false;
  }
  if (!map.empty())
    at_.messages.note(tr("%1 is read with the columns that were chosen for files with its header")
                          .arg(QFileInfo(fileOrSweep).fileName()));
  useLog(std::move(head), fileOrSweep, map);
  return true;
}

/// Opens a log with the columns that a person chose; a question about its rows decides later.
Findings HeadController::openWith(const QString& file, const ColumnMap& columns) {
  Result<HeadLog> head = openHead(file.toStdString(), BadRows::refuse, columns);
  if (!head) return offerTheOtherRows(file, head.findings(), columns) ? Findings{} : head.findings();
  useLog(std::move(head), file, columns);
  return {};
}

void HeadController::useLog(Result<HeadLog> log, const QString& file, const ColumnMap& columns) {
  if (!log.findings().empty())
    at_.messages.add(tr("Head log %1").arg(QFileInfo(file).fileName()), log.findings());
  if (!isSweep(log->name)) {
    file_ = file;
    columns_ = columns;
  }
  at_.feed.useHeadLog(std::move(log).value());
}

void HeadController::askColumns() {
  const QString file = file_.isEmpty() ? askFile() : file_;
  if (!file.isEmpty()) askColumnsOf(file, file == file_ ? columns_ : rememberedColumns(LogKind::head, file));
}

void HeadController::askColumnsOf(const QString& file, const ColumnMap& columns) {
  const auto openIt = [this, file](const ColumnMap& map) { return openWith(file, map); };
  if (const Findings findings = ColumnDialog::ask(LogKind::head, file, columns, openIt, at_.window);
      !findings.empty())
    at_.messages.add(tr("%1 has no columns to choose").arg(QFileInfo(file).fileName()), findings);
}

/// Returns false if leaving rows out does not help.
bool HeadController::offerTheOtherRows(const QString& file, const Findings& refusal,
                                       const ColumnMap& columns) {
  Result<HeadLog> rest = openHead(file.toStdString(), BadRows::leave_out, columns);
  if (!rest) return false;
  const auto rows = static_cast<int>(rest->rowsLeftOut);
  QStringList named;
  for (const Finding& finding : refusal)
    if (!finding.key.empty() && named.size() < kRowsInQuestion)
      named << QString::fromStdString(toString(finding));
  if (rows > named.size()) named << tr("The Messages dock lists more of them.");

  const QString name = QFileInfo(file).fileName();
  auto* box = new QMessageBox(QMessageBox::Question, tr("Head log"),
                              rows == 1 ? tr("1 row of %1 cannot be used.").arg(name)
                                        : tr("%L1 rows of %2 cannot be used.").arg(rows).arg(name),
                              QMessageBox::Cancel, &at_.window);
  box->setObjectName(QStringLiteral("badRows"));
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setInformativeText(named.join(QLatin1Char('\n')));
  const QAbstractButton* leave = box->addButton(
      rows == 1 ? tr("Leave 1 row out") : tr("Leave %L1 rows out").arg(rows), QMessageBox::AcceptRole);
  connect(leave, &QAbstractButton::clicked, this,
          [this, file, columns, log = std::move(rest)]() mutable { useLog(std::move(log), file, columns); });
  box->open();
  return true;
}

QString HeadController::askFile() {
  return QFileDialog::getOpenFileName(&at_.window, tr("Open head log"), {},
                                      tr("Head logs (*.csv *.txt);;All files (*)"));
}

void HeadController::askOpen() {
  const QString file = askFile();
  if (file.isEmpty())
    showSource();
  else
    open(file);
}

}  // namespace trimtab::workbench
