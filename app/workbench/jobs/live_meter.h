// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "app/workbench/viewport/draw_thread.h"
#include "trimtab/frame/frame_request.h"

namespace trimtab::workbench {

/// Measures what the session's picture loses, about once a second, and only where the picture is another than
/// the one measured last. At rest and switched off it costs nothing.
class LiveMeter : public QObject {
  Q_OBJECT

 public:
  struct Frame {
    FrameRequest request;
    std::vector<FrameRequest> before;  ///< pictures before it, oldest first: for pop and blur
  };
  struct Measured {
    FrameError error;
    double frameMs = 0;  ///< median of the last second's pictures
    double tookMs = 0;
    int widthPx = 0, heightPx = 0;
    bool smaller = false;  ///< than the picture: a full measurement takes too long
  };
  using Source = std::function<std::optional<Frame>()>;

  LiveMeter(DrawThread& thread, Source source, QObject* parent = nullptr);

  void setOn(bool on);
  bool isOn() const { return on_; }
  /// A picture was painted; `time` in seconds.
  void painted(double time, double frameMs);
  /// Another preset or terrain: the same view is another picture, and what is under way is of the old one.
  void forget();
  bool busy() const { return busy_; }
  std::uint64_t measurements() const { return measurements_; }

 signals:
  void measured(const trimtab::workbench::LiveMeter::Measured& measured);

 private:
  void measure();
  void wake();
  double medianMs() const;

  DrawThread& thread_;
  Source source_;
  QTimer timer_;
  std::deque<std::pair<double, double>> recent_;  ///< time, frame ms
  std::optional<Frame> last_;                     ///< what was measured
  int shrink_ = 1;                                ///< sizes are divided by it
  QElapsedTimer sinceLast_;
  int gapMs_ = 0;  ///< from one measurement's begin to the next one's
  bool on_ = false, changed_ = false, busy_ = false;
  std::uint64_t measurements_ = 0, generation_ = 0;  ///< results of an earlier generation are dropped
};

/// The request without what is drawn for the engineer, at a size `shrink` times smaller: the picture that the
/// pilot would get.
FrameRequest pilotsPicture(FrameRequest request, int shrink);

}  // namespace trimtab::workbench
