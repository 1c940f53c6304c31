// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QRubberBand>
#include <optional>
#include <vector>

#include "edit_points.h"
#include "views/model/draft.h"
#include "views/plots/ghosts.h"
#include "views/plots/plot.h"

class QMenu;

namespace trimtab::views {

/// A plot whose points a person drags, nudges by keys, snaps, adds and removes, one of them or several
/// together; a rectangle that is drawn over empty space selects those within. A drag, or a key held down, is
/// one undo step. The plots derived from it say what the points are and what moving one of them changes.
class PointPlot : public Plot {
  Q_OBJECT
 public:
  /// Returns the point that tables and descriptions follow; -1 for none.
  int selected() const { return selection_.followed(); }
  /// Selects one point alone, or none for -1.
  void select(int index);
  /// Adds a point to the selection, or takes it out.
  void toggle(int index);
  /// Selects the points within a rectangle of this widget, beside those that are selected with `add`.
  void selectWithin(const QRect& area, bool add = false);
  /// Returns the selected points in rising order: they move and go together.
  std::vector<std::size_t> group() const { return selection_.group(points().size()); }
  virtual std::vector<EditPoint> points() const = 0;
  /// Returns where a place is, in this widget's coordinates.
  QPointF pixelOf(double x, double y) const { return {xAxis->coordToPixel(x), yAxis->coordToPixel(y)}; }
  Range view() const { return {xAxis->range().lower, xAxis->range().upper}; }
  /// Returns what the file and the pinned snapshot have in place of what is edited.
  const Ghosts& ghosts() const { return *ghosts_; }

 public slots:
  void selectAll();
  /// Adds a point between the selected one and the next one.
  virtual void insertBesideSelected();
  virtual void removeSelected();
  /// Shows all that is edited.
  void fitView();

 signals:
  void selectedChanged(int index);
  void refused(const QString& why);
  void typingAsked();  ///< the person wants to type the values of what is selected

 protected:
  /// The points are made of the parameter `key`.
  PointPlot(const QString& accessibleName, Draft& draft, std::string_view key, QWidget* parent);

  /// Reports whether there is something to edit, and the points may be moved.
  virtual bool editable() const { return true; }
  /// Remembers what is edited, from which moveHeld() moves it.
  virtual void hold() { held_ = draft_.value(key_); }
  virtual void moveHeld(const std::vector<std::size_t>& moved, QPointF by, MergeToken token) = 0;
  virtual void insertAt(double x, double y) = 0;
  /// Removes some points, or emits refused() and returns false.
  virtual bool removePoints(const std::vector<std::size_t>& gone) = 0;
  /// Selects what lies at a place where no point is.
  virtual void selectElsewhere(QPointF pixel, bool control);
  virtual Qt::CursorShape cursorElsewhere(QPointF /*pixel*/) const { return Qt::ArrowCursor; }
  /// Returns how far a pointer is from a point, in pixels.
  virtual double distance(const EditPoint& point, QPointF pixel) const;
  /// Returns the step to which dragged x are rounded at least.
  virtual double finest() const { return 0; }
  /// Returns the place near x to which a drag snaps unless Alt is held.
  virtual std::optional<double> snapped(double /*x*/) const { return std::nullopt; }
  /// Returns how far the keys move a point along x.
  virtual double keyStep() const = 0;
  /// Returns what the readout says of x, or of a point.
  virtual QString readoutOf(double x, int point) const = 0;
  /// Shows the readout of the place where the pointer is; hides it if there is none.
  virtual void say(const std::optional<QPointF>& at);
  /// Returns the accessible description of what is selected.
  virtual QString describe() const = 0;
  /// Returns the range of x that shows all that is edited.
  virtual Range wholeView() const = 0;
  virtual void redraw() = 0;
  /// Adds what this plot has in its menu beyond points. The place is that of the click, or of what is
  /// selected.
  virtual void addToMenu(QMenu& /*menu*/) {}

  Draft& draft() const { return draft_; }
  std::string_view key() const { return key_; }
  const ParameterValue& held() const { return held_; }
  /// Sets the parameter, and emits refused() with the reason if it is refused.
  void commit(const ParameterValue& value, MergeToken token);
  void nudge(double dx, double dy);
  /// Moves what is selected by this much as a step of its own.
  void moveSelected(QPointF by, MergeToken token);
  /// Draws and emits what follows from another selection.
  void showSelection();
  void forgetSelection();
  /// Ends a drag, so that neither the mouse nor Escape changes what is there now.
  void endDrag() { drag_ = 0; }
  int pointAt(QPointF pixel) const;
  /// Returns the place of a pixel, as round as the screen can show, so that no drag ends at 4987.3341 ft.
  QPointF valueAt(QPointF pixel) const;
  bool isAtFault() const;
  /// Reports whether a drag goes on, or a key is held down.
  bool moving() const { return drag_ != 0 || nudge_ != 0; }
  void fitViewUnlessMoving();

  /// Returns the places at which curves are sampled: each pixel, and both sides of every `jump`.
  QVector<double> samples(const QVector<double>& jumps) const;
  void showPoints(const QColor& colour);
  /// Puts the label of the live value beside a pixel, on the side with more room.
  void putLiveText(double x, QString text, QPointF pixel, bool above);
  QCPItemText* liveText() const { return liveText_; }
  Ghosts& behind() { return *ghosts_; }

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
  bool zoomByKey(double factor) override;

 private:
  Draft& draft_;
  std::string_view key_;
  PointSelection selection_;
  ParameterValue held_;
  std::vector<EditPoint> heldPoints_;
  QPointF grabOffset_;
  MergeToken drag_ = 0, nudge_ = 0;  ///< 0: neither
  QRubberBand area_{QRubberBand::Rectangle, this};
  QPoint areaFrom_;
  bool fitted_ = true, shownAtFault_ = false;
  std::optional<Ghosts> ghosts_;
  QCPGraph *points_ = nullptr, *chosen_ = nullptr;
  QCPItemText *liveText_ = nullptr, *readout_ = nullptr;
};

}  // namespace trimtab::views
