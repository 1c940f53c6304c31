#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "trimtab/preset/parameters.h"
#include "trimtab/preset/table.h"

/// Declares what must hold inside a curve or a band list, and between parameters. These are
/// constant expressions, so that the compiler checks the defaults.
namespace trimtab {

constexpr bool isFinite(double value) {
  return value - value == 0;
}

enum class CurveFlaw { none, count, not_a_number, outside_x, outside_y, falling, triple };

/// Returns the first flaw and the point that has it. Two points may share an x: a step, at which the later
/// one counts.
struct CurveCheck {
  CurveFlaw flaw = CurveFlaw::none;
  std::size_t at = 0;
};

constexpr CurveCheck checkCurve(const CurvePoints& curve, Range x) {
  if (curve.size < 2 || curve.size > CurvePoints::kCapacity) return {CurveFlaw::count, curve.size};
  for (std::size_t i = 0; i < curve.size; ++i) {
    const CurvePoint p = curve.point[i];
    if (!isFinite(p.x) || !isFinite(p.y)) return {CurveFlaw::not_a_number, i};
    if (p.x < x.low || p.x > x.high) return {CurveFlaw::outside_x, i};
    if (p.y < 0 || p.y > 1) return {CurveFlaw::outside_y, i};
    if (i > 0 && p.x < curve.point[i - 1].x) return {CurveFlaw::falling, i};
    if (i > 1 && p.x == curve.point[i - 2].x) return {CurveFlaw::triple, i};
  }
  return {};
}

enum class BandFlaw { none, count, not_a_number, outside_low, falling, size };

struct BandCheck {
  BandFlaw flaw = BandFlaw::none;
  std::size_t at = 0;
};

constexpr BandCheck checkBands(const BandList& bands, Range size) {
  if (bands.size < 1 || bands.size > BandList::kCapacity) return {BandFlaw::count, bands.size};
  for (std::size_t i = 0; i < bands.size; ++i) {
    const Band& b = bands.band[i];
    if (!isFinite(b.low)) return {BandFlaw::not_a_number, i};
    if (b.low <= 0 || b.low >= BandList::kTop) return {BandFlaw::outside_low, i};
    if (i > 0 && b.low <= bands.band[i - 1].low) return {BandFlaw::falling, i};
    for (const int px : {b.widthPx, b.heightPx})
      if (px < size.low || px > size.high) return {BandFlaw::size, i};
  }
  return {};
}

/// Returns the width of the narrowest band; the last one ends at the scale's top.
constexpr double narrowestBand(const BandList& bands) {
  double narrowest = BandList::kTop;
  for (std::size_t i = 0; i < bands.size; ++i) {
    const double high = i + 1 < bands.size ? bands.band[i + 1].low : BandList::kTop;
    narrowest = high - bands.band[i].low < narrowest ? high - bands.band[i].low : narrowest;
  }
  return narrowest;
}

constexpr bool hysteresisLeavesBands(const TuningParameters& p) {
  return 2 * p.scheme.hysteresis.value() < narrowestBand(p.scheme.bands);
}
/// If it did not hold, the total would have to fall below 0 for the scheme to become *frustum* again.
constexpr bool hysteresisLeavesFrustum(const TuningParameters& p) {
  return p.scheme.bands.size == 0 || p.scheme.hysteresis.value() < p.scheme.bands.band[0].low;
}
constexpr bool maximumCoversCurve(const TuningParameters& p) {
  const CurvePoints& curve = p.altitude.curve;
  return p.altitude.reading == AltitudeReading::table || curve.size == 0 ||
         p.altitude.maximum.value() >= curve.point[curve.size - 1].x;
}
/// If it did not hold, every frame that moves at all would be fast.
constexpr bool someFieldOfViewIsLeft(const TuningParameters& p) {
  return (p.motion.leftFov + p.motion.rightFov).value() > 0;
}

/// Return what validate() finds wrong with each value by itself, and with values together (which must be
/// finite and in range).
Findings rangeFindings(const TuningParameters& parameters);
Findings ruleFindings(const TuningParameters& parameters);

/// Says what a rule demands, as a sentence, and names the parameter of its finding.
struct RuleText {
  std::string_view key, text;
};
std::vector<RuleText> ruleTexts();

}  // namespace trimtab
