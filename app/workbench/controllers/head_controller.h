// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>

#include "trimtab/host/column_map.h"
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
  /// Messages dock if it cannot be used; the line of sight stays as it was. A dialog that does not wait for
  /// its answer asks for the columns if a map of them may help; if only some rows of a log cannot be used, a
  /// question offers to leave them out.
  bool open(const QString& fileOrSweep);

 private:
  QString askFile();
  void askOpen();
  void askColumns();
  void askColumnsOf(const QString& file, const ColumnMap& columns);
  Findings openWith(const QString& file, const ColumnMap& columns);
  void useLog(Result<HeadLog> log, const QString& file, const ColumnMap& columns);
  bool offerTheOtherRows(const QString& file, const Findings& refusal, const ColumnMap& columns);
  void use(int source);
  void showSource();

  Workplace at_;
  views::MotionPanel& panel_;
  QString file_;       ///< of the log that is or was used
  ColumnMap columns_;  ///< with which it was read
};

}  // namespace trimtab::workbench
