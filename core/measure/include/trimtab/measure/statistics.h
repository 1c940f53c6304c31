#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "trimtab/measure/cost_stages.h"

namespace trimtab {

/// The last so many samples of one quantity and their order statistics. Values that are not finite (a stage
/// that was not run) are not samples.
class SampleWindow {
 public:
  explicit SampleWindow(std::size_t capacity);
  void add(double value);
  void clear();
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return ring_.size(); }
  /// The newest sample; NaN where there is none, as for everything below.
  double last() const;
  double mean() const;
  double largest() const;
  /// Nearest rank: the smallest sample that at least `fraction` of the samples do not exceed; 0 gives the
  /// smallest.
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

/// Frame costs by stage over the last so many frames. No allocation after construction.
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
