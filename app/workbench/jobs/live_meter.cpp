// SPDX-License-Identifier: GPL-3.0-or-later
#include "live_meter.h"

#include <QGuiApplication>
#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "trimtab/frame/frame_request.h"
#include "trimtab/measure/statistics.h"

namespace trimtab::workbench {
namespace {

constexpr int kFirstMs = 100, kPeriodMs = 1000, kRetryMs = 200;
/// Measuring takes at most one part in this many of the time.
constexpr int kMostOfTime = 4;
constexpr double kLongestMs = 400, kQuickMs = 100;
constexpr int kSmallest = 4;
constexpr double kWindowS = 1;

}  // namespace

FrameRequest pilotsImage(FrameRequest request, int shrink) {
  request.overlays = {};
  request.view.widthPx = std::max(request.view.widthPx / shrink, 16);
  request.view.heightPx = std::max(request.view.heightPx / shrink, 16);
  return request;
}

bool sameImage(const FrameRequest& a, const FrameRequest& b) {
  return a.eye == b.eye && a.attitude == b.attitude && a.view == b.view && a.levers.drawn == b.levers.drawn &&
         a.decision == b.decision && a.cullingCase == b.cullingCase;
}

LiveMeter::LiveMeter(DrawThread& thread, Source source, QObject* parent)
    : QObject(parent), thread_(thread), source_(std::move(source)) {
  timer_.setSingleShot(true);
  connect(&timer_, &QTimer::timeout, this, &LiveMeter::measure);
}

void LiveMeter::setOn(bool on) {
  if (on == on_) return;
  on_ = on;
  if (!on) return timer_.stop();
  changed_ = true;
  wake();
}

void LiveMeter::wake() {
  if (!on_ || !changed_ || busy_ || timer_.isActive()) return;
  const qint64 due = sinceLast_.isValid() ? gapMs_ - sinceLast_.elapsed() : 0;
  timer_.start(int(std::max<qint64>(due, kFirstMs)));
}

void LiveMeter::painted(double time, double frameMs) {
  recent_.emplace_back(time, frameMs);
  while (recent_.size() > 1 && (recent_.front().first < time - kWindowS || recent_.front().first > time))
    recent_.pop_front();
  changed_ = true;
  wake();
}

void LiveMeter::forget() {
  ++generation_;
  last_.reset();
  changed_ = true;
  wake();
}

double LiveMeter::medianMs() const {
  SampleWindow window(std::max<std::size_t>(recent_.size(), 1));
  for (const auto& [time, ms] : recent_) window.add(ms);
  return window.median();
}

void LiveMeter::measure() {
  if (!on_ || busy_ || !changed_) return;
  // A hand on the mouse is about to see whatever is late.
  if (QGuiApplication::mouseButtons() != Qt::NoButton) return timer_.start(kRetryMs);
  changed_ = false;
  std::optional<Frame> frame = source_();
  if (!frame || (last_ && sameImage(last_->request, frame->request))) return;
  last_ = frame;
  struct Work {
    Frame frame;
    Measured measured;
    std::uint64_t generation = 0;
  };
  const auto work = std::make_shared<Work>();
  work->generation = generation_;
  work->measured.smaller = shrink_ > 1;
  work->measured.imageWidthPx = frame->request.view.widthPx;
  work->measured.imageHeightPx = frame->request.view.heightPx;
  work->frame.request = pilotsImage(frame->request, shrink_);
  for (const FrameRequest& before : frame->before) work->frame.before.push_back(pilotsImage(before, shrink_));
  busy_ = true;
  sinceLast_.start();
  thread_.run(
      [work](scene::ErrorMeter& meter) {
        const Frame& asked = work->frame;
        QElapsedTimer timer;
        timer.start();
        work->measured.error = meter.measure(asked.request, std::span(asked.before), nullptr);
        work->measured.tookMs = double(timer.nsecsElapsed()) * 1e-6;
        work->measured.widthPx = asked.request.view.widthPx;
        work->measured.heightPx = asked.request.view.heightPx;
      },
      this,
      [this, work] {
        busy_ = false;
        ++measurements_;
        Measured& result = work->measured;
        if (result.tookMs > kLongestMs) shrink_ = std::min(shrink_ * 2, kSmallest);
        if (result.tookMs < kQuickMs) shrink_ = std::max(shrink_ / 2, 1);
        result.frameMs = medianMs();
        const bool wanted = on_ && work->generation == generation_;
        // Nobody saw the result, so the same image still has to be measured.
        if (wanted)
          emit measured(result);
        else
          last_.reset();
        gapMs_ = std::max(kPeriodMs, int(result.tookMs) * kMostOfTime);
        wake();
      });
}

}  // namespace trimtab::workbench
