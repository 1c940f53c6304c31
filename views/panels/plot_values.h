// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTableWidget>

#include "views/model/trace_buffer.h"

namespace trimtab::views {

class TimePlot;

/// Shows the values of every signal in a TimePlot: at its two cursors with their difference, and over the
/// shown range. A cursor that no frame is near has its own time and no values.
class PlotValues : public QTableWidget {
  Q_OBJECT
 public:
  enum Column { kSignal, kA, kB, kDifference, kLeast, kMedian, kP95, kLargest, kColumns };

  PlotValues(const TraceBuffer& buffer, const TimePlot& plot, QWidget* parent = nullptr);
  void fillCursors();
  /// Sorts a part of the shown frames for each signal, so do not call it for every image.
  void fillStatistics();

 private:
  void remake();
  void put(int row, int column, const QString& text);

  const TraceBuffer& buffer_;
  const TimePlot& plot_;
};

}  // namespace trimtab::views
