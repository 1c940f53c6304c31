#include "axis.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "svg.h"

namespace trimtab::plot {
namespace {

constexpr double kZeroBand = 0.1;
constexpr double kDecades = 30;  ///< largest over smallest from which an even scale crowds

double roundStepAbove(double rough) {
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double scaled = rough / power;
  return power * (scaled <= 1.0001 ? 1 : scaled <= 2.0001 ? 2 : scaled <= 5.0001 ? 5 : 10);
}

struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  bool zero = false;
};
Span spanOf(const std::vector<double>& values, bool positive) {
  Span span;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    if (positive && v <= 0) {
      span.zero = true;
      continue;
    }
    span.low = std::min(span.low, v);
    span.high = std::max(span.high, v);
  }
  return span;
}

/// Where a logarithmic axis may have ticks: digits of each power of ten, or even steps where it spans less.
std::vector<double> placesOn(double low, double high) {
  std::vector<double> places;
  if (high < 3 * low) {
    const double step = roundStepAbove(std::max(high - low, low * 0.01) / 5);
    for (double i = std::floor(low / step) - 1; i <= std::ceil(high / step) + 1; ++i)
      if (i > 0) places.push_back(i * step);
    return places;
  }
  const double decades = std::log10(high / low);
  const std::vector<double> digits = decades > 4     ? std::vector{1.0}
                                     : decades > 1.2 ? std::vector{1.0, 2.0, 5.0}
                                                     : std::vector{1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0};
  for (double power = std::floor(std::log10(low)); power <= std::ceil(std::log10(high)); ++power)
    for (const double digit : digits) places.push_back(digit * std::pow(10, power));
  return places;
}

}  // namespace

bool spansDecades(const std::vector<double>& values) {
  const Span span = spanOf(values, true);
  return span.high >= span.low && span.high / span.low >= kDecades;
}

void Axis::tickEvenly(double step) {
  for (double i = std::ceil(low_ / step - 1e-6); i * step <= high_ + step * 1e-6; ++i)
    ticks_.push_back({i * step, tickText(i * step)});
}

Axis Axis::even(double low, double high, bool fromZero, int steps) {
  if (fromZero) low = std::min(low, 0.0), high = std::max(high, 0.0);
  if (!(high > low)) high = low + std::max(1.0, std::abs(low) * 0.1);
  const double step = roundStepAbove((high - low) / steps);
  Axis axis(std::floor(low / step + 1e-9) * step, std::ceil(high / step - 1e-9) * step);
  axis.tickEvenly(step);
  return axis;
}

Axis Axis::exactly(double low, double high) {
  if (!(high > low)) high = low + std::max(1.0, std::abs(low) * 0.1);
  Axis axis(low, high);
  axis.tickEvenly(roundStepAbove((high - low) / 5));
  return axis;
}

Axis Axis::categories(std::size_t count) {
  return {0, static_cast<double>(std::max<std::size_t>(count, 1))};
}

Axis Axis::logarithmic(double low, double high, bool zero) {
  Axis axis(low, high);
  axis.log_ = true;
  axis.zero_ = zero;
  // The ticks that just hold both ends.
  const std::vector<double> places = placesOn(low, high);
  auto first = std::upper_bound(places.begin(), places.end(), low * (1 + 1e-9));
  if (first != places.begin()) --first;
  auto last = std::lower_bound(first, places.end(), high * (1 - 1e-9));
  if (last == places.end()) --last;
  if (last == first) last == places.end() - 1 ? --first : ++last;
  axis.low_ = *first;
  axis.high_ = *last;
  if (zero) axis.ticks_.push_back({0, "0"});
  for (; first <= last; ++first) axis.ticks_.push_back({*first, tickText(*first)});
  return axis;
}

Axis Axis::of(const std::vector<double>& values, bool logarithmic, bool fromZero, int steps) {
  const Span span = spanOf(values, logarithmic);
  if (!(span.high >= span.low)) return even(0, 1, true, steps);
  return logarithmic ? Axis::logarithmic(span.low, span.high, span.zero)
                     : even(span.low, span.high, fromZero, steps);
}

void Axis::widen(double atLow, double atHigh) {
  begin_ = atLow;
  length_ = 1 - atLow - atHigh;
}

double Axis::at(double value) const {
  if (!log_) return begin_ + length_ * (value - low_) / (high_ - low_);
  const double band = zero_ ? kZeroBand : 0;
  const double place = value > 0 ? band + (1 - band) * std::log(value / low_) / std::log(high_ / low_)
                       : zero_   ? band * 0.3
                                 : -1;
  return begin_ + length_ * place;
}

}  // namespace trimtab::plot
