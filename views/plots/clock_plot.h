// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "plot.h"
#include "time_cursor.h"

namespace trimtab::views {

/// A plot on the clock of the frames. It reports the time that the pointer is at, so that other plots show it
/// as a line (the tracker), and a click. Derived classes say in which axis rects the time runs along the
/// bottom axis.
class ClockPlot : public Plot {
  Q_OBJECT
 public:
  /// Shows where the pointer is in another plot of the same clock, without a signal. NaN hides it.
  void showTracker(double time);
  /// Returns the time that the tracker shows; nothing while it is hidden.
  std::optional<double> tracker() const { return tracker_.time(); }

 signals:
  void tracked(double time);  ///< NaN: the pointer left
  void timeClicked(double time);

 protected:
  using Plot::Plot;
  /// Makes the tracker in these axis rects, on a layer `tracker` that the plot must have. Call it again after
  /// the items were removed.
  void trackIn(const std::vector<QCPAxisRect*>& rects);
  /// Gives the tracker the colours of the theme.
  void styleTracker();

  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;

 private:
  std::optional<double> timeAt(QPointF pixel) const;

  std::vector<QCPAxisRect*> rects_;
  TimeCursor tracker_;
};

}  // namespace trimtab::views
