// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QPointer>
#include <QThread>
#include <functional>
#include <memory>

#include "trimtab/scene/error_meter.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::workbench {

/// A thread with a GL context of its own, without a window, in which pictures are drawn and measured while
/// the viewport's go on: measuring takes many times as long as the picture that is measured, and nobody who
/// flies should see it. It steps back where the processor is short.
class DrawThread : public QObject {
  Q_OBJECT

 public:
  explicit DrawThread(QObject* parent = nullptr);
  /// Waits for the work at hand.
  ~DrawThread() override;

  /// Holds for all work asked for later.
  void setTerrain(std::shared_ptr<const terrain::Database> terrain);
  /// `work` runs there, in turn; then `done` here, unless `receiver` is gone by then. Neither is called where
  /// no context can be made.
  void run(std::function<void(scene::ErrorMeter&)> work, QObject* receiver, std::function<void()> done);
  bool usable() const { return missing_.empty(); }
  /// Why no context can be made; empty while none was needed or it was made.
  const Findings& missing() const { return missing_; }

 signals:
  /// No context can be made, told once.
  void failed(const trimtab::Findings& findings);

 private:
  struct Inside;

  QThread thread_;
  QObject* worker_;
  std::unique_ptr<Inside> inside_;  ///< of the thread's alone while it runs
  Findings missing_;
};

}  // namespace trimtab::workbench
