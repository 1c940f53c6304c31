// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QWidget>

#include "views/model/draft.h"
#include "views/model/live.h"

class QTableView;
class QToolButton;

namespace trimtab::views {

class BandScale;
class BandsModel;
class DepthMapInset;
class NoteLine;
class Throttle;

/// The Depth map dock: bands with edges to drag, their sizes, the hysteresis, and the live depth map.
class BandsEditor : public QWidget {
  Q_OBJECT
 public:
  explicit BandsEditor(Draft& draft, QWidget* parent = nullptr);
  BandScale& scale() { return *scale_; }
  QTableView& table() { return *table_; }
  void showFrame(const LiveFrame& frame);

 public slots:
  /// Shows the live depth map; `caption` says its size and what black and white mean.
  void showDepthMap(const QImage& image, const QString& caption);
  void clearDepthMap();

 signals:
  void cullingAsked();  ///< the person wants the choices that leave this dock without a depth map

 private:
  void showNote();
  void say(const QString& refusal);

  Draft& draft_;
  BandScale* scale_;
  BandsModel* model_;
  QTableView* table_;
  DepthMapInset* inset_;
  NoteLine* note_;
  QToolButton* remove_;
  Throttle* throttle_;
  QString refusal_;
  QString why_;  ///< there is no depth map; empty if there is one
  FrameDecision decision_;
  bool mapDrawn_ = false;
};

}  // namespace trimtab::views
