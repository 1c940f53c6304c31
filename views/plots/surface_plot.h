// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "plot.h"
#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

namespace trimtab::views {

/// The decision as a surface over altitude and pitch: total membership by colour, the bands' edges as lines,
/// the flight's track and the last frame's place on it. Of the active parameters, whatever their combination
/// and readings; computed anew only when one of them or the view changes. Drag and wheel move the view,
/// double click fits it.
class SurfacePlot : public Plot {
  Q_OBJECT
 public:
  explicit SurfacePlot(Draft& draft, QWidget* parent = nullptr);
  void showFrame(const LiveFrame& frame);

  /// Total membership that is drawn at a place; NaN outside.
  double totalAt(double altitudeFt, double pitchDeg) const;
  /// Points of the lines of the bands' edges, apart by NaN.
  const QCPCurve& edges() const { return *edges_; }
  const std::vector<CurvePoint>& track() const { return track_; }
  /// How often the surface was computed.
  int computed() const { return computed_; }
  QString hoverText() const { return hover_->text(); }

 public slots:
  void fitView();
  void clearTrack();

 protected:
  void mouseMoveEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void restyle() override;

 private:
  void makePlottables();
  void compute();
  void drawEdges(const std::vector<double>& totals);
  void showLive();

  Draft& draft_;
  QCPColorMap* map_;
  QCPColorScale* scale_;
  QCPCurve *edgesHalo_, *edges_, *trackHalo_, *trackLine_;
  QCPGraph* live_;
  QCPItemText* hover_;
  TuningParameters shown_;  ///< that the surface was computed of
  bool everComputed_ = false;
  int computed_ = 0;
  FrameDecision decision_;
  bool any_ = false, trackMoved_ = false;
  std::vector<CurvePoint> track_;
  Throttle surfaceThrottle_, liveThrottle_;
};

}  // namespace trimtab::views
