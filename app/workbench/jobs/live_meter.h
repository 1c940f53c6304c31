// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "draw_thread.h"
#include "trimtab/frame/frame_request.h"

namespace trimtab::workbench {

/// Measures the error of the session's image about once a second, and only if the image has changed since the
/// last measurement. It costs nothing while the view is at rest or while it is switched off.
class LiveMeter : public QObject {
  Q_OBJECT

 public:
  struct Frame {
    FrameRequest request;
    std::vector<FrameRequest> before;  ///< requests of earlier images, oldest first: for pop and blur
  };
  struct Measured {
    FrameError error;
    double frameMs = 0;  ///< median over the images of the last second
    double tookMs = 0;
    int imageWidthPx = 0, imageHeightPx = 0;  ///< of the images that took `frameMs`
    int widthPx = 0, heightPx = 0;            ///< at which the error was measured
    bool smaller = false;  ///< than the image, because measuring at full size takes too long
  };
  using Source = std::function<std::optional<Frame>()>;

  LiveMeter(DrawThread& thread, Source source, QObject* parent = nullptr);

  void setOn(bool on);
  bool isOn() const { return on_; }
  /// Call this after each image. `time` is in seconds.
  void painted(double time, double frameMs);
  /// Call this after another preset or terrain was chosen: the same view gives another image now, and a
  /// measurement that is under way is dropped.
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
  std::optional<Frame> last_;                     ///< the frame that was measured last
  int shrink_ = 1;                                ///< width and height are divided by this
  QElapsedTimer sinceLast_;
  int gapMs_ = 0;  ///< from the start of one measurement to the start of the next
  bool on_ = false, changed_ = false, busy_ = false;
  std::uint64_t measurements_ = 0, generation_ = 0;  ///< a result of an earlier generation is dropped
};

/// Returns a request for the image that the pilot would see: without what is drawn for the engineer, and
/// `shrink` times smaller in width and height.
FrameRequest pilotsImage(FrameRequest request, int shrink);
/// Whether both requests of one preset give the same image, apart from what moves by itself, such as rain.
bool sameImage(const FrameRequest& a, const FrameRequest& b);

}  // namespace trimtab::workbench
