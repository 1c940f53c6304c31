// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "views/controls/reason_list.h"
#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

class QComboBox;
class QLabel;
class QLineEdit;
class QPushButton;

namespace trimtab::views {

class BarList;
class MotionPlot;

/// The page Head motion: where the head comes from, its rate and the threshold of Eq. (1), both stacks and
/// their limits, LOD scale and blur, and the reason of each change.
class MotionPanel : public QWidget {
  Q_OBJECT
 public:
  enum Source { host, log, sweep, pointer, none };

  explicit MotionPanel(Draft& draft, QWidget* parent = nullptr);

  void showFrame(const LiveFrame& frame);
  /// Shows the source in use, without emitting signals. `name` is that of a log or sweep.
  void setSource(Source source, const QString& name);
  Source source() const;
  /// Returns the sweep as `--head` accepts it.
  QString sweepText() const;

  QComboBox& sourceBox() { return *source_; }
  QLineEdit& sweepEdit() { return *sweep_; }
  QListWidget& reasons() { return *reasons_; }
  BarList& bars() { return *bars_; }
  MotionPlot& plot() { return *plot_; }
  QString stateText() const;

 signals:
  void sourceAsked(int source);  ///< the person chose another source, or changed the sweep
  void openLogAsked();
  void columnsAsked();  ///< the person wants to say which columns of the log are what

 private:
  void refresh();
  void showWidgetsOf(Source source);

  Draft& draft_;
  QComboBox* source_;
  QPushButton *open_, *columns_;
  QLabel *name_, *state_;
  QLineEdit* sweep_;
  BarList* bars_;
  MotionPlot* plot_;
  ReasonList* reasons_;
  MotionDecision motion_;  ///< of the last frame
  bool any_ = false;
  Throttle throttle_;
};

}  // namespace trimtab::views
