// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deque>

#include "plot.h"
#include "views/model/error_run.h"

namespace trimtab::views {

/// A live measurement: the session's frame time, and its errors in the order of ErrorRun::errors.
struct LiveError {
  double ms = 0;
  QVector<double> errors;
  int widthPx = 0, heightPx = 0;  ///< of the image whose time it is; 0 if unknown
};

/// Shows run time against error. Each preset in each case is a point at the medians of its frames, with its
/// marker by case, its colour by preset, and whiskers from the 5th to the 95th percentile of enough frames.
/// The front joins the points that no other surely beats, as results report it. A line is the budget, and the
/// live session is a point with a fading tail. Lower left is best whatever the error: an axis on which larger
/// is better runs the other way. A live point of images of another size than the results' cannot be compared
/// with them: it is hollow, is named with its size, and does not widen the view.
class ErrorPlot : public Plot {
  Q_OBJECT
 public:
  struct Point {
    int series = 0;  ///< of ErrorRun::series
    double error = 0, ms = 0;
    double errorLow = 0, errorHigh = 0, msLow = 0, msHigh = 0;
    bool onFront = false;
  };
  static constexpr std::size_t kTail = 24;

  explicit ErrorPlot(QWidget* parent = nullptr);

  void show(const ErrorRun& run);
  /// Shows one flight, or the first if none has that name.
  void showFlight(const QString& flight);
  /// Shows the error with this index in ErrorRun::errors.
  void showError(int error);
  void setLogarithmic(bool on);
  bool logarithmic() const { return yAxis->scaleType() == QCPAxis::stLogarithmic; }
  void setBudget(double ms);
  void showLive(const LiveError& live);
  void clearLive();

  const std::vector<Point>& points() const { return points_; }
  const std::deque<LiveError>& tail() const { return tail_; }
  int selected() const { return selected_; }
  /// Shows the numbers of a point; points().size() is the live one, and -1 shows none.
  void select(int point);
  QString selectedText() const;
  QPointF pixelOf(const Point& point) const;
  QPointF livePixel() const;
  void fitView();

  QSize sizeHint() const override { return {380, 220}; }
  QSize minimumSizeHint() const override { return {200, 130}; }

 signals:
  void logarithmicChanged(bool on);

 protected:
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void restyle() override { redraw(); }
  void resized() override { redraw(); }
  bool zoomByKey(double factor) override;

 private:
  class Tail;
  const ErrorRun::Error* error() const;
  /// Reports whether the live images have the size of the results', or one of the sizes is unknown.
  bool liveCompares() const;
  /// Returns what the legend and the numbers call the live point.
  QString liveName() const;
  double liveError(const LiveError& live) const;
  QPointF placeLive(const LiveError& live) const;
  void compute();
  void findFront(const ErrorRun::Error& shown);
  void redraw();
  void drawPoints();
  void drawFront();
  void makeLegend();
  void fit();
  void placeText();
  int pointAt(QPointF pixel) const;

  ErrorRun run_;
  QString flight_;
  int error_ = 0, selected_ = -1;
  double budget_ = 0;
  bool fitted_ = true;
  std::vector<Point> points_;
  std::deque<LiveError> tail_;  ///< newest last

  Tail* liveItem_;
  QCPItemStraightLine* budgetLine_;
  QCPItemText *budgetText_, *hint_, *numbers_;
};

}  // namespace trimtab::views
