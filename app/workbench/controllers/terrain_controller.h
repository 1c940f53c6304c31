// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "app/workbench/jobs/terrain_job.h"
#include "trimtab/terrain/format/database.h"
#include "workplace.h"

namespace trimtab::views {
class StaticLodPanel;
class TerrainPanel;
}  // namespace trimtab::views

namespace trimtab::workbench {

/// Opens and bakes terrain, and tells the Terrain dock what it is.
class TerrainController : public QObject {
  Q_OBJECT

 public:
  TerrainController(const Workplace& workplace, views::TerrainPanel& panel, views::StaticLodPanel& trees);

  /// Starts to open an elevation file, a folder of them, scenery or a database. Failures are reported in the
  /// Messages dock, and the terrain stays as it was.
  void open(const QString& source, const QString& origin = {});
  void openSample();
  void askOpenFile();
  void askOpenFolder();
  void askBake();

  TerrainJob& job() { return job_; }
  /// Null until a terrain is open.
  const std::shared_ptr<const terrain::Database>& database() const { return database_; }
  /// The file or folder that the open terrain comes from.
  const QString& openedFrom() const { return openedFrom_; }
  /// What a person opened to see this terrain: a file, a folder, or a database; empty for the sample.
  const QString& askedFor() const { return askedFor_; }

 signals:
  /// Another terrain is open; the viewport and the session have it.
  void opened();

 private:
  void connectJob();
  /// Asks where the flat scene that was asked for is, and opens it there.
  void askOrigin();
  void use(std::shared_ptr<const terrain::Database> database, const Findings& findings);
  void reportDamage();

  Workplace at_;
  views::TerrainPanel& panel_;
  views::StaticLodPanel& trees_;
  TerrainJob job_;
  std::shared_ptr<const terrain::Database> database_;
  QString asked_;  ///< what a person asked for last; empty for the sample
  QString openedFrom_, askedFor_;
  std::uint64_t failedPages_ = 0;
  Findings damageReported_;  ///< in the Messages dock
};

}  // namespace trimtab::workbench
