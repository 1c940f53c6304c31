#pragma once

#include <algorithm>
#include <bit>
#include <random>
#include <vector>

#include "trimtab/preset/table.h"
#include "trimtab/units/number.h"

namespace trimtab::test {

/// Parameters drawn from every row's hard range, with all the digits a double has. Rules between them may be
/// broken.
class RandomParameters {
 public:
  explicit RandomParameters(unsigned seed) : random_(seed) {}

  TuningParameters operator()() {
    TuningParameters parameters;
    for (const ParameterRow& row : parameterRows()) row.set(parameters, value(row));
    return parameters;
  }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  std::size_t below(std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_);
  }

 private:
  std::vector<double> rising(std::size_t count, double low, double high) {
    std::vector<double> values(count);
    for (double& v : values) v = between(low, high);
    std::sort(values.begin(), values.end());
    return values;
  }

  ParameterValue value(const ParameterRow& row) {
    switch (row.kind) {
      case Kind::scalar: {
        const double number = between(row.hard.low, row.hard.high);
        return row.whole ? std::floor(number) : number;
      }
      case Kind::flag:
        return below(2) == 1;
      case Kind::choice:
        return ChoiceIndex{below(row.choices.size())};
      case Kind::curve: {
        CurvePoints curve;
        for (const double x : rising(2 + below(CurvePoints::kCapacity - 1), row.hard.low, row.hard.high))
          curve.point[curve.size++] = {x, between(0, 1)};
        return curve;
      }
      case Kind::bands: {
        BandList bands;
        for (const double low : rising(1 + below(BandList::kCapacity), 1e-9, BandList::kTop))
          bands.band[bands.size++] = {low, 16 + static_cast<int>(below(8000)),
                                      16 + static_cast<int>(below(8000))};
        return bands;
      }
      case Kind::lines: {
        TextLines lines;
        const bool terms = row.key == "policy.terms";
        for (std::size_t i = 0, count = below(5); i < count; ++i)
          lines.line.push_back(terms ? "speed t" + std::to_string(i) + " = ramp " +
                                           numberText(between(0, 500)) + " " + numberText(between(501, 1500))
                                     : "if speed is any then lod_scale = " + numberText(between(1, 16)) +
                                           " with " + numberText(between(0, 1)) +
                                           " # \"h\u00f6her\" & <2>; a\\b 'c'");
        return lines;
      }
    }
    return 0.0;
  }

  std::mt19937_64 random_;
};

inline bool sameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Equal to the last bit: unlike ==, tells a negative zero from zero.
inline bool sameBits(const ParameterValue& a, const ParameterValue& b) {
  if (a.index() != b.index() || a != b) return false;
  if (const auto* x = std::get_if<double>(&a)) return sameBits(*x, std::get<double>(b));
  if (const auto* x = std::get_if<CurvePoints>(&a)) {
    const auto& y = std::get<CurvePoints>(b);
    for (std::size_t i = 0; i < x->size; ++i)
      if (!sameBits(x->point[i].x, y.point[i].x) || !sameBits(x->point[i].y, y.point[i].y)) return false;
  }
  if (const auto* x = std::get_if<BandList>(&a)) {
    const auto& y = std::get<BandList>(b);
    for (std::size_t i = 0; i < x->size; ++i)
      if (!sameBits(x->band[i].low, y.band[i].low)) return false;
  }
  return true;
}

inline bool sameBits(const TuningParameters& a, const TuningParameters& b) {
  return std::all_of(parameterRows().begin(), parameterRows().end(),
                     [&](const ParameterRow& row) { return sameBits(row.get(a), row.get(b)); });
}

}  // namespace trimtab::test
