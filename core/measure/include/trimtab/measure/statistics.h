#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "trimtab/measure/cost_stages.h"

namespace trimtab {

/// Returns whether a quantile (0 to 1) may be said of so many samples: on average at least one of them has to
/// lie beyond it, so that the 95th percentile needs 20 samples and the 99th 100. The median and both ends
/// need one. All that shows a percentile asks here, through the functions below.
bool isEnoughFor(double fraction, std::size_t samples);

/// Returns the quantile by nearest rank: the smallest sample that at least `fraction` of the samples do not
/// exceed; the smallest of all for 0. A NaN is no sample. Returns NaN if the samples are not enough for it.
double quantileOf(std::vector<double> samples, double fraction);

/// Returns the rank, counted from 1 at the low end, of the highest of `n` sorted samples that lies above the
/// quantile (0 to 1) of what they were drawn from with a chance of at most `tail`; 0 if not even the lowest
/// is so sure. It assumes of the samples only that they are independent.
std::size_t quantileRank(std::size_t n, double fraction, double tail);

/// Says where the quantile of what the samples were drawn from lies: it is at least `low`, and it is at most
/// `high`, each with a confidence of 95 %. An end that the samples are too few for is infinite; both are NaN
/// without samples.
struct QuantileBounds {
  double low = 0, high = 0;
};
QuantileBounds quantileBounds(std::vector<double> samples, double fraction);

/// Keeps the newest samples of one quantity and computes their order statistics. Values that are not finite,
/// as of a stage that was not run, are not samples.
class SampleWindow {
 public:
  explicit SampleWindow(std::size_t capacity);
  void add(double value);
  void clear();
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return ring_.size(); }
  /// Returns the newest sample. This and all functions below return NaN if there is no sample.
  double last() const;
  double mean() const;
  double largest() const;
  /// Returns the same as quantileOf(), for the samples of the window.
  double quantile(double fraction) const;
  double median() const { return quantile(0.5); }

 private:
  std::vector<double> ring_;
  mutable std::vector<double> sorted_;
  std::size_t next_ = 0, size_ = 0;
};

/// Percentiles that the samples are not enough for are NaN.
struct Distribution {
  double median = 0, p95 = 0, p99 = 0, mean = 0, largest = 0;
  std::size_t samples = 0;
};

/// Keeps frame costs by stage over the newest frames. It allocates only when it is made.
class FrameStatistics {
 public:
  explicit FrameStatistics(std::size_t frames = 600);
  void add(const FrameCost& cost);
  void clear();
  Distribution of(CostField stage) const { return distribution(window(stage)); }
  std::size_t frames() const { return window(&FrameCost::total).size(); }

 private:
  const SampleWindow& window(CostField stage) const;
  static Distribution distribution(const SampleWindow& samples);
  std::vector<SampleWindow> window_;  ///< in the order of kCostStages
};

}  // namespace trimtab
