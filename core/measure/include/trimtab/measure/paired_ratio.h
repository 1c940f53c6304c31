#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

/// Says what may be said of two settings that were measured in turns: how they compare, with an interval, and
/// whether they differ at all. Whatever compares times or errors asks here.
namespace trimtab {

/// The confidence of an interval where nothing else is said.
inline constexpr double kConfidence = 0.95;

/// The median of b/a over pairs that were measured one after the other, and the interval that holds the true
/// median with at least 95 % confidence. The interval comes from order statistics of the binomial
/// distribution, which assume of the noise only that pairs are independent. The median of an even number of
/// pairs is the geometric mean of the middle two, so that a/b has exactly the reciprocals. Without pairs all
/// are NaN; below six pairs no interval is sure enough, and it is 0 to infinity.
struct PairedRatio {
  double median = 0, low = 0, high = 0;
  std::size_t pairs = 0;
};

/// Computes it. A pair does not count if either is not finite, if `a` is not above 0, or if `b` is below 0.
PairedRatio pairedRatio(std::span<const double> a, std::span<const double> b,
                        double confidence = kConfidence);

/// The same for differences b - a: their median (the mean of the middle two for an even number of pairs) with
/// its interval. Without pairs all are NaN; below six pairs the interval is -infinity to infinity.
struct PairedDifference {
  double median = 0, low = 0, high = 0;
  std::size_t pairs = 0;
};

/// Computes it. A pair does not count if either is not finite.
PairedDifference pairedDifference(std::span<const double> a, std::span<const double> b,
                                  double confidence = kConfidence);

/// Returns the rank of the interval's ends among `n` sorted values, counted from 1 at either end; 0 if `n` is
/// too small for an interval.
std::size_t medianIntervalRank(std::size_t n, double confidence = kConfidence);

/// Names what an interval says of b beside a.
enum class MeasuredDifference {
  unknown,  ///< the pairs are too few to say anything
  none,     ///< the interval holds equality: what differs may be noise
  less,
  more
};
MeasuredDifference differenceOf(const PairedRatio& ratio);
MeasuredDifference differenceOf(const PairedDifference& difference);

/// Returns what frames say of the error of b beside that of a, frame by frame; smaller is better. Frames of
/// equal error count only as such: identical images are `none`, and settings that differ in some frames are
/// judged by those. An error is less or more only if the median of these frames and the mean of all agree.
MeasuredDifference errorDifference(std::span<const double> a, std::span<const double> b,
                                   double confidence = kConfidence);

/// Says what the ratio of two times is: "12 % faster", "3.4 % slower", "2.1 times as long", "no difference",
/// "too few pairs to tell", or "not measured".
std::string inWords(const PairedRatio& ratio);

/// Reports whether one setting is better than another in two quantities of which less is better: surely less
/// in one, and not surely more in the other. The differences are those of the other setting beside the one.
bool isBetterInBoth(MeasuredDifference first, MeasuredDifference second);

/// Returns which settings lie on the front of two quantities of which less is better, in the order of `x`.
/// A setting is off it if one of those that no other excels in both beats it. `beats(i, j)` says whether i
/// surely beats j, so that noise neither puts a setting on the front nor takes one off. A setting without
/// finite numbers is not on it.
std::vector<std::size_t> frontOf(std::span<const double> x, std::span<const double> y,
                                 const std::function<bool(std::size_t, std::size_t)>& beats);

}  // namespace trimtab
