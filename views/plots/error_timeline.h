// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "plot.h"
#include "time_cursor.h"
#include "views/model/error_run.h"

namespace trimtab::views {

/// The frames of one flight along time: frame time above, error below, a line a preset in one culling case;
/// the worst frames marked. Its cursor is where the flight stands, and takes it elsewhere when it is dragged
/// or moved by keys.
class ErrorTimeline : public Plot {
  Q_OBJECT
 public:
  struct Worst {
    int series = 0;
    qsizetype frame = 0;
  };

  explicit ErrorTimeline(QWidget* parent = nullptr);

  void show(const ErrorRun& run);
  void showFlight(const QString& flight);
  void showError(int error);
  /// As ErrorRun spells it; the last one of the run where there is none of that name.
  void showMethod(const QString& method);
  void setBudget(double ms);

  /// The flight's clock, seconds; NaN: no flight, no cursor. Tells nobody.
  void follow(double time);
  double cursorTime() const { return cursor_; }
  /// Moves the cursor and says so.
  void seek(double time);

  QPointF pixelOf(double time) const;
  /// In order of time.
  const std::vector<Worst>& worst() const { return worst_; }
  const ErrorRun& run() const { return run_; }

  QSize sizeHint() const override { return {420, 220}; }
  QSize minimumSizeHint() const override { return {220, 130}; }

 signals:
  void sought(double time);

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void zoomByWheel(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void restyle() override { redraw(); }
  void resized() override { redraw(); }
  bool zoomByKey(double factor) override;

 private:
  bool isShown(const ErrorRun::Series& series) const;
  QCPAxis* time(int lane = 0) const { return lanes_[std::size_t(lane)]->axis(QCPAxis::atBottom); }
  QCPAxis* value(int lane) const { return lanes_[std::size_t(lane)]->axis(QCPAxis::atLeft); }
  void redraw();
  void drawLines();
  void drawWorst();
  void placeCursor();
  void showNumbers(double atTime, QPointF pixel);
  QString textAt(double atTime) const;
  void stepFrames(int frames);
  void stepWorst(int direction);

  ErrorRun run_;
  QString flight_, method_;
  int error_ = 0;
  double budget_ = 0, cursor_;
  bool dragging_ = false;
  std::vector<double> times_;  ///< of all frames shown, ascending
  std::vector<Worst> worst_;
  QCPRange whole_;

  std::array<QCPAxisRect*, 2> lanes_{};
  TimeCursor line_;  ///< at cursor_
  QCPItemStraightLine* budgetLine_;
  QCPItemText *numbers_, *hint_;
};

}  // namespace trimtab::views
