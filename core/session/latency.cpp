#include "trimtab/session/latency.h"

#include <cmath>

namespace trimtab {
namespace {

/// Waiting kernel times are dropped beyond this, when nobody draws and nobody says so.
constexpr std::size_t kMostWaiting = 8192;

}  // namespace

void LatencyMeter::arrived(double kernelTime) {
  if (!std::isfinite(kernelTime)) return;
  if (waiting_.size() >= kMostWaiting) waiting_.erase(waiting_.begin(), waiting_.begin() + kMostWaiting / 2);
  waiting_.push_back(kernelTime);
}

void LatencyMeter::requested(double now) {
  inPicture_.insert(inPicture_.end(), waiting_.begin(), waiting_.end());
  waiting_.clear();
  requestedAt_ = now;
}

void LatencyMeter::finished(double now) {
  if (!inPicture_.empty()) {
    latency_.shown.add((now - inPicture_.back()) * 1e3);
    latency_.frame.add((now - requestedAt_) * 1e3);
  }
  for (const double kernelTime : inPicture_) latency_.every.add((now - kernelTime) * 1e3);
  inPicture_.clear();
}

void LatencyMeter::dropped() {
  waiting_.clear();
  inPicture_.clear();
}

}  // namespace trimtab
