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

/// Opens or bakes terrain on a thread of its own. One at a time: a second start cancels the first, and begins
/// when that has ended; nothing waits for it but the destructor.
class TerrainJob : public QObject {
  Q_OBJECT

 public:
  explicit TerrainJob(QObject* parent = nullptr);
  ~TerrainJob() override;

  /// Elevation file, folder of them, or database.
  void open(const std::filesystem::path& source);
  /// The embedded default terrain, made and baked once for a user.
  void openSample();
  /// Makes a database and opens it; the same options again go on with one that was stopped.
  void bake(terrain::BakeOptions options);
  using Work = std::function<Result<std::shared_ptr<const terrain::Database>>(const terrain::Progress&)>;
  /// What the others do: `work` is to ask its progress whether to go on.
  void start(const std::filesystem::path& source, const QString& what, Work work);
  void cancel();
  bool running() const { return running_; }
  const std::filesystem::path& source() const { return source_; }

 signals:
  void started(const QString& what);
  void progressed(double fraction, const QString& what);
  /// With what is worth knowing of how it was opened or baked.
  void opened(std::shared_ptr<const trimtab::terrain::Database> database, const trimtab::Findings& findings);
  void failed(const trimtab::Findings& findings);
  void cancelled();

 private:
  void stop();

  std::filesystem::path source_;
  std::jthread thread_;                      ///< the last job's, which joins the one before it
  std::shared_ptr<std::atomic<bool>> stop_;  ///< shared with the last job's thread; each job has another
  bool running_ = false;
  int serial_ = 0;
};

}  // namespace trimtab::workbench
