#include "trimtab/measure/statistics.h"
#include "trimtab/units/not_finite.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace trimtab {
SampleWindow::SampleWindow(std::size_t capacity) : ring_(std::max<std::size_t>(capacity, 1)) {
  sorted_.reserve(ring_.size());
}

void SampleWindow::add(double value) {
  if (!std::isfinite(value)) return;
  ring_[next_] = value;
  next_ = (next_ + 1) % ring_.size();
  size_ = std::min(size_ + 1, ring_.size());
}

void SampleWindow::clear() {
  next_ = size_ = 0;
}

double SampleWindow::last() const {
  return size_ == 0 ? kNan : ring_[(next_ + ring_.size() - 1) % ring_.size()];
}

// The ring fills from its start, so the samples are its first size_ entries whatever their order.
double SampleWindow::mean() const {
  if (size_ == 0) return kNan;
  const auto end = ring_.begin() + static_cast<std::ptrdiff_t>(size_);
  return std::accumulate(ring_.begin(), end, 0.0) / static_cast<double>(size_);
}

double SampleWindow::largest() const {
  if (size_ == 0) return kNan;
  return *std::max_element(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(size_));
}

double SampleWindow::quantile(double fraction) const {
  if (size_ == 0 || std::isnan(fraction)) return kNan;
  const auto samples = static_cast<double>(size_);
  const double rank = std::clamp(std::ceil(fraction * samples), 1.0, samples);
  sorted_.assign(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(size_));
  const auto at = sorted_.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(sorted_.begin(), at, sorted_.end());
  return *at;
}

FrameStatistics::FrameStatistics(std::size_t frames) : window_(kCostStages.size(), SampleWindow(frames)) {}

void FrameStatistics::add(const FrameCost& cost) {
  for (std::size_t i = 0; i < kCostStages.size(); ++i) window_[i].add(cost.*kCostStages[i].ms);
}

void FrameStatistics::clear() {
  for (SampleWindow& window : window_) window.clear();
}

const SampleWindow& FrameStatistics::window(CostField stage) const {
  std::size_t i = 0;
  while (kCostStages[i].ms != stage) ++i;
  return window_[i];
}

Distribution FrameStatistics::distribution(const SampleWindow& w) {
  return {w.median(), w.quantile(0.95), w.quantile(0.99), w.mean(), w.largest(), w.size()};
}

}  // namespace trimtab
