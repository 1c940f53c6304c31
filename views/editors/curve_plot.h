// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "area_band.h"
#include "curve_edit.h"
#include "edit_hand.h"
#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"
#include "views/plots/ghosts.h"
#include "views/plots/plot.h"

namespace trimtab::views {

/// Shows a membership curve whose breakpoints are dragged, added, removed and moved by keys. A
/// rectangle that is drawn over empty space selects the points within. The live operating point lies on the
/// curve that the chosen reading computes.
class CurvePlot : public Plot {
  Q_OBJECT
 public:
  CurvePlot(Draft& draft, CurveSpec spec, QWidget* parent = nullptr);

  void showFrame(const LiveFrame& frame);
  int selected() const { return hand_.selected(); }
  /// Selects one point alone, or none for -1.
  void select(int index);
  /// Adds a point to the selection, or takes it out.
  void toggle(int index);
  void selectAll();
  /// Selects the points within a rectangle of this widget, beside those that are selected with `add`.
  void selectWithin(const QRect& area, bool add = false);
  /// Returns the selected points in rising order: they move and go together.
  std::vector<std::size_t> group() const { return hand_.group(static_cast<int>(curve().size)); }
  void addPoint(CurvePoint point);
  /// Adds a point in the middle between the selected one and the next one.
  void addPointBesideSelected();
  void removeSelected();
  /// Returns where a breakpoint is, in this widget's coordinates.
  QPointF pixelOf(CurvePoint point) const;
  void fitView();
  /// Returns the curves that the file and the pinned snapshot have in place of this one.
  const Ghosts& ghosts() const { return *ghosts_; }

  QSize sizeHint() const override { return {420, 220}; }
  QSize minimumSizeHint() const override { return {190, 150}; }

 signals:
  void selectedChanged(int index);
  void refused(const QString& why);
  void typingAsked();  ///< the person wants to type the selected point's values

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  bool focusNextPrevChild(bool next) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void restyle() override;
  void resized() override { redraw(); }

 private:
  void showSelection();
  void makeItems();
  bool isAtFault() const;
  void describe(const CurvePoints& shown);
  void redraw();
  void redrawEffective(const CurvePoints& shown);
  void redrawGhosts(const QVector<double>& at, const QVector<double>& now);
  void placeLive();
  void redrawLive();
  void drawHover(const std::optional<QPointF>& at);
  int pointAt(QPointF pixel) const;
  CurvePoint valueAt(QPointF pixel) const;
  void cancelDrag();
  void nudge(double dx, double dy);
  void commit(const CurvePoints& curve, MergeToken token);
  bool editable() const;
  CurvePoints curve() const;

  Draft& draft_;
  CurveSpec spec_;
  EditHand hand_;
  CurvePoints dragStart_;
  QPointF grabOffset_;
  AreaBand band_{this};
  bool fitted_ = true;
  bool shownAtFault_ = false;
  std::optional<CurvePoint> live_;
  Throttle liveThrottle_;

  std::optional<Ghosts> ghosts_;
  QCPGraph* points_ = nullptr;     ///< the straight lines between breakpoints
  QCPGraph* effective_ = nullptr;  ///< what is computed
  QCPGraph* handles_ = nullptr;
  QCPGraph* chosen_ = nullptr;  ///< the selected handle
  QCPGraph* operating_ = nullptr;
  QCPItemText* operatingText_ = nullptr;
  QCPItemText* hoverText_ = nullptr;
  QCPGraph* hover_ = nullptr;
};

}  // namespace trimtab::views
