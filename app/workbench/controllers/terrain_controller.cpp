// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain_controller.h"

#include <QFileDialog>
#include <QFileInfo>
#include <algorithm>

#include "app/workbench/dialogs/bake_dialog.h"
#include "app/workbench/dialogs/origin_dialog.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/viewport/viewport.h"
#include "recent_files.h"
#include "terrain_summary.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/scene/osg_database.h"
#include "trimtab/terrain/bake/bake.h"

namespace trimtab::workbench {

TerrainController::TerrainController(const Workplace& workplace, views::TerrainPanel& panel,
                                     views::StaticLodPanel& trees)
    : at_(workplace), panel_(panel), trees_(trees) {
  connectJob();
  connect(&at_.viewport, &Viewport::painted, this, &TerrainController::reportDamage);
}

void TerrainController::connectJob() {
  using Panel = views::TerrainPanel;
  connect(&panel_, &Panel::cancelAsked, &job_, &TerrainJob::cancel);
  connect(&job_, &TerrainJob::started, this, [this](const QString& what) {
    panel_.showJob(0, what);
    if (!database_) at_.viewport.setNotice(tr("%1...").arg(what));
  });
  connect(&job_, &TerrainJob::found, this,
          [this](const Findings& notes) { at_.messages.add(tr("What the sources hold"), notes); });
  connect(&job_, &TerrainJob::progressed, &panel_, &Panel::showJob);
  connect(&job_, &TerrainJob::cancelled, &panel_, &Panel::endJob);
  connect(&job_, &TerrainJob::opened, &panel_, &Panel::endJob);
  connect(&job_, &TerrainJob::failed, &panel_, &Panel::endJob);

  const QString hint =
      tr("No terrain is open.\nFile > Open terrain, or drop an elevation file or a folder here.");
  connect(&job_, &TerrainJob::cancelled, this, [this, hint] {
    at_.messages.note(tr("Cancelled: the terrain is unchanged"));
    at_.viewport.setNotice(hint);
  });
  connect(&job_, &TerrainJob::failed, this, [this, hint](const Findings& findings) {
    if (scene::lacksOrigin(findings)) return askOrigin();
    at_.messages.add(tr("The terrain cannot be opened"), findings);
    at_.viewport.setNotice(hint);
  });
  connect(&job_, &TerrainJob::opened, this, &TerrainController::use);
}

void TerrainController::open(const QString& source, const QString& origin) {
  asked_ = QFileInfo(source).absoluteFilePath();
  job_.open(asked_.toStdString(), origin.toStdString());
}

void TerrainController::askOrigin() {
  auto* const dialog = new OriginDialog(asked_, &at_.window);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &OriginDialog::given, this,
          [this, file = asked_](const QString& origin) { open(file, origin); });
  connect(dialog, &QDialog::rejected, &job_, &TerrainJob::cancelled);
  dialog->open();
}

void TerrainController::openSample() {
  asked_.clear();
  job_.openSample();
}

void TerrainController::askOpenFile() {
  const QString picked = QFileDialog::getOpenFileName(
      &at_.window, tr("Open terrain"), folderOfRecent(QStringLiteral("terrain")),
      tr("Elevation and scenery (*.tif *.tiff *.hgt *.dt0 *.dt1 *.dt2 *.img *.zip *.btg *.btg.gz *.stg);;"
         "OpenSceneGraph scenes (*.ive *.osgb *.osgt *.osg *.txp *.flt);;"
         "All files (*)"));
  if (!picked.isEmpty()) open(picked);
}

void TerrainController::askOpenFolder() {
  const QString picked = QFileDialog::getExistingDirectory(
      &at_.window, tr("Open a folder of elevation files, scenery or a CDB, or a database"));
  if (!picked.isEmpty()) open(picked);
}

void TerrainController::askBake() {
  BakeDialog dialog(&at_.window);
  if (dialog.exec() != QDialog::Accepted) return;
  terrain::BakeOptions options = dialog.options();
  asked_ = QFileInfo(QString::fromStdString(options.output.string())).absoluteFilePath();
  job_.bake(std::move(options));
}

void TerrainController::use(std::shared_ptr<const terrain::Database> database, const Findings& findings) {
  database_ = std::move(database);
  openedFrom_ = QString::fromStdString(job_.source().string());
  askedFor_ = asked_;
  if (!asked_.isEmpty()) rememberRecent(QStringLiteral("terrain"), asked_);
  const terrain::TerrainInfo& info = database_->info();
  const bool foreign = std::dynamic_pointer_cast<const scene::OsgDatabase>(database_) != nullptr;
  if (foreign)
    at_.messages.note(
        tr("Scene %1, drawn by OpenSceneGraph: LOD scale, allowed error, small features, far distance, "
           "render scale, particles and blur act on it; levels, cases of culling and hidden ground do not")
            .arg(QString::fromStdString(info.name)));
  else
    at_.messages.note(tr("Terrain %1: %L2 × %L3 posts, %L4 to %L5 m, %L6 voids filled")
                          .arg(QString::fromStdString(info.name))
                          .arg(info.columns)
                          .arg(info.rows)
                          .arg(info.lowest.value(), 0, 'f', 0)
                          .arg(info.highest.value(), 0, 'f', 0)
                          .arg(info.voidsFilled));
  at_.feed.setGround(database_);
  at_.feed.session().setLoadIndex(scene::loadIndexOf(database_));
  at_.viewport.setTerrain(database_);
  trees_.setTrees(treesOf(*database_));
  panel_.setTerrain(summaryOf(*database_));
  failedPages_ = 0;
  damageReported_.clear();
  emit opened();
  if (!findings.empty()) at_.messages.add(tr("Opened %1").arg(QFileInfo(openedFrom_).fileName()), findings);
}

/// Damage shows only while its place is read, so it is looked for after each image.
void TerrainController::reportDamage() {
  if (!database_ || !at_.viewport.lastResult()) return;
  Findings damage = database_->damage();
  // These may also be unreadable for want of memory.
  if (const std::uint64_t failed = at_.viewport.lastResult()->paging.failed; failed != failedPages_) {
    failedPages_ = failed;
    for (Finding& finding : at_.viewport.pageFailures()) damage.push_back(std::move(finding));
  }
  Findings fresh;
  for (const Finding& finding : damage)
    if (std::find(damageReported_.begin(), damageReported_.end(), finding) == damageReported_.end()) {
      fresh.push_back(finding);
      damageReported_.push_back(finding);
    }
  if (!fresh.empty())
    at_.messages.add(tr("The terrain is damaged: its lowest ground or a coarser form is drawn there"), fresh);
}

}  // namespace trimtab::workbench
