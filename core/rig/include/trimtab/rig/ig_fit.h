#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/hold/frame_hold.h"
#include "trimtab/measure/paired_ratio.h"
#include "trimtab/rig/ig_profile.h"

/// What a flight on an image generator (IG) has taught about it, while one lever at a time moved.
namespace trimtab {

/// One setting of one lever, beside the neutral setting of the same views.
struct LeverPoint {
  std::size_t row = 0;  ///< in kFrameLeverRows
  double value = 0;     ///< in our unit
  PairedRatio time, load;
  double flip = std::numeric_limits<double>::quiet_NaN();  ///< mean over the views; NaN without images
  /// The 95th percentile of how far blocks of the image moved, the median over the views, pixels; NaN
  /// without.
  double shiftPx = std::numeric_limits<double>::quiet_NaN();
};

struct IgFit {
  std::string ig;  ///< IgProfile::name
  std::size_t views = 0;
  double timeMs = 0;                 ///< median of the neutral images
  double loadLow = 0, loadHigh = 0;  ///< 5th and 95th percentile of their load, in the unit of IgLoad
  std::vector<LeverPoint> points;    ///< lever by lever, from the neutral value on
  LoadShape shape = kHalvedLoad;     ///< of the lever that an allowed error moves
  double neutralPx = std::numeric_limits<double>::quiet_NaN();  ///< the error that its neutral value stands
                                                                ///< for; NaN if none was seen
  CostModel::State cost;
};

/// A fit from fewer views has no percentiles, and a preset is not fitted to it.
inline constexpr std::size_t kFewestFitViews = 20;
/// Refuses a fit of another image generator, and one from too few views; `where` names it.
Result<Done> checkFit(const IgFit& fit, const IgProfile& profile, const std::string& where);

/// Returns the fit as JSON; and the inverse, with findings that name line and key.
std::string fitText(const IgFit& fit);
Result<IgFit> parseIgFit(std::string_view text, const std::string& where);
Result<IgFit> loadIgFit(const std::filesystem::path& file);

/// Returns the fit for people: a line for each point, with intervals, and what is neutral.
std::string report(const IgFit& fit, const IgProfile& profile);

}  // namespace trimtab
