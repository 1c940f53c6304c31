#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "trimtab/measure/cost_stages.h"

namespace trimtab {

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
  /// Returns the quantile by nearest rank: the smallest sample that at least `fraction` of the samples do not
  /// exceed; the smallest of all for 0.
  double quantile(double fraction) const;
  double median() const { return quantile(0.5); }

 private:
  std::vector<double> ring_;
  mutable std::vector<double> sorted_;
  std::size_t next_ = 0, size_ = 0;
};

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
