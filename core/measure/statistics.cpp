#include "trimtab/measure/statistics.h"
#include "trimtab/units/not_finite.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace trimtab {
namespace {

constexpr double kEachTail = 0.05;

double nearestRank(std::vector<double>& samples, double fraction) {
  if (std::isnan(fraction) || !isEnoughFor(fraction, samples.size())) return kNan;
  const auto count = static_cast<double>(samples.size());
  const double rank = std::clamp(std::ceil(fraction * count), 1.0, count);
  const auto at = samples.begin() + static_cast<std::ptrdiff_t>(rank) - 1;
  std::nth_element(samples.begin(), at, samples.end());
  return *at;
}

}  // namespace

bool isEnoughFor(double fraction, std::size_t samples) {
  if (fraction <= 0 || fraction == 0.5 || fraction >= 1) return samples > 0;
  // 1 - 0.95 is no double, so that twenty of it are only about one.
  return static_cast<double>(samples) * std::min(fraction, 1 - fraction) > 1 - 1e-9;
}

double quantileOf(std::vector<double> samples, double fraction) {
  std::erase_if(samples, [](double value) { return std::isnan(value); });
  return nearestRank(samples, fraction);
}

/// With the k-th smallest sample as the lower end, the quantile lies below it when at most k - 1 samples fell
/// under the quantile: P(Bin(n, fraction) <= k - 1).
std::size_t quantileRank(std::size_t n, double fraction, double tail) {
  const double count = static_cast<double>(n), under = std::log(fraction), over = std::log1p(-fraction);
  double chance = 0;
  for (std::size_t fewer = 0; fewer < n; ++fewer) {
    const double k = static_cast<double>(fewer);
    // The sum uses logarithms, because 2^-n is no double from 1,075 samples on.
    chance += std::exp(std::lgamma(count + 1) - std::lgamma(k + 1) - std::lgamma(count - k + 1) + k * under +
                       (count - k) * over);
    if (chance > tail) return fewer;
  }
  return n;
}

QuantileBounds quantileBounds(std::vector<double> samples, double fraction) {
  std::erase_if(samples, [](double value) { return std::isnan(value); });
  const std::size_t n = samples.size();
  if (n == 0) return {kNan, kNan};
  std::sort(samples.begin(), samples.end());
  const std::size_t below = quantileRank(n, fraction, kEachTail);
  const std::size_t above = quantileRank(n, 1 - fraction, kEachTail);
  return {below > 0 ? samples[below - 1] : -kInfinity, above > 0 ? samples[n - above] : kInfinity};
}

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
  sorted_.assign(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(size_));
  return nearestRank(sorted_, fraction);
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
