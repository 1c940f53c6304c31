// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "curve_edit.h"
#include "point_plot.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

namespace trimtab::views {

/// Shows a membership curve, whose breakpoints are its points. The live operating point lies on the curve
/// that the chosen reading computes.
class CurvePlot : public PointPlot {
  Q_OBJECT
 public:
  CurvePlot(Draft& draft, CurveSpec spec, QWidget* parent = nullptr);

  void showFrame(const LiveFrame& frame);
  std::vector<EditPoint> points() const override;
  void addPoint(CurvePoint point) { insertAt(point.x, point.y); }
  using PointPlot::pixelOf;
  QPointF pixelOf(CurvePoint point) const { return pixelOf(point.x, point.y); }

  QSize sizeHint() const override { return {420, 220}; }
  QSize minimumSizeHint() const override { return {190, 150}; }

 protected:
  bool editable() const override { return spec_.usesPoints(draft().parameters()); }
  void moveHeld(const std::vector<std::size_t>& moved, QPointF by, MergeToken token) override;
  void insertAt(double x, double y) override;
  bool removePoints(const std::vector<std::size_t>& gone) override;
  double finest() const override { return pointGap(spec_); }
  double keyStep() const override { return std::max(findRow(key())->step, pointGap(spec_)); }
  QString readoutOf(double x, int point) const override;
  QString describe() const override;
  Range wholeView() const override;
  void restyle() override;
  void redraw() override;

 private:
  void redrawEffective(const CurvePoints& shown);
  void redrawGhosts(const QVector<double>& at, const QVector<double>& now);
  void placeLive();
  CurvePoints curve() const { return std::get<CurvePoints>(draft().value(key())); }

  CurveSpec spec_;
  std::optional<CurvePoint> live_;
  Throttle liveThrottle_;
  QCPGraph *lines_, *effective_;  ///< the straight lines between breakpoints, and what is computed
  QCPGraph* operating_;
};

}  // namespace trimtab::views
