// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "curve_edit.h"
#include "views/model/draft.h"
#include "views/model/live.h"

class QTableView;
class QToolButton;

namespace trimtab::views {

class CurvePlot;
class NoteLine;

/// Edits one membership curve: its reading, the plot, and a table of the breakpoints.
class CurveEditor : public QWidget {
  Q_OBJECT
 public:
  CurveEditor(Draft& draft, const CurveSpec& spec, const QList<QWidget*>& extra, QWidget* parent = nullptr);
  CurvePlot& plot() { return *plot_; }
  QTableView& table() { return *table_; }
  void showFrame(const LiveFrame& frame);

 private:
  void showNote();
  void say(const QString& refusal);

  Draft& draft_;
  CurveSpec spec_;
  CurvePlot* plot_;
  QTableView* table_;
  NoteLine* note_;
  QToolButton *add_, *remove_;
  QString refusal_;
};

/// The Memberships dock: the curve of altitude above that of pitch.
class MembershipEditor : public QWidget {
  Q_OBJECT
 public:
  explicit MembershipEditor(Draft& draft, QWidget* parent = nullptr);
  CurveEditor& altitude() { return *altitude_; }
  CurveEditor& pitch() { return *pitch_; }
  void showFrame(const LiveFrame& frame);

 private:
  CurveEditor *altitude_, *pitch_;
};

}  // namespace trimtab::views
