// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "policy_draft.h"
#include "policy_live.h"
#include "term_edit.h"
#include "views/editors/area_band.h"
#include "views/editors/edit_hand.h"
#include "views/plots/ghosts.h"
#include "views/plots/plot.h"

namespace trimtab::views {

/// The terms of one signal as curves. The characteristic points of the selected term are dragged, nudged and
/// snapped, one of them or several together; a rectangle that is drawn over empty space selects those within.
/// A mark rides on each curve at the live value, whose last seconds run out below the axis.
class TermPlot : public Plot {
  Q_OBJECT
 public:
  TermPlot(PolicyDraft& policy, const PolicyTrack& track, QWidget* parent = nullptr);

  Signal signal() const { return signal_; }
  void setSignal(Signal signal);
  /// Returns the selected term's line in the draft and its point; -1 for none.
  int term() const { return term_; }
  int handle() const { return hand_.selected(); }
  /// Selects a term and one of its points alone.
  void select(int term, int handle = -1);
  /// Returns the selected points in rising order: they move and go together.
  std::vector<std::size_t> group() const { return hand_.group(static_cast<int>(handles().size())); }
  /// Returns the points of the selected term.
  std::vector<TermHandle> handles() const;
  /// Returns where a place is, in this widget's coordinates.
  QPointF pixelOf(double x, double y) const;
  void showLive(const PolicyLive& live);
  Range view() const { return {xAxis->range().lower, xAxis->range().upper}; }
  /// Returns the terms of the signal that differ in the file and the pinned snapshot.
  const Ghosts& ghosts() const { return *ghosts_; }
  /// Returns the colour of a term of this signal, by its place among them.
  static QColor colourOf(std::size_t place, const QPalette& palette);

  QSize sizeHint() const override { return {420, 230}; }
  QSize minimumSizeHint() const override { return {200, 130}; }

 public slots:
  void fitView();
  void selectAll();
  void copyShape();
  void pasteShape();

 signals:
  void selectedChanged(int term, int handle);
  void refused(const QString& why);
  void typingAsked();           ///< the person wants to type the selected term's numbers
  void addAsked();              ///< the person wants a new term
  void duplicateAsked();        ///< the person wants a copy of the selected term
  void removeAsked();           ///< the person wants the selected term gone
  void picturedTermsChanged();  ///< the curves were drawn anew
  void dragged();               ///< a point was moved by mouse or keys

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  bool focusNextPrevChild(bool next) override;
  void focusOutEvent(QFocusEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void restyle() override;
  void resized() override { redraw(); }
  bool zoomByKey(double factor) override;

 private:
  /// The graphs and items of the plot.
  struct Parts {
    QList<QCPGraph*> curves, marks;
    QCPGraph *points = nullptr, *chosen = nullptr;
    QCPCurve* trail = nullptr;
    QCPItemStraightLine *live = nullptr, *limits[2] = {nullptr, nullptr};
    QCPItemText *liveText = nullptr, *readout = nullptr, *empty = nullptr;
  };
  /// What a drag began with.
  struct Drag {
    PolicyTerm start;
    QPointF offset;  ///< from the mouse to the point, pixels
  };

  void makeItems();
  void redraw();
  void drawCurves();
  void readGhosts();
  void drawGhosts(const QVector<double>& at);
  void drawPoints();
  void describe();
  void placeLive();
  void drawTrail();
  void say(const std::optional<QPointF>& at);
  const PolicyTerm* termAt(int line) const;
  int handleAt(QPointF pixel) const;
  int curveAt(QPointF pixel) const;
  double snapped(double x, bool toOthers) const;
  void showSelection();
  void selectWithin(const QRect& area, bool add);
  void moveTo(double x, double y, MergeToken token);
  void moveBy(const PolicyTerm& from, double dx, double dy, MergeToken token);
  void put(const PolicyTerm& moved, MergeToken token);
  void nudge(double dx, double dy);
  void snapTo(int side);
  void insertPoint(double x, double y);
  void removePoint();
  void cancelDrag();
  void stepTerm(int by);

  PolicyDraft& policy_;
  const PolicyTrack& track_;
  Signal signal_ = Signal::altitude;
  int term_ = -1;
  EditHand hand_;
  Drag drag_;
  AreaBand band_{this};
  bool fitted_ = true;
  double value_ = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t drawnTrack_ = 0;
  std::optional<Ghosts> ghosts_;
  /// The sound terms of all signals, in the order of kGhosts.
  std::array<std::vector<PolicyTerm>, 2> ghostTerms_;
  Parts parts_;
};

}  // namespace trimtab::views
