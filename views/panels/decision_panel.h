// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

class QLabel;
class QPushButton;
class QTableView;

namespace trimtab::views {

class BarList;
class DecisionLog;
class LeverChainTable;

/// The Decision dock: what was decided, from what and why, and a log of changes.
class DecisionPanel : public QWidget {
  Q_OBJECT
 public:
  explicit DecisionPanel(Draft& draft, QWidget* parent = nullptr);
  const DecisionLog& log() const { return *log_; }
  QTableView& logView() { return *view_; }
  LeverChainTable& levers() { return *levers_; }
  void showFrame(const LiveFrame& frame);
  /// Writes the whole log to a file. The findings say why it failed.
  Findings saveLog(const QString& file) const;

 public slots:
  void copyLog();  ///< copies the selected rows, or all if none is selected
  void clearLog();

 signals:
  void cullingAsked();  ///< the person wants the choices that leave the image without a depth map

 private:
  void refresh();
  void askAndSave();

  Draft& draft_;
  QLabel *scheme_, *reason_;
  QPushButton* lead_;
  QLabel* count_;
  LeverChainTable* levers_;
  BarList* memberships_;
  DecisionLog* log_;
  QTableView* view_;
  LiveFrame frame_;
  bool any_ = false;
  Throttle throttle_;
};

}  // namespace trimtab::views
