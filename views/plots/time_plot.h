// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "clock_plot.h"
#include "trace_graph.h"
#include "views/model/plot_marks.h"
#include "views/model/plot_signals.h"

namespace trimtab::views {

/// Shows lanes against one time axis, each with the signals that a person put into it; a budget line, two
/// cursors, a chosen frame, a tracker, and marks of what happened beside the frames. It draws what a
/// TraceBuffer and a PlotMarks hold and owns no data.
class TimePlot : public ClockPlot {
  Q_OBJECT
 public:
  /// `marks` may be null.
  TimePlot(const TraceBuffer& buffer, const PlotMarks* marks, PlotLanes lanes, QWidget* parent = nullptr);

  /// Draws the buffer again. With `follow`, the newest frame is at the right edge.
  void refresh(bool follow);
  QCPRange shown() const { return timeAxis()->range(); }
  void setShown(double from, double to);
  void setSpan(double seconds);
  double span() const { return span_; }
  void setBudget(double ms);
  /// Chooses whether a few values far above all others are cut off by the axis, and the largest is named; on
  /// from the start.
  void setRobust(bool on);
  /// Shows only frames before this one from now on; all that come if it is unset.
  void hold(std::optional<std::uint64_t> end);
  /// Returns one past the newest frame that may be shown.
  std::uint64_t end() const { return held_ ? std::min(*held_, buffer_.end()) : buffer_.end(); }
  /// Returns the frame at a time; nothing if none of those that may be shown is near it.
  std::optional<std::uint64_t> frameAt(double time) const { return buffer_.at(time, end()); }
  /// Returns the frames within the shown range: from `first` up to `second`.
  std::pair<std::uint64_t, std::uint64_t> framesShown() const;

  const PlotLanes& lanes() const { return content_; }
  /// Whether a lane has this signal.
  bool shows(Trace trace) const;
  /// Shows other signals. The graphs of `traces()` are made anew.
  void setLanes(PlotLanes lanes);
  void addSignal(std::size_t lane, Trace trace);
  void removeSignal(std::size_t lane, Trace trace);
  void addLane(PlotLane lane);
  void removeLane(std::size_t lane);
  /// Returns the lane that keys and lists put signals into: the one that was clicked last.
  std::size_t currentLane() const { return current_; }
  QCPAxisRect* laneRect(std::size_t lane) const { return lanes_[lane].rect; }
  /// Places the lanes in the room that the parent has: in one column, or in two if it is wide and low.
  void arrange();

  bool hasCursors() const { return cursors_.has_value(); }
  void setCursors(bool on);
  /// Returns the time of cursor 0 (A) or 1 (B); 0 while there are none. It may lie between two frames.
  double cursor(int which) const { return cursors_ ? (*cursors_)[static_cast<std::size_t>(which)] : 0; }
  void moveCursor(int which, double time);
  /// Marks the frame at a time; none if it is unset.
  void choose(std::optional<double> time);
  QPointF pixelOfTime(double time) const;

  const std::vector<TraceGraph*>& traces() const { return traces_; }
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

  /// What a drag of a signal carries: the name of its trace.
  static constexpr const char* kSignalMime = "application/x-trimtab-signal";

 signals:
  void movedByHand();  ///< the person panned or zoomed away from the newest frame
  void shownChanged();
  void cursorsMoved();
  void frameClicked(std::uint64_t frame);
  void spikeAsked(int direction);  ///< 1: the next frame that took long, -1: the one before
  void pauseAsked();
  void followAsked();
  void lanesChanged();  ///< by hand or by code; traces() are others

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void zoomByWheel(QWheelEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void restyle() override;
  void resized() override { draw(); }
  bool zoomByKey(double factor) override;

 private:
  class Marks;
  struct Lane {
    QCPLayoutGrid* cell = nullptr;  ///< the legend above, the axis rect below
    QCPAxisRect* rect = nullptr;
    QCPLegend* legend = nullptr;
    QCPItemStraightLine* budget = nullptr;  ///< null where no time is on the left
    QCPItemText* budgetText = nullptr;
    QCPItemText* longest = nullptr;  ///< of what reaches beyond the axis
  };
  struct Side {
    double largest = 0, usual = 0;
    double least = 0;  ///< below 0 where something is
  };
  void makeLanes();
  void makeLane(const PlotLane& content);
  void addStages(Lane& lane);
  void addTrace(Lane& lane, TraceGraph::Look look, bool right);
  void addTextsOf(Lane& lane);
  void onLaidOut();
  std::size_t laneAt(QPointF pixel) const;
  QCPAxis* timeAxis() const { return lanes_.front().rect->axis(QCPAxis::atBottom); }
  void draw();
  void drawLane(Lane& lane, const Side& left, const Side& right);
  /// Returns where an axis ends, and adds to `beyond` the text that names a value beyond it.
  double topOf(const Side& side, double atLeast, const QString& unit, QStringList& beyond) const;
  void placeCursors();
  void zoom(double factor, double anchor);
  int cursorAt(QPointF pixel) const;
  double timeAtPixel(QPointF pixel) const;
  double secondsPerPixel() const;

  const TraceBuffer& buffer_;
  const PlotMarks* marks_;
  PlotLanes content_;
  std::vector<Lane> lanes_;
  std::vector<TraceGraph*> traces_;
  std::array<QCPMarginGroup*, 2> columnMargins_{};
  int columns_ = 0, leastHeight_ = 0;
  std::array<TimeCursor, 2> cursor_;
  TimeCursor chosen_;
  std::optional<std::array<double, 2>> cursors_;
  std::optional<std::uint64_t> held_;
  double span_ = 60;
  bool following_ = true, robust_ = true;
  int draggedCursor_ = -1, keyCursor_ = 0;
  std::size_t current_ = 0;
  std::optional<double> panFrom_;
  bool panned_ = false;
  double budget_ = 0;
};

}  // namespace trimtab::views
