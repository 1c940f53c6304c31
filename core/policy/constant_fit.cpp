#include "constant_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "trimtab/units/number.h"

namespace trimtab::fuzzy_system {
namespace {

double product(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Goes some steps towards the constants of least weighted squares.
void approach(const ConstantMeans& means, const std::vector<double>& weight, std::vector<double> rest,
              std::vector<double>& constants) {
  constexpr int kSteps = 5;
  std::vector<double> towards(constants.size()), slope(constants.size()), change;
  for (std::size_t p = 0; p < rest.size(); ++p) rest[p] *= weight[p];
  means.gather(rest, slope);
  towards = slope;
  double steepness = product(slope, slope);
  for (int step = 0; step < kSteps && steepness > 0; ++step) {
    means.apply(towards, change);
    double bend = 0;
    for (std::size_t p = 0; p < change.size(); ++p) bend += weight[p] * change[p] * change[p];
    if (!(bend > 0)) return;
    const double length = steepness / bend;
    for (std::size_t c = 0; c < constants.size(); ++c) constants[c] += length * towards[c];
    for (std::size_t p = 0; p < rest.size(); ++p) rest[p] -= length * weight[p] * change[p];
    means.gather(rest, slope);
    const double next = product(slope, slope), part = next / steepness;
    for (std::size_t c = 0; c < constants.size(); ++c) towards[c] = slope[c] + part * towards[c];
    steepness = next;
  }
}

}  // namespace

void ConstantMeans::apply(const std::vector<double>& constants, std::vector<double>& values) const {
  values.assign(places(), 0);
  for (std::size_t p = 0; p < places(); ++p)
    for (std::size_t s = first_[p]; s < first_[p + 1]; ++s)
      values[p] += shares_[s].share * constants[shares_[s].constant];
}

void ConstantMeans::gather(const std::vector<double>& values, std::vector<double>& sums) const {
  std::fill(sums.begin(), sums.end(), 0);
  for (std::size_t p = 0; p < places(); ++p)
    for (std::size_t s = first_[p]; s < first_[p + 1]; ++s)
      sums[shares_[s].constant] += shares_[s].share * values[p];
}

FittedConstants fitConstants(const ConstantMeans& means, const std::vector<double>& wanted,
                             std::size_t constants, Range within, int rounds) {
  // Begins with what each constant would be if it were alone.
  FittedConstants best{{}, {}, HUGE_VAL};
  std::vector<double> now(constants), shares(constants), rest, weight(wanted.size(), 1);
  means.gather(wanted, now);
  means.gather(weight, shares);
  for (std::size_t c = 0; c < constants; ++c)
    now[c] = shares[c] > 0 ? now[c] / shares[c] : std::midpoint(within.low, within.high);
  const auto compare = [&] {
    for (double& constant : now) constant = std::clamp(constant, within.low, within.high);
    means.apply(now, rest);
    double most = 0, sum = 0;
    for (std::size_t p = 0; p < rest.size(); ++p) {
      rest[p] = wanted[p] - rest[p];
      most = std::max(most, std::abs(rest[p]));
      sum += std::abs(rest[p]);
    }
    if (best.constants.empty() || most < best.most) best = {now, rest, most};
    return sum;
  };
  compare();
  for (int round = 0; round < rounds; ++round) {
    approach(means, weight, rest, now);
    const double sum = compare();
    if (!(sum > 0)) break;
    for (std::size_t p = 0; p < rest.size(); ++p)
      weight[p] *= std::abs(rest[p]) / sum * static_cast<double>(rest.size());
  }
  return best;
}

double roundedFit(double constant) {
  return std::isfinite(constant) ? *readNumber(numberText(constant, 6)) : constant;
}

}  // namespace trimtab::fuzzy_system
