// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>

#include "trimtab/host/head_log.h"
#include "trimtab/units/result.h"
#include "workplace.h"

namespace trimtab::views {
class MotionPanel;
}

namespace trimtab::workbench {

/// Chooses where the line of sight comes from: the host, a head log, a sweep, or the mouse pointer.
class HeadController : public QObject {
  Q_OBJECT

 public:
  HeadController(const Workplace& workplace, views::MotionPanel& panel);

  /// Opens a head log, or a sweep in the form that `--head` accepts. Returns false and reports in the
  /// Messages dock if it cannot be used; the line of sight stays as it was. If only some rows of a log cannot
  /// be used, a question that does not wait for its answer offers to leave them out.
  bool open(const QString& fileOrSweep);

 private:
  void askOpen();
  void useLog(Result<HeadLog> log, const QString& file);
  void offerTheOtherRows(const QString& file, const Findings& refusal);
  void use(int source);
  void showSource();

  Workplace at_;
  views::MotionPanel& panel_;
};

}  // namespace trimtab::workbench
