#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "answer.h"
#include "trimtab/units/result.h"

/// Measures a preset at several values of one or two parameters. Each set of values is a preset of its own,
/// whose name says them, so that results of a sweep are results like any others.
namespace trimtab::harness {

/// A parameter and the values at which it is measured, as their texts.
struct SweepAxis {
  std::string key;
  std::vector<std::string> values;
};

/// At most so many parameters are swept at once, and each has at most so many values.
inline constexpr std::size_t kMostAxes = 2, kMostValues = 64;

/// Reads "KEY=A,B,C". Whether the key and the values are good is not checked here. Refuses a text without a
/// key, an empty or doubled value, and more than kMostValues.
Result<SweepAxis> parseAxis(std::string_view text);

/// Values of parameters, "KEY=VALUE" each.
using Settings = std::vector<std::string>;
/// Returns every combination of the axes' values, the last axis first to change. Without axes that is one
/// combination without settings.
std::vector<Settings> combinations(const std::vector<SweepAxis>& axes);
/// Returns the name of a preset with these settings, such as "default lod.screen_space_error_px=4".
std::string sweptName(const std::string& base, const Settings& settings);

/// Holds what an answer says of a swept preset in one culling case.
struct Sweep {
  static constexpr std::size_t kNotMeasured = std::numeric_limits<std::size_t>::max();

  std::string base, method;
  std::vector<SweepAxis> axes;  ///< one or two
  /// Index into Answer::rows by the axes' values, the last axis first to change; kNotMeasured where a
  /// combination is missing.
  std::vector<std::size_t> rows;

  std::size_t at(std::size_t first, std::size_t second) const {
    return rows[first * (axes.size() > 1 ? axes[1].values.size() : 1) + second];
  }
};

/// Returns the sweeps that an answer holds, by preset and case, in the order of the results.
std::vector<Sweep> sweepsOf(const Answer& answer);

}  // namespace trimtab::harness
