#include "log_angles.h"

#include <algorithm>
#include <cmath>

#include "column_advice.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// A step this near to a turn of radians is a wrap: as degrees, it would be a jump across all that is
/// recorded.
constexpr double kWrap = 5.8;

double largest(const std::vector<double>& angles) {
  double most = 0;
  for (const double angle : angles) most = std::max(most, std::abs(angle));
  return most;
}

bool wraps(const std::vector<double>& angles) {
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (std::abs(angles[i] - angles[i - 1]) > kWrap) return true;
  return false;
}

bool leavesQuarterOfRadians(const std::vector<double>& angles) {
  return std::any_of(angles.begin(), angles.end(),
                     [](double angle) { return std::abs(std::remainder(angle, 2 * kPi)) > kPi / 2 + 1e-3; });
}

}  // namespace

Unit angleUnit(const UnnamedAngles& angles, const std::string& where, Findings& findings) {
  const auto note = [&](const char* text) { findings.push_back({Severity::note, where, "", "", text}); };
  double most = 0;
  bool wrap = false;
  for (const auto& column : angles.columns) {
    most = std::max(most, largest(column));
    wrap = wrap || wraps(column);
  }
  if (most == 0) return Unit::degrees;
  if (most > 2 * kPi + 1e-3) {
    note("angles name no unit and leave a turn of radians: read as degrees");
    return Unit::degrees;
  }
  if (wrap) {
    note("angles name no unit and none leaves one turn of radians, at which they wrap: read as radians");
    return Unit::radians;
  }
  const bool noPitch = std::all_of(angles.maybePitch.begin(), angles.maybePitch.end(),
                                   [&](std::size_t i) { return leavesQuarterOfRadians(angles.columns[i]); });
  if (noPitch && !angles.maybePitch.empty()) {
    note("angles name no unit, and as radians the pitch would leave a quarter turn: read as degrees");
    return Unit::degrees;
  }
  const bool within01 = std::all_of(angles.columns.begin(), angles.columns.end(), [](const auto& column) {
    return std::all_of(column.begin(), column.end(), [](double a) { return a >= 0 && a <= 1; });
  });
  const auto map = [&angles](const char* unit, bool shares) {
    std::string text;
    for (std::size_t i = 0; i < angles.names.size(); ++i) {
      text += (i > 0 ? "," : "") + angles.quantities[i] + unit + '=' + columnText(angles.names[i]);
      if (shares) text += angles.quantities[i].ends_with("pitch") ? "*180-90" : "*360-180";
    }
    return text;
  };
  const std::string& name = angles.names.front();
  findings.push_back({Severity::error, where, name,
                      "a unit in the names of angles, as " + name + "_deg or " + name + "_rad",
                      "angles of at most " + numberText(most, 4) + ", which may be degrees or radians" +
                          (within01 ? " or, from 0 to 1, shares of a range" : "") + ": " +
                          mapAdvice({map("_deg", false), map("_rad", false),
                                     within01 ? map("_deg", true) : std::string()})});
  return Unit::none;
}

}  // namespace trimtab
