// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "band_edit.h"
#include "point_plot.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

namespace trimtab::views {

/// The scale of the total membership, 0 to 2, with its bands, whose lower edges are its points. The
/// hysteresis is shaded on both sides of each edge, and the live total is marked.
class BandScale : public PointPlot {
  Q_OBJECT
 public:
  explicit BandScale(Draft& draft, QWidget* parent = nullptr);

  void showFrame(const LiveFrame& frame);
  std::vector<EditPoint> points() const override;
  void addBand(double low) { insertAt(low, 0); }
  /// Returns where a total lies, in this widget's coordinates.
  QPointF pixelOf(double total) const { return PointPlot::pixelOf(total, 0.5); }

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return {200, sizeHint().height()}; }

 public slots:
  /// Adds a band in the middle of the selected one.
  void insertBesideSelected() override;

 protected:
  void moveHeld(const std::vector<std::size_t>& moved, QPointF by, MergeToken token) override;
  void insertAt(double low, double) override;
  bool removePoints(const std::vector<std::size_t>& gone) override;
  void selectElsewhere(QPointF pixel, bool control) override;
  double distance(const EditPoint& point, QPointF pixel) const override;
  double finest() const override { return kEdgeGap; }
  double keyStep() const override { return kEdgeGap; }
  QString readoutOf(double total, int point) const override;
  void say(const std::optional<QPointF>& at) override;
  QString describe() const override;
  Range wholeView() const override { return {0, BandList::kTop}; }
  void restyle() override;
  void redraw() override;
  void keyPressEvent(QKeyEvent* event) override;
  bool zoomByKey(double) override { return false; }

 private:
  BandList bands() const { return std::get<BandList>(draft().value(key())); }
  int bandAt(double total) const;
  void drawBands();
  void drawEdges();
  void drawGhosts();
  void drawLive();
  void fill(double low, double high, double height, const QBrush& brush);
  template <class Item>
  Item& add(const char* layerName);

  std::optional<double> total_;
  int liveBand_ = -1;
  QList<QCPAbstractItem*> drawn_;
  QCPGraph* live_;
  Throttle throttle_;
};

}  // namespace trimtab::views
