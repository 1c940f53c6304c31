// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QPointer>
#include <QThread>
#include <functional>
#include <memory>
#include <vector>

#include "trimtab/scene/error_meter.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::workbench {

/// Draws and measures images on a thread with a GL context of its own and no window. Measuring takes many
/// times as long as drawing, and nobody who flies should notice it: where the processor is short, the thread
/// lets the viewport go first.
class DrawThread : public QObject {
  Q_OBJECT

 public:
  explicit DrawThread(QObject* parent = nullptr);
  /// Waits for the work that is running.
  ~DrawThread() override;

  /// Applies to all work that is requested later.
  void setTerrain(std::shared_ptr<const terrain::Database> terrain);
  /// Queues `work` to run on that thread, and then `done` on this one, unless `receiver` is gone by then.
  /// Neither is called if no context can be made.
  void run(std::function<void(scene::ErrorMeter&)> work, QObject* receiver, std::function<void()> done);
  /// While this is on, work waits: something else measures times. What runs already ends.
  void setHeld(bool held);
  bool usable() const { return missing_.empty(); }
  /// Returns why no context can be made; empty if it was made, or was not needed yet.
  const Findings& missing() const { return missing_; }

 signals:
  /// No context can be made. Emitted once.
  void failed(const trimtab::Findings& findings);

 private:
  struct Inside;

  QThread thread_;
  QObject* worker_;
  std::unique_ptr<Inside> inside_;  ///< used by the thread alone while it runs
  bool held_ = false;
  std::vector<std::function<void()>> waiting_;  ///< what was requested while held, in order
  Findings missing_;
};

}  // namespace trimtab::workbench
