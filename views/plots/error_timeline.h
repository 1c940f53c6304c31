// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "plot.h"
#include "time_cursor.h"
#include "views/model/error_run.h"

namespace trimtab::views {

/// Shows the frames of one flight along time: frame time above and error below, a line for each preset in one
/// culling case, with marks at the worst frames. The cursor is where the flight is; dragging it, or moving it
/// by keys, moves the flight.
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
  /// Shows a culling case by its name in ErrorRun; the last one of the run if none has that name.
  void showMethod(const QString& method);
  void setBudget(double ms);

  /// Moves the cursor to a time on the flight's clock, in seconds, without a signal. NaN hides it.
  void follow(double time);
  double cursorTime() const { return cursor_; }
  /// Moves the cursor and emits `sought`.
  void seek(double time);

  QPointF pixelOf(double time) const;
  /// Returns the worst frames that are shown, in order of time.
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
  /// Returns the error that is shown; null if the run has none with that index.
  const ErrorRun::Error* error() const;
  QCPAxis* time(int lane = 0) const { return lanes_[std::size_t(lane)]->axis(QCPAxis::atBottom); }
  QCPAxis* value(int lane) const { return lanes_[std::size_t(lane)]->axis(QCPAxis::atLeft); }
  void redraw();
  void drawLines();
  void drawWorst();
  void placeCursor();
  void showNumbers(double atTime, QPointF pixel);
  QString textAt(double atTime) const;
  void zoom(double factor, double anchor);
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
