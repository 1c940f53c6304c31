// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "views/model/draft.h"
#include "views/model/plot_marks.h"
#include "views/model/throttle.h"
#include "views/model/trace_buffer.h"

class QAction;
class QComboBox;
class QLabel;
class QListWidget;
class QMenu;
class QSettings;
class QSplitter;
class QTabWidget;
class QTableWidget;

namespace trimtab::views {

class FramePage;
class PlotValues;
class SignalsPage;
class TimePlot;

/// The Plots dock. Every frame is recorded, also while the dock is hidden or paused. The plots follow the
/// newest frame until they are paused, panned or zoomed. Beside them, on demand: values, one frame explained,
/// and the signals to drag into a plot.
class PlotsPanel : public QWidget {
  Q_OBJECT
 public:
  explicit PlotsPanel(Draft& draft, QWidget* parent = nullptr);
  TimePlot& plot() { return *plot_; }
  const TraceBuffer& buffer() const { return buffer_; }
  QTableWidget& readout();
  FramePage& framePage() { return *framePage_; }
  QListWidget& signalList();
  QString trackedText() const;
  void showFrame(const LiveFrame& frame);
  /// Marks from `time` on, on the clock of LiveFrame::time, that the host is silent or a trace is recorded.
  void mark(PlotMarks::Kind kind, bool on, double time);
  const PlotMarks& marks() const { return marks_; }

  bool isPaused() const;
  void setPaused(bool paused);
  void setFollowing(bool following);
  void setCursors(bool on);
  /// Sets how many seconds are shown, to the nearest that the panel offers.
  void setSpan(double seconds);
  /// Explains a frame beside the median of those shown.
  void chooseFrame(std::uint64_t frame);
  /// Chooses the next (1) or the previous (-1) frame that took long.
  void chooseSpike(int direction);
  /// Writes every recorded frame of the shown range to a file, in the C locale.
  QString visibleRangeCsv() const;
  Findings saveCsv(const QString& file) const;
  /// Writes the plots as they are shown, as SVG if the name ends so, else as PNG at twice the size.
  Findings savePicture(const QString& file) const;
  void clear();

  /// Keeps the signals of the plots, the time shown and the range; reads those that are there.
  void keepIn(QSettings& settings) const;
  void readFrom(const QSettings& settings);
  /// Does the same for the length of the recording. Another length empties it.
  void keepLengthIn(QSettings& settings) const;
  void readLengthFrom(const QSettings& settings);

 signals:
  /// A person chose a frame, whose state has this time on the clock of its host or flight.
  void frameChosen(double stateTime);

 private:
  void makeActions();
  QMenu* makeMore();
  QWidget* makeSide();
  void refresh();
  void refreshSide();
  void noteChange(const LiveFrame& frame);
  void showTracked(double time);
  void showFrameOf(std::optional<std::uint64_t> frame);
  void askAndSave();
  void askAndSavePicture();
  void setBufferFrames(int frames);

  Draft& draft_;
  TraceBuffer buffer_;
  PlotMarks marks_;
  std::optional<FrameDecision> lastDecision_;
  TimePlot* plot_;
  PlotValues* values_;
  FramePage* framePage_;
  QWidget* framePlace_;  ///< scrolls the page, which is higher than a low dock
  SignalsPage* signals_;
  QTabWidget* side_;
  QSplitter* parts_;
  QLabel* tracked_;
  QComboBox* span_;
  QAction *pause_, *follow_, *cursors_, *details_, *robust_;
  QMenu* lengths_;
  Throttle throttle_, sideThrottle_;

 protected:
  void resizeEvent(QResizeEvent* event) override;
};

}  // namespace trimtab::views
