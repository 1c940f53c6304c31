// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>
#include <cstdint>
#include <optional>
#include <vector>

#include "trimtab/measure/trace_file.h"
#include "workplace.h"

namespace trimtab::workbench {

class FrameController;

/// Records a trace: one CSV row for each state that is decided, with what it cost.
class TraceController : public QObject {
  Q_OBJECT

 public:
  TraceController(const Workplace& workplace, const FrameController& frame);

  /// Starts a trace, after stopping one that is being recorded. Returns false and reports in the Messages
  /// dock if the file cannot be written. A file of that name stays until the trace is whole (TraceFile).
  bool start(const QString& file);
  /// Writes the rows that are left and closes the file. Does nothing if no trace is being recorded.
  void stop();
  /// Stops the trace that is being recorded, or asks for a file and starts one.
  void askOrStop();
  /// The last trace that was recorded to its end; empty if there is none.
  const QString& recorded() const { return recorded_; }

 signals:
  void recordingChanged(bool recording);

 private:
  void write(bool all);

  Workplace at_;
  std::optional<TraceFile> writer_;
  std::vector<TraceRow> rows_;
  std::uint64_t count_ = 0;
  QString file_, recorded_;
};

}  // namespace trimtab::workbench
