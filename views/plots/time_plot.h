// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "plot.h"
#include "trace_graph.h"

namespace trimtab::views {

/// Four lanes against one time axis: memberships, triangles and vertices, frame time and rate, and the stages
/// of a frame stacked; a budget line, two cursors and a tracker. It draws what a TraceBuffer holds and owns
/// no data.
class TimePlot : public Plot {
  Q_OBJECT
 public:
  enum class Lanes { all, stages };  ///< stages alone: how a dock of another matter shows what it costs
  explicit TimePlot(const TraceBuffer& buffer, Lanes lanes = Lanes::all, QWidget* parent = nullptr);

  /// Draws the buffer again; with `follow`, the newest frame is at the right edge.
  void refresh(bool follow);
  QCPRange shown() const { return timeAxis()->range(); }
  void setShown(double from, double to);
  void setSpan(double seconds);
  double span() const { return span_; }
  void setBudget(double ms);

  bool hasCursors() const { return cursors_.has_value(); }
  void setCursors(bool on);
  /// Time of cursor 0 (A) or 1 (B); they snap to frames when read, not when moved.
  double cursor(int which) const { return cursors_ ? (*cursors_)[static_cast<std::size_t>(which)] : 0; }
  void moveCursor(int which, double time);
  QPointF pixelOfTime(double time) const;

  const std::vector<TraceGraph*>& traces() const { return traces_; }
  QSize sizeHint() const override { return {560, firstLane_ == 0 ? 420 : 170}; }
  QSize minimumSizeHint() const override { return {260, firstLane_ == 0 ? 190 : 130}; }

 signals:
  void movedByHand();  ///< the person panned or zoomed away from the newest frame
  void cursorsMoved();
  void tracked(double time);  ///< NaN: the mouse left
  void pauseAsked();
  void followAsked();

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void zoomByWheel(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void restyle() override;
  void resized() override { draw(); }
  bool zoomByKey(double factor) override;

 private:
  struct Lane {
    QCPAxisRect* rect = nullptr;
    QCPLegend* legend = nullptr;
    QCPItemStraightLine* budget = nullptr;
    QCPItemText* budgetText = nullptr;
    QCPItemText* longest = nullptr;  ///< of times, where the axis ends below it
    std::array<QCPItemStraightLine*, 2> cursor{};
    QCPItemStraightLine* tracker = nullptr;
    double fixedTop = 0;  ///< 0: by what is shown
  };
  void arrange();
  void makeLane(const QString& title, double fixedTop, bool budget);
  /// With `right`, what its axis on the right is called.
  void addTrace(std::size_t lane, TraceGraph::Look look, const QString& right = {});
  QCPAxis* timeAxis() const { return lanes_.front().rect->axis(QCPAxis::atBottom); }
  void draw();
  /// Where the axis of times ends; says the longest where that is beyond.
  double shownTop(const Lane& lane, double longest, double usual) const;
  void placeCursors();
  void zoom(double factor, double anchor);
  int cursorAt(QPointF pixel) const;

  const TraceBuffer& buffer_;
  const std::size_t firstLane_;  ///< lanes before it are not shown
  std::vector<Lane> lanes_;
  std::vector<TraceGraph*> traces_;
  std::array<QCPMarginGroup*, 2> columnMargins_{};
  int columns_ = 0;
  std::array<QCPItemText*, 2> cursorText_{};
  std::optional<std::array<double, 2>> cursors_;
  double span_ = 60;
  bool following_ = true;
  int draggedCursor_ = -1, keyCursor_ = 0;
  std::optional<double> panFrom_;
  double budget_ = 0;
};

}  // namespace trimtab::views
