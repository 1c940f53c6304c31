#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace trimtab {

/// Bounds what can be measured, and so what can be learned. Times are milliseconds.
namespace cost_bounds {
inline constexpr double kShortestMs = 1e-6, kLongestMs = 60e3;
/// The range of a quantity that is not 0: from a pixel in millions of them, to far more triangles than an
/// image has, in ten thousands.
inline constexpr double kLeastQuantity = 1e-6, kMostQuantity = 1e8;
/// The range of what one unit of a quantity costs.
inline constexpr double kLeastScale = kShortestMs / kMostQuantity / 10,
                        kMostCost = kLongestMs / kLeastQuantity;
inline constexpr double kMostImages = 1e12;
}  // namespace cost_bounds

/// Learns a time as a sum of coefficients times quantities, one image at a time: a Kalman filter whose
/// coefficients may drift. It needs no scale of its own: the first image gives one. A first image that takes
/// more than twice as long as one of the next built what they find, and is forgotten.
///
/// A single image cannot move it far: an error counts as at most two standard deviations, because late images
/// are later than early ones are early, and what most images take is to be predicted. Five errors in a row of
/// more than three, all too long or all too short, are a change of the machine instead, as when another
/// program takes a core or a clock steps; the coefficients then follow at once.
template <std::size_t N>
class LinearCost {
 public:
  using Quantities = std::array<double, N>;

  /// Returns the predicted time. 0 before the first image.
  double predict(const Quantities& x) const {
    double sum = 0;
    for (std::size_t i = 0; i < N; ++i) sum += state_.coefficient[i] * x[i];
    return sum;
  }
  /// Returns the standard deviation of a predicted time.
  double deviation(const Quantities& x) const {
    const Quantities p = covarianceTimes(x);
    double variance = state_.noise;
    for (std::size_t i = 0; i < N; ++i) variance += x[i] * p[i];
    return std::sqrt(std::max(variance, 0.0));
  }

  /// Learns from a measured time. Quantities and times outside cost_bounds are ignored.
  void observe(const Quantities& x, double ms) {
    for (const double quantity : x)
      if (!(std::abs(quantity) <= cost_bounds::kMostQuantity)) return;
    if (!(ms >= cost_bounds::kShortestMs && ms <= cost_bounds::kLongestMs)) return;
    if (state_.images == 0 || (state_.images < kFirst && ms < firstMs_ / 2)) begin(x, ms);
    noteChange(x, ms);
    ++state_.images;
    const double error = ms - predict(x), sigma = deviation(x), limit = kCounted * sigma;
    const double counted = std::clamp(error, -limit, limit);
    const Quantities p = covarianceTimes(x);
    const double variance = sigma * sigma;
    for (std::size_t i = 0; i < N; ++i) state_.coefficient[i] += p[i] * counted / variance;
    double known = 0;
    for (std::size_t i = 0; i < N; ++i) known += x[i] * p[i];
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j < N; ++j) state_.covariance[i][j] -= p[i] * p[j] / variance;
    keepCostsPositive();
    for (std::size_t i = 0; i < N; ++i) loosen(i, i == 0 ? kFirstDrift : kDrift);
    state_.noise += kNoiseGain * (counted * counted - known - state_.noise);
    state_.noise = std::clamp(state_.noise, kLeastNoise * ms * kLeastNoise * ms,
                              cost_bounds::kLongestMs * cost_bounds::kLongestMs);
  }

  struct State {
    Quantities coefficient{};
    std::array<Quantities, N> covariance{};
    Quantities scale{};  ///< of each coefficient, from the first image
    double noise = 0;    ///< variance of a time around its prediction
    double images = 0;

    /// Calls `visit(key, number, low, high)` for each number, with the range that it can have been learned
    /// in. What has seen no image is all zeros. An uncertainty is at most the scale, and at least what a
    /// coefficient drifts by in an image; a covariance is at most what its variances allow.
    template <class Self, class Visit>
    static void forEachNumber(Self& self, const Visit& visit) {
      namespace bounds = cost_bounds;
      // Rounding may leave numbers a little beyond.
      constexpr double kRounded = 1 + 1e-6;
      const bool learned = self.images != 0;
      const auto either = [learned](double bound) { return learned ? bound : 0; };
      const auto place = [](std::size_t i) { return '[' + std::to_string(i) + ']'; };
      for (std::size_t i = 0; i < N; ++i)
        visit("coefficient" + place(i), self.coefficient[i], 0.0, either(bounds::kMostCost));
      for (std::size_t i = 0; i < N; ++i)
        for (std::size_t j = 0; j < N; ++j) {
          const double both = self.scale[i] * self.scale[j];
          double low = kLeastVariance * both, high = kRounded * both;
          if (i != j) {
            // Symmetric, and no farther from 0 than the variances allow.
            const double most = kRounded * std::sqrt(self.covariance[i][i] * self.covariance[j][j]);
            const double other = j < i ? self.covariance[j][i] : 0, off = j < i ? most * 1e-6 : most;
            low = std::max(other - off, -most), high = std::min(other + off, most);
          }
          visit("covariance" + place(i) + place(j), self.covariance[i][j], either(low), either(high));
        }
      for (std::size_t i = 0; i < N; ++i)
        visit("scale" + place(i), self.scale[i], either(bounds::kLeastScale), either(bounds::kMostCost));
      constexpr double kLeast = kLeastNoise * bounds::kShortestMs;
      visit("noise", self.noise, either(kLeast * kLeast), either(bounds::kLongestMs * bounds::kLongestMs));
      visit("images", self.images, 0.0, bounds::kMostImages);
    }
    bool isFinite() const {
      double sum = noise + images;
      for (std::size_t i = 0; i < N; ++i) {
        sum += coefficient[i] + scale[i];
        for (const double c : covariance[i]) sum += c;
      }
      return std::isfinite(sum);
    }
  };
  const State& state() const { return state_; }
  /// Restores a state that was saved. Its uncertainty grows to at least a part of its coefficients, because
  /// the machine may have changed since.
  void restore(const State& state) {
    state_ = state;
    for (std::size_t i = 0; i < N; ++i) {
      state_.scale[i] = std::max(state_.scale[i], kDistrust * state_.coefficient[i]);
      loosen(i, kDistrust);
    }
  }

 private:
  static constexpr double kCounted = 2, kSpike = 3, kNoiseGain = 0.05, kLeastNoise = 0.01, kDistrust = 0.2;
  /// Drift of a coefficient in one image, as a part of its scale: the first (what is there in every image)
  /// within some tens of images, the others within some hundreds.
  static constexpr double kFirstDrift = 0.007, kDrift = 0.002;
  static constexpr double kLeastVariance =
      kDrift * kDrift / 2;  ///< of a coefficient, in squares of its scale
  static constexpr int kChange = 5;
  static constexpr double kMostRatio = 8;  ///< between the times of one machine before and after a change
  static constexpr double kFirst = 8;      ///< images among which the first may be forgotten

  void begin(const Quantities& x, double ms) {
    state_ = {};
    firstMs_ = ms;
    const auto there = std::count_if(x.begin(), x.end(), [](double quantity) { return quantity > 0; });
    for (std::size_t i = 0; i < N; ++i) {
      state_.scale[i] = ms / static_cast<double>(std::max<std::ptrdiff_t>(there, 1)) /
                        (x[i] > 0 ? std::max(x[i], cost_bounds::kLeastQuantity) : 1);
      state_.coefficient[i] = x[i] > 0 ? state_.scale[i] : 0;
      state_.covariance[i][i] = state_.scale[i] * state_.scale[i];
    }
    state_.noise = 0.01 * ms * ms;
  }

  /// A coefficient below 0 becomes 0, and the others become what they are most likely to be if it is 0. Left
  /// to themselves they would predict too much for as long as it stays there.
  void keepCostsPositive() {
    std::array<Quantities, N> p = state_.covariance;  // given that some coefficients are 0
    Quantities& c = state_.coefficient;
    for (std::size_t pass = 0; pass < N; ++pass) {
      const auto i = static_cast<std::size_t>(std::min_element(c.begin(), c.end()) - c.begin());
      if (!(c[i] < 0) || !(p[i][i] > 0)) break;
      const Quantities column = p[i];
      const double part = c[i] / column[i];
      for (std::size_t j = 0; j < N; ++j) {
        c[j] -= column[j] * part;
        for (std::size_t k = 0; k < N; ++k) p[j][k] -= column[j] * column[k] / column[i];
      }
      c[i] = 0;
    }
    for (double& coefficient : c) coefficient = std::max(coefficient, 0.0);
  }

  Quantities covarianceTimes(const Quantities& x) const {
    Quantities product{};
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j < N; ++j) product[i] += state_.covariance[i][j] * x[j];
    return product;
  }

  /// Makes a coefficient less certain by a part of its scale.
  void loosen(std::size_t i, double partOfScale) {
    const double step = partOfScale * state_.scale[i];
    state_.covariance[i][i] += step * step;
    // A coefficient is never less certain than at the beginning. Scaling row and column keeps the matrix a
    // covariance.
    const double part = state_.scale[i] / std::sqrt(state_.covariance[i][i]);
    if (!(part < 1)) return;
    for (std::size_t j = 0; j < N; ++j) state_.covariance[i][j] *= part, state_.covariance[j][i] *= part;
  }

  /// After a change of the machine every coefficient is so many times as large, which is all that a single
  /// image can say, and uncertain.
  void noteChange(const Quantities& x, double ms) {
    const double expected = predict(x), error = ms - expected, limit = kSpike * deviation(x);
    const int sign = error > limit ? 1 : error < -limit ? -1 : 0;
    streak_ = sign != 0 && sign * streak_ >= 0 ? streak_ + sign : sign;
    if (std::abs(streak_) < kChange) return;
    streak_ = 0;
    const double ratio = std::clamp(ms / std::max(expected, ms / kMostRatio), 1 / kMostRatio, kMostRatio);
    for (std::size_t i = 0; i < N; ++i) {
      state_.coefficient[i] = std::min(state_.coefficient[i] * ratio, cost_bounds::kMostCost);
      state_.covariance[i][i] += state_.scale[i] * state_.scale[i] / 4;
    }
  }

  State state_;
  double firstMs_ = 0;
  int streak_ = 0;
};

}  // namespace trimtab
