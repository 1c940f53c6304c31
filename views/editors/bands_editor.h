// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "views/model/draft.h"
#include "views/model/live.h"

class QTableView;
class QToolButton;

namespace trimtab::views {

class BandScale;
class ListModel;
class NoteLine;
class Throttle;

/// The bands of the depth map with edges to drag, their sizes, and the hysteresis.
class BandsEditor : public QWidget {
  Q_OBJECT
 public:
  explicit BandsEditor(Draft& draft, QWidget* parent = nullptr);
  BandScale& scale() { return *scale_; }
  QTableView& table() { return *table_; }
  void showFrame(const LiveFrame& frame);

 private:
  void showNote();
  void say(const QString& refusal);

  Draft& draft_;
  BandScale* scale_;
  ListModel* model_;
  QTableView* table_;
  NoteLine* note_;
  QToolButton* remove_;
  Throttle* throttle_;
  QString refusal_;
  FrameDecision decision_;
};

}  // namespace trimtab::views
