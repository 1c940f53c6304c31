// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "views/model/draft.h"
#include "views/model/throttle.h"
#include "views/model/trace_buffer.h"

class QAction;
class QComboBox;
class QLabel;
class QTableWidget;

namespace trimtab::views {

class TimePlot;
class TraceGraph;

/// The Plots dock. Every frame is recorded, also while the dock is hidden or paused. The plots follow the
/// newest frame until they are paused, panned or zoomed.
class PlotsPanel : public QWidget {
  Q_OBJECT
 public:
  explicit PlotsPanel(Draft& draft, QWidget* parent = nullptr);
  TimePlot& plot() { return *plot_; }
  const TraceBuffer& buffer() const { return buffer_; }
  QTableWidget& readout() { return *readout_; }
  void showFrame(const LiveFrame& frame);

  bool isPaused() const;
  void setPaused(bool paused);
  void setFollowing(bool following);
  void setCursors(bool on);
  /// Sets how many seconds are shown, to the nearest that the panel offers.
  void setSpan(double seconds);
  /// Writes every recorded frame of the shown range to a file, in the C locale.
  QString visibleRangeCsv() const;
  Findings saveCsv(const QString& file) const;
  void clear();

 private:
  void makeActions();
  void refresh();
  void fillReadout();
  void showTracked(double time);
  double valueAt(const TraceGraph& trace, std::uint64_t frame) const;
  void askAndSave();

  Draft& draft_;
  TraceBuffer buffer_;
  TimePlot* plot_;
  QTableWidget* readout_;
  QLabel* tracked_;
  QComboBox* span_;
  QAction *pause_, *follow_, *cursors_;
  Throttle throttle_;
};

}  // namespace trimtab::views
