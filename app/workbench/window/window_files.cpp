// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAction>
#include <QDateTime>
#include <QDir>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QMessageBox>
#include <QMimeData>
#include <QSettings>
#include <QStatusBar>

#include "app/workbench/dialogs/export_dialog.h"
#include "app/workbench/docks/error_dock.h"
#include "app/workbench/docks/experiments_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/viewport/split_view.h"
#include "main_window.h"
#include "notice_bar.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/static_lod.h"
#include "views/panels/static_lod_panel.h"

// Files: presets, terrain, flights, traces, and what happens to edits that are not saved.
namespace trimtab::workbench {
namespace {

const QString kPresetFilter = MainWindow::tr("Presets (*.json);;All files (*)");

}  // namespace

ExportFormat exportFormatOf(const QString& file) {
  const QString ending = QFileInfo(file).suffix().toLower();
  return ending == QLatin1String("xml")   ? ExportFormat::xml
         : ending == QLatin1String("ini") ? ExportFormat::ini
                                          : ExportFormat::json;
}

bool MainWindow::openPreset(const QString& nameOrFile) {
  const Result<Done> opened = document_.open(nameOrFile);
  if (!opened) {
    messages_->add(tr("The preset cannot be opened: %1").arg(nameOrFile), opened.findings());
    return false;
  }
  if (!opened.findings().empty()) messages_->add(tr("Opened %1").arg(nameOrFile), opened.findings());
  if (!document_.file().isEmpty()) remember(QStringLiteral("preset"), document_.file());
  return true;
}

bool MainWindow::savePreset(const QString& file) {
  const Result<Done> saved = document_.save(file);
  if (!saved) {
    messages_->add(tr("The preset cannot be saved: %1").arg(file), saved.findings());
    return false;
  }
  notices_->withdraw(QStringLiteral("disk"));
  remember(QStringLiteral("preset"), document_.file());
  statusBar()->showMessage(tr("Saved %1").arg(document_.file()), 4000);
  return true;
}

bool MainWindow::save() {
  return document_.file().isEmpty() ? saveAs() : savePreset(document_.file());
}

bool MainWindow::saveAs() {
  QFileDialog dialog(this, tr("Save preset"), document_.file(), kPresetFilter);
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("json"));
  return dialog.exec() == QDialog::Accepted && savePreset(dialog.selectedFiles().constFirst());
}

bool MainWindow::mayLoseEdits() {
  if (!draft_.isDirty()) return true;
  QMessageBox box(QMessageBox::Question, tr("Trimtab"), tr("Save the changes to %1?").arg(document_.title()),
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, this);
  box.setInformativeText(tr("Otherwise they are lost."));
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

void MainWindow::askOpenPreset() {
  if (!mayLoseEdits()) return;
  const QString file = QFileDialog::getOpenFileName(this, tr("Open preset"), document_.file(), kPresetFilter);
  if (!file.isEmpty()) openPreset(file);
}

void MainWindow::openTerrain(const QString& source) {
  terrainSource_ = QFileInfo(source).absoluteFilePath();
  terrainJob_.open(terrainSource_.toStdString());
}

void MainWindow::askOpenTerrain(bool folder) {
  const QString picked =
      folder
          ? QFileDialog::getExistingDirectory(
                this, tr("Open a folder of elevation files or scenery, or a database"))
          : QFileDialog::getOpenFileName(
                this, tr("Open terrain"), {},
                tr("Elevation and scenery (*.tif *.tiff *.hgt *.dt0 *.dt1 *.dt2 *.img *.zip *.btg *.btg.gz "
                   "*.stg);;All files (*)"));
  if (!picked.isEmpty()) openTerrain(picked);
}

namespace {

std::optional<views::StaticLodSummary> summaryOf(const terrain::StaticLodTerrain* trees) {
  if (trees == nullptr) return std::nullopt;
  const terrain::StaticLodCounts& c = trees->counts;
  return views::StaticLodSummary{.trianglesPerNode = trees->trianglesPerNode,
                                 .levels = c.levels,
                                 .tiles = trees->tiles.size(),
                                 .nodes = trees->index.size(),
                                 .sourceTriangles = c.sourceTriangles,
                                 .faces = c.faces,
                                 .distinctFaces = c.distinctFaces,
                                 .lockedMinima = c.lockedMinima,
                                 .bytes = c.bytes,
                                 .facesOfLevel = c.facesOfLevel};
}

}  // namespace

void MainWindow::onTerrainOpened(std::shared_ptr<const terrain::Database> database) {
  terrain_ = std::move(database);
  openedTerrain_ = QString::fromStdString(terrainJob_.source().string());
  frozenEye_.reset();
  freezeAction_->setChecked(false);
  if (!terrainSource_.isEmpty()) remember(QStringLiteral("terrain"), terrainSource_);
  const terrain::TerrainInfo& info = terrain_->info();
  messages_->note(tr("Terrain %1: %L2 × %L3 posts, %L4 to %L5 m, %L6 voids filled")
                      .arg(QString::fromStdString(info.name))
                      .arg(info.columns)
                      .arg(info.rows)
                      .arg(info.lowest.value(), 0, 'f', 0)
                      .arg(info.highest.value(), 0, 'f', 0)
                      .arg(info.voidsFilled));
  feed_.session().setGround(terrain_);
  viewport_->setTerrain(terrain_);
  measuring_.setTerrain(terrain_);
  errors_->restartLive();
  if (split_ != nullptr) split_->setTerrain(terrain_);
  staticLod_->setTrees(summaryOf(terrain_->staticLod().get()));
  pagesFailed_ = damageTold_ = 0;
  showTerrain();
  placeCamera();
  feed_.look(viewport_->camera());
  updateTitle();
}

bool MainWindow::openFlight(const QString& file) {
  const Findings findings = flightDock_->open(QFileInfo(file).absoluteFilePath());
  bool refused = false;
  for (const Finding& finding : findings) refused = refused || finding.severity == Severity::error;
  if (refused) {
    messages_->add(tr("The flight cannot be opened: %1").arg(file), findings);
    return false;
  }
  if (!findings.empty()) messages_->add(tr("Opened flight %1").arg(QFileInfo(file).fileName()), findings);
  dock(QStringLiteral("flight"))->show();
  dock(QStringLiteral("flight"))->raise();
  remember(QStringLiteral("flight"), QFileInfo(file).absoluteFilePath());
  return true;
}

void MainWindow::askOpenFlight() {
  const QString file = QFileDialog::getOpenFileName(this, tr("Open flight"), {},
                                                    tr("Flights and captures (*.csv *.pcap);;All files (*)"));
  if (!file.isEmpty()) openFlight(file);
}

void MainWindow::openAny(const QString& path) {
  const QFileInfo info(path);
  const QString ending = info.suffix().toLower();
  if (info.isFile() && info.fileName() == QLatin1String("results.json")) {
    if (errors_->openResults(path)) raiseErrors();
  } else if (info.isFile() && ending == QLatin1String("json")) {
    if (mayLoseEdits()) openPreset(path);
  } else if (info.isFile() && (ending == QLatin1String("csv") || ending == QLatin1String("pcap"))) {
    openFlight(path);
  } else {
    openTerrain(path);
  }
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  for (const QUrl& url : event->mimeData()->urls()) {
    if (url.isLocalFile())
      openAny(url.toLocalFile());
    else
      messages_->add(
          tr("Only files of this machine can be dropped"),
          {{Severity::error, url.toString().toStdString(), "", "a local file", url.scheme().toStdString()}});
  }
  event->acceptProposedAction();
}

bool MainWindow::exportPreset(const QString& file, ExportFormat format, const QString& author,
                              const QString& comment) {
  if (draft_.isBroken()) {
    messages_->add(tr("Nothing is exported while the preset breaks a rule"), draft_.findings());
    return false;
  }
  Provenance provenance;
  provenance.author = author.toStdString();
  provenance.created = QDateTime::currentDateTimeUtc().toString(Qt::ISODate).toStdString();
  provenance.program = "trimtab " TRIMTAB_VERSION;
  provenance.terrain = terrain_ ? terrain_->info().name : std::string();
  provenance.comment = comment.toStdString();
  const QString name =
      document_.file().isEmpty() ? document_.title() : QFileInfo(document_.file()).completeBaseName();
  const std::string text = exportText(draft_.active(), name.toStdString(), provenance, format);
  const QString absolute = QFileInfo(file).absoluteFilePath();
  if (const Result<Done> written = writeAtomically(absolute.toStdString(), text); !written) {
    messages_->add(tr("The export cannot be written: %1").arg(file), written.findings());
    return false;
  }
  messages_->note(tr("Exported to %1").arg(absolute));
  return true;
}

void MainWindow::askExport() {
  ExportDialog dialog(this);
  if (dialog.exec() != QDialog::Accepted) return;
  QFileDialog files(this, tr("Export preset"), {}, dialog.fileFilter());
  files.setAcceptMode(QFileDialog::AcceptSave);
  files.setDefaultSuffix(dialog.suffix());
  if (files.exec() == QDialog::Accepted)
    exportPreset(files.selectedFiles().constFirst(), dialog.format(), dialog.author(), dialog.comment());
}

bool MainWindow::startTrace(const QString& file) {
  stopTrace();
  Result<TraceWriter> writer = TraceWriter::open(file.toStdString());
  if (!writer) {
    messages_->add(tr("The trace cannot be written: %1").arg(file), writer.findings());
    traceAction_->setChecked(false);
    return false;
  }
  trace_.emplace(std::move(writer).value());
  traceFile_ = QFileInfo(file).absoluteFilePath();
  traceCount_ = 0;
  feed_.session().keepRows(true);
  traceAction_->setChecked(true);
  messages_->note(tr("Recording the trace to %1").arg(QFileInfo(file).absoluteFilePath()));
  return true;
}

std::optional<ExperimentInputs> MainWindow::experimentInputs(const QString& folder) {
  if (!terrain_) return std::nullopt;
  ExperimentInputs inputs{openedTerrain_, {}, folder + "/preset.json"};
  const auto write = [this](const QString& file, const std::string& text) {
    const auto written = writeAtomically(file.toStdString(), text);
    if (!written) messages_->add(tr("The experiment's input cannot be written"), written.findings());
    return written.ok();
  };
  const std::string name = document_.title().toStdString();
  if (!write(inputs.preset, exportText(draft_.active(), name, {}, ExportFormat::json))) return std::nullopt;
  if (const Flight& flight = feed_.playback().flight(); !flight.states.empty()) {
    // The file holds more than the states: a trace its cost, a capture what the CSV has no columns for.
    inputs.flight = flightDock_->file();
    if (!inputs.flight.isEmpty()) return inputs;
    inputs.flight = folder + "/flight.csv";
    if (!write(inputs.flight, flightCsv(flight))) return std::nullopt;
  }
  return inputs;
}

void MainWindow::drainTrace(bool all) {
  if (!trace_) return;
  traceRows_.clear();
  feed_.session().takeRows(traceRows_, all);
  for (const TraceRow& row : traceRows_) trace_->write(row);
  traceCount_ += traceRows_.size();
}

void MainWindow::stopTrace() {
  if (!trace_) return;
  drainTrace(true);
  feed_.session().keepRows(false);
  const Result<Done> closed = trace_->close();
  trace_.reset();
  if (traceAction_ != nullptr) traceAction_->setChecked(false);
  if (!closed) return messages_->add(tr("The trace is not complete"), closed.findings());
  recordedTrace_ = traceFile_;
  messages_->note(tr("Trace recorded: %L1 rows").arg(traceCount_));
}

void MainWindow::askTrace() {
  if (trace_) return stopTrace();
  traceAction_->setChecked(false);
  QFileDialog dialog(this, tr("Record trace"), {}, tr("Traces (*.csv)"));
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("csv"));
  if (dialog.exec() == QDialog::Accepted) startTrace(dialog.selectedFiles().constFirst());
}

void MainWindow::offerRecovery() {
  for (const Document::Recovered& found : Document::abandoned()) {
    const QString what = found.file.isEmpty() ? tr("a new preset") : QFileInfo(found.file).fileName();
    notices_->ask(found.copy, tr("Unsaved edits of %1 from %2 were left behind.").arg(what, found.savedAt),
                  {{tr("&Recover"),
                    [this, found] {
                      if (!mayLoseEdits()) return offerRecovery();
                      if (const Result<Done> back = document_.recover(found); !back)
                        messages_->add(tr("The edits cannot be recovered"), back.findings());
                    }},
                   {tr("&Discard"), [found] { Document::discard(found); }},
                   {tr("&Later"), {}}});
  }
}

void MainWindow::onChangedOnDisk(bool gone) {
  const QString id = QStringLiteral("disk"), name = QFileInfo(document_.file()).fileName();
  if (gone)
    return notices_->ask(id, tr("%1 is gone from the disk. Your edits are still here.").arg(name),
                         {{tr("&Save it again"), [this] { save(); }}, {tr("&Dismiss"), {}}});
  notices_->ask(id, tr("%1 was changed on disk by another program.").arg(name),
                {{draft_.isDirty() ? tr("&Reload and lose edits") : tr("&Reload"),
                  [this] { openPreset(document_.file()); }},
                 {tr("&Keep mine"), {}}});
}

void MainWindow::updateTitle() {
  const QString terrain =
      terrain_ ? QStringLiteral(" – ") + QString::fromStdString(terrain_->info().name) : QString();
  setWindowTitle(document_.title() + QStringLiteral("[*]") + terrain + QStringLiteral(" – Trimtab"));
  setWindowModified(draft_.isDirty());
}

}  // namespace trimtab::workbench
