// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::workbench {

/// Opens or bakes terrain on a thread of its own, one terrain at a time. A second start cancels the first,
/// and begins when that has ended. Only the destructor waits for a thread.
class TerrainJob : public QObject {
  Q_OBJECT

 public:
  explicit TerrainJob(QObject* parent = nullptr);
  ~TerrainJob() override;

  /// Opens an elevation file, a folder of them, a CDB with what stands in it, or a database.
  /// `origin` is that of a flat OpenSceneGraph scene, LAT,LON.
  void open(const std::filesystem::path& source, const std::string& origin = {});
  /// Opens the built-in sample terrain. It is made and baked once per user.
  void openSample();
  /// Bakes a database and opens it. The same options again resume a bake that was stopped.
  void bake(terrain::BakeOptions options);
  using Work = std::function<Result<std::shared_ptr<const terrain::Database>>(const terrain::Progress&)>;
  /// Runs `work` like the functions above. It must ask its progress now and then whether to go on.
  void start(const std::filesystem::path& source, const QString& what, Work work);
  void cancel();
  bool running() const { return running_; }
  const std::filesystem::path& source() const { return source_; }

 signals:
  void started(const QString& what);
  /// Notes of what CDBs and scenery hold that are about to be baked.
  void found(const trimtab::Findings& notes);
  void progressed(double fraction, const QString& what);
  /// The findings are what is worth knowing about how it was opened or baked.
  void opened(std::shared_ptr<const trimtab::terrain::Database> database, const trimtab::Findings& findings);
  void failed(const trimtab::Findings& findings);
  void cancelled();

 private:
  void stop();
  /// Emits found() from a job's thread.
  void tell(const terrain::BakeOptions& options);

  std::filesystem::path source_;
  std::jthread thread_;                      ///< the last job's; it joins the thread before it
  std::shared_ptr<std::atomic<bool>> stop_;  ///< shared with the last job's thread; each job has its own
  bool running_ = false;
  int serial_ = 0;
};

}  // namespace trimtab::workbench
