// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "plot.h"
#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

namespace trimtab::views {

/// Shows the decision as a surface over altitude and pitch: total membership by colour, the bands' edges as
/// lines, the flight's track and the last frame's place on it. It uses the active parameters, whatever their
/// combination and readings, and is computed anew only when one of them or the view changes. Dragging moves
/// the view, the wheel with Ctrl zooms it, and a double click fits it.
class SurfacePlot : public Plot {
  Q_OBJECT
 public:
  explicit SurfacePlot(Draft& draft, QWidget* parent = nullptr);
  void showFrame(const LiveFrame& frame);

  /// Returns the total membership that is drawn at a place; NaN outside the view.
  double totalAt(double altitudeFt, double pitchDeg) const;
  /// Returns the points of the lines of the bands' edges; NaN parts the lines.
  const QCPCurve& edges() const { return *edges_; }
  const std::vector<CurvePoint>& track() const { return track_; }
  /// Returns how often the surface was computed.
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
  TuningParameters shown_;  ///< from which the surface was computed
  int computed_ = 0;
  std::optional<CurvePoint> now_;  ///< altitude and pitch of the last frame
  bool trackMoved_ = false;
  std::vector<CurvePoint> track_;
  Throttle surfaceThrottle_, liveThrottle_;
};

}  // namespace trimtab::views
