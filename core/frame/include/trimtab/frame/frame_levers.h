#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/hold_decision.h"
#include "trimtab/preset/parameters.h"

/// Declares who may change how coarsely an image is drawn, and in which order: preset, head motion, weather,
/// policy, budget. Each step is one function below. Steps 2 to 5 get the levers and return them; why they
/// did it is in MotionDecision, WeatherDecision, PolicyOutcome and HoldDecision. The levers after every
/// step are kept in FrameRequest, in the trace, and in the docks Decision and Budget. The renderer reads
/// `LeverChain::drawn`; in flight nothing sets a lever after that.
namespace trimtab {

/// The levers of one image. A default one is full detail with an error of 2 px.
struct FrameLevers {
  double errorPx = 2;  ///< allowed screen-space error of tiles and patches, pixels of the image
  /// That of static trees. The preset sets it; policy and budget change it by the factor of `errorPx`. It
  /// does not count with StaticDistanceRule::factor.
  double treeErrorPx = 1;
  double lodScale = 1;     ///< multiplies both errors; 1 is full detail, larger is coarser
  double levelSpread = 1;  ///< as LodParameters::spread; 1 leaves the distances at which levels are exchanged
  double farM = WeatherDecision::kUnlimited;  ///< nothing farther from the eye is drawn, metres
  double renderScale = 1;    ///< the part of the image's width and height at which the scene is drawn
  double particleShare = 1;  ///< the share of drops and flakes that is drawn
  double blurStrength = 0;   ///< as MotionBlur::strength; at 0 no blur pass runs
  /// That of objects. The preset sets it; whatever changes `errorPx` changes it by the same factor, but a
  /// rule of its own does not.
  double objectErrorPx = 2;
  double smallFeaturePx = 0;  ///< an object that is smaller in the image is not drawn, pixels
  double objectFarM = WeatherDecision::kUnlimited;  ///< an object farther from the eye is not drawn, metres
  std::optional<OcclusionResolution> occlusion;     ///< if unset, nothing is tested for occlusion

  friend bool operator==(const FrameLevers&, const FrameLevers&) = default;
};

/// The steps, in their order.
enum class LeverStep : std::uint8_t { preset, motion, weather, policy, budget };
inline constexpr std::size_t kLeverSteps = static_cast<std::size_t>(LeverStep::budget) + 1;

/// The levers after each step.
struct LeverChain {
  FrameLevers preset, motion, weather, policy;
  FrameLevers drawn;  ///< after the budget, or as the policy leaves them if no budget is held

  const FrameLevers& after(LeverStep step) const {
    const std::array steps{&preset, &motion, &weather, &policy, &drawn};
    return *steps[static_cast<std::size_t>(step)];
  }
  friend bool operator==(const LeverChain&, const LeverChain&) = default;
};

/// 1. Returns what the preset asks for. `occlusion` is what the memberships of altitude and pitch choose
/// (documents A and B, see resources/docs/glossary.md). Render scale and particle share begin at 1.
FrameLevers presetLevers(const TuningParameters& preset, std::optional<OcclusionResolution> occlusion);
/// 2. Head motion multiplies the LOD scale and sets the blur (document C).
FrameLevers withMotion(FrameLevers levers, const MotionDecision& motion);
/// 3. The weather sets the far distance, which nothing set before (document D).
FrameLevers withWeather(FrameLevers levers, const WeatherDecision& weather);
/// 4. Levers that some rule of the policy moves change, and no others. Allowed error, particle share and
/// render scale and those of objects take the policy's value; the LOD scale takes it times that of head
/// motion; far distance and blur are multiplied by it. `occlusion` is the resolution that the policy's total
/// chose.
FrameLevers withPolicy(FrameLevers levers, const PolicyOutcome& policy, const MotionDecision& motion,
                       std::optional<OcclusionResolution> occlusion);
/// 5. Applies what the arbiter of the budget decided: allowed error, render scale and particle share are its
/// values, and the blur is multiplied by its share.
FrameLevers withBudget(FrameLevers levers, const HeldLevers& held);

/// The names of a lever, and its field.
struct FrameLeverRow {
  std::string_view key;    ///< as rules, JSON and reports spell it
  std::string_view label;  ///< as people read it
  std::string_view unit;
  double FrameLevers::*value;  ///< null for the occlusion resolution, whose value is its width
};

/// Every lever except that of static trees, which follows the allowed error.
inline constexpr std::array<FrameLeverRow, 11> kFrameLeverRows{{
    {rowOf(Lever::screen_space_error).key, rowOf(Lever::screen_space_error).label, "px",
     &FrameLevers::errorPx},
    {rowOf(Lever::lod_scale).key, rowOf(Lever::lod_scale).label, "", &FrameLevers::lodScale},
    {"level_spread", "Distance between levels", "", &FrameLevers::levelSpread},
    {rowOf(Lever::far_distance).key, rowOf(Lever::far_distance).label, "m", &FrameLevers::farM},
    {rowOf(Lever::render_scale).key, rowOf(Lever::render_scale).label, "", &FrameLevers::renderScale},
    {rowOf(Lever::particle_density).key, rowOf(Lever::particle_density).label, "",
     &FrameLevers::particleShare},
    {rowOf(Lever::blur_strength).key, rowOf(Lever::blur_strength).label, "", &FrameLevers::blurStrength},
    {rowOf(Lever::object_error).key, rowOf(Lever::object_error).label, "px", &FrameLevers::objectErrorPx},
    {rowOf(Lever::small_feature).key, rowOf(Lever::small_feature).label, "px", &FrameLevers::smallFeaturePx},
    {rowOf(Lever::object_distance).key, rowOf(Lever::object_distance).label, "m", &FrameLevers::objectFarM},
    {rowOf(Lever::occlusion).key, rowOf(Lever::occlusion).label, "px", nullptr},
}};

/// Returns the lever's value; 0 for an occlusion resolution that is unset.
double valueOf(const FrameLevers& levers, const FrameLeverRow& row);
/// Returns the last step after which the lever's value is another than before it: the preset if there is
/// none.
LeverStep lastChange(const LeverChain& chain, const FrameLeverRow& row);

/// Returns who set the lever and who changed it to what, in order: "preset 2 px, policy 4 px, budget 5.66
/// px".
std::string explain(const LeverChain& chain, const FrameLeverRow& row);
/// Returns a value with its unit: "4 px", "400 x 300 px", "none", "unlimited".
std::string valueText(const FrameLevers& levers, const FrameLeverRow& row);

/// Returns the name of a step, as docks and reports show it.
std::string_view toText(LeverStep step);

}  // namespace trimtab
